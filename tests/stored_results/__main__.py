"""Solves reference cases and prints every number that the library returns, in hexadecimal: the check that a change of
the code changes no result, not even in its last bit.

    HBVIB_LIBRARY=old.so python tests/stored_results > old.txt        about two minutes on one core
    HBVIB_LIBRARY=new.so python tests/stored_results > new.txt
    python tests/stored_results --compare old.txt new.txt             status 1 where a number differs
    python tests/stored_results --only 'law/*' 'duffing/*'            some cases; --list names all

Needs numpy and scipy. The library is called through include/hbvib. A line is a label and a number; lines of sentences
(errors, reasons of an early stop, lines of the log) begin with "sentence" and count as a difference only with
--sentences, because a sentence may be worded anew where no number changes."""

import argparse
import fnmatch
import math
import os
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))


def compare(old, new, sentences):
    """Prints the cases that differ, with the largest relative difference of a number. Returns how many differ."""

    def read(path):
        lines, said = {}, {}
        with open(path, encoding="utf-8") as file:
            for line in file:
                label, _, value = line.rstrip("\n").partition(" ")
                if label == "sentence":
                    label, _, value = value.partition(" ")
                    said[label] = value
                else:
                    lines[label] = value
        return lines, said

    (a, said_a), (b, said_b) = read(old), read(new)
    differing = {}

    def count(label, distance, text):
        case = "/".join(label.split("/")[:2])
        number, *largest = differing.get(case, (0, -1.0, ""))
        differing[case] = (number + 1, *max(tuple(largest), (distance, text)))

    for label in sorted(a.keys() | b.keys()):
        x, y = a.get(label, "absent"), b.get(label, "absent")
        if x == y:
            continue
        try:
            x, y = float.fromhex(x), float.fromhex(y)
        except ValueError:
            distance = math.inf
        else:
            distance = abs(x - y) / (max(abs(x), abs(y)) or 1.0) if math.isfinite(x) and math.isfinite(y) else math.inf
        count(label, distance, f"{label}: {x} became {y}")
    for case, (number, largest, text) in sorted(differing.items()):
        print(f"{case}: {number} numbers differ, by {largest:.2e} at most: {text}")
    worded = [label for label in sorted(said_a.keys() | said_b.keys()) if said_a.get(label) != said_b.get(label)]
    for label in worded if sentences else ():
        print(f"{label}: {said_a.get(label, 'absent')}\n    became {said_b.get(label, 'absent')}")
    print(f"{len(a)} numbers, of which {sum(entry[0] for entry in differing.values())} differ; "
          f"{len(said_a)} sentences, of which {len(worded)} differ")
    return sum(entry[0] for entry in differing.values()) + (len(worded) if sentences else 0)


def main():
    parser = argparse.ArgumentParser(description="Solves reference cases and prints every number in hexadecimal.")
    parser.add_argument("--compare", nargs=2, metavar=("OLD", "NEW"), help="compare two outputs instead")
    parser.add_argument("--sentences", action="store_true", help="with --compare: sentences must be equal, too")
    parser.add_argument("--only", nargs="+", metavar="PATTERN", default=["*"], help="cases that match a pattern")
    parser.add_argument("--list", action="store_true", help="print the names of the cases")
    parser.add_argument("--times", action="store_true", help="print the seconds of each case to standard error")
    given = parser.parse_args()
    if given.compare:
        sys.exit(1 if compare(*given.compare, given.sentences) else 0)

    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[name] = "1"
    sys.path.insert(0, HERE)
    sys.path.append(os.path.join(HERE, "../../include"))
    import cases_blisk
    import cases_hard
    import cases_laws
    import cases_linear
    import cases_sectors
    import cases_time
    from record import CASES, Record

    _ = cases_blisk, cases_hard, cases_laws, cases_linear, cases_sectors, cases_time
    for name in sorted(CASES):
        if not any(fnmatch.fnmatch(name, pattern) for pattern in given.only):
            continue
        if given.list:
            print(name)
            continue
        begin = time.process_time()
        CASES[name](Record(name, sys.stdout))
        if given.times:
            print(f"{time.process_time() - begin:8.2f} s  {name}", file=sys.stderr)


if __name__ == "__main__":
    main()
