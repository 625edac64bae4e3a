"""Changes each tuned number of docs/thresholds.md by a half and by two, and compares answers and cost of some hundred cases.

    python tests/ledger                          all: about an hour on one core, after one build of a copy of the sources
    python tests/ledger --only RAISE DROP AIM    some numbers
    python tests/ledger --rooms harmonics aft    those of some rooms
    python tests/ledger --sample 10 --seed 3     some drawn at random

A share between one half and one is not doubled: its distance from one is halved.

A number *breaks* where an answer leaves the tolerance of its case, or a case fails: then it is no heuristic, and needs an equation. It
is *dear* where a case takes more than twice the processor time. It changes *nothing* where no answer differs in any digit and no time
by a tenth: then it may be superfluous, unless a case that needs it is missing. *Unread* is what no case reads. Status 1 where a number
breaks or is dear that is not in known.txt. Needs numpy, scipy and cargo."""

import argparse
import json
import math
import os
import pickle
import random
import resource
import shutil
import signal
import struct
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import instrument  # noqa: E402

#: Factors of each number.
FACTORS = (0.5, 2.0)
#: Largest ratio of processor times, and times that are too short for a ratio.
DEAR, SHORT = 2.0, 0.03
#: Ratio of processor times that counts as a change.
CHANGED = 1.1


def cpu():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def run(names, environment, limits):
    """Runs cases in a process of their own. Returns for each its answer and processor time, or the words of its failure."""
    found, left = {}, list(names)
    while left:
        read, write = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(read)
            os.environ.update(environment)
            _child(left, write, limits)
        os.close(write)
        with os.fdopen(read, "rb") as stream:
            while True:
                head = stream.read(8)
                if len(head) < 8:
                    break
                name, *result = pickle.loads(stream.read(struct.unpack("q", head)[0]))
                found[name] = result
        os.waitpid(child, 0)
        rest = [name for name in left if name not in found]
        if rest:  # The first one of these took too long, or the process died.
            found[rest[0]] = ["did not end", math.inf]
        left = rest[1:]
    return found


def _child(names, pipe, limits):
    import cases
    try:
        os.chdir(tempfile.mkdtemp())
        for name in names:
            signal.setitimer(signal.ITIMER_PROF, limits.get(name, 60.0))
            begin = cpu()
            try:
                answer = cases.CASES[name][0]()
            except Exception as error:  # noqa: BLE001
                answer = f"{type(error).__name__}: {error}"[:200]
            data = pickle.dumps((name, answer, cpu() - begin))
            os.write(pipe, struct.pack("q", len(data)))
            while data:
                data = data[os.write(pipe, data):]
    finally:
        os._exit(0)


def difference(old, new, tolerance):
    """Largest difference of two answers in units of what is allowed; infinite where words differ."""
    if isinstance(old, str) or isinstance(new, str):
        return 0.0 if old == new else math.inf
    if len(old) != len(new):
        return math.inf
    largest = 0.0
    for a, b in zip(old, new):
        if isinstance(a, str) or isinstance(b, str):
            if a != b:
                return math.inf
            continue
        (a, unit), (b, _) = (x if isinstance(x, tuple) else (float(x), 0.0) for x in (a, b))
        if a == b or (math.isnan(a) and math.isnan(b)):
            continue
        allowed = max(tolerance * max(abs(a), abs(b)), unit, 1e-12)
        largest = max(largest, abs(a - b) / allowed) if math.isfinite(a) and math.isfinite(b) else math.inf
    return largest


def verdict(index, reading, base, cases):
    """What the two factors change: a word and its reasons."""
    same, reasons, word = True, [], "moves"
    for factor in FACTORS:
        environment = {"HBVIB_VARIED": f"{index}:{factor}"}
        limits = {name: 4 * base[name][1] + 2.0 for name in reading}
        found = run(reading, environment, limits)
        for name in reading:
            (old, before), (new, taken) = base[name], found[name]
            off = difference(old, new, cases.CASES[name][1])
            # Times are noisy: the least of some counts.
            for _ in range(3):
                if taken <= DEAR * before + SHORT or not math.isfinite(taken):
                    break
                taken = min(taken, run([name], environment, limits)[name][1])
            if off > 1.0:
                word = "breaks"
                said = new if isinstance(new, str) else f"{off:.1f} times the tolerance"
                reasons.append(f"x {factor:g} {name}: {said}")
            elif taken > DEAR * before + SHORT:
                word = word if word == "breaks" else "dear"
                reasons.append(f"x {factor:g} {name}: {taken / before:.1f} times the time")
            same &= off == 0.0 and max(taken, before) < CHANGED * min(taken, before) + SHORT
    return ("nothing" if same else word), reasons


def known():
    """Numbers that break or are dear, each with its reason."""
    with open(os.path.join(HERE, "known.txt"), encoding="utf-8") as file:
        return {line.split()[0] for line in file if line.strip() and not line.startswith("#")}


def prepared(folder, keep):
    """The library of the copy, and the index of each number in it; an earlier copy may be kept."""
    if not keep or not os.path.exists(os.path.join(folder, "numbers.json")):
        shutil.rmtree(folder, ignore_errors=True)
        instrument.copy(folder)
    library = instrument.build(folder)
    with open(os.path.join(folder, "numbers.json"), encoding="utf-8") as file:
        return library, json.load(file)


def main():
    parser = argparse.ArgumentParser(description="Changes tuned numbers and compares answers and cost.")
    parser.add_argument("--folder", default=os.path.join(HERE, "../../target/ledger/source"), help="of the copy of the sources")
    parser.add_argument("--keep", action="store_true", help="use the copy of an earlier run, whatever changed since")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="some numbers")
    parser.add_argument("--rooms", nargs="+", metavar="ROOM", help="the numbers of some rooms")
    parser.add_argument("--sample", type=int, help="as many numbers, drawn at random")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[name] = "1"
    library, ledger = prepared(os.path.abspath(given.folder), given.keep)
    os.environ["HBVIB_LIBRARY"] = library
    os.environ["HBVIB_IO_LIBRARY"] = os.path.join(os.path.dirname(library), "libhbvib_io.so")
    import cases

    names = list(cases.CASES)
    base, reads = {}, {}
    for name in names:
        with tempfile.NamedTemporaryFile("r") as file:
            answer, taken = run([name], {"HBVIB_READ": file.name}, {})[name]
            reads[name] = {int(line) for line in file.read().split()}
        again = [run([name], {}, {})[name] for _ in range(2)]
        if isinstance(answer, str) or any(difference(answer, other[0], 0.0) for other in again):
            print(f"left out: {name}: {answer if isinstance(answer, str) else 'answers differ from run to run'}")
            continue
        base[name] = (answer, min(taken, *(other[1] for other in again)))
    print(f"{len(base)} cases, {sum(taken for _, taken in base.values()):.1f} s; {len(ledger['numbers'])} numbers, "
          f"{len(ledger['constants'])} that must stay constants")

    chosen = sorted(ledger["numbers"])
    if given.only:
        chosen = [name for name in chosen if name in given.only]
    if given.rooms:
        rooms = instrument.tuned()
        chosen = [name for name in chosen if rooms.get(name) in given.rooms]
    if given.sample:
        chosen = sorted(random.Random(given.seed).sample(chosen, given.sample))
    count, failed, accepted = {}, [], known()
    for name in chosen:
        index, begin = ledger["numbers"][name], time.time()
        reading = [case for case in base if index in reads[case]]
        word, reasons = verdict(index, reading, base, cases) if reading else ("unread", [])
        count[word] = count.get(word, 0) + 1
        print(f"{word:8} {name} ({len(reading)} cases, {time.time() - begin:.0f} s)", *reasons[:6], sep="\n         ", flush=True)
        if word in ("breaks", "dear") and name not in accepted:
            failed.append(name)
    print(", ".join(f"{number} {word}" for word, number in sorted(count.items())))
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
