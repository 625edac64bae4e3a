"""Universal files in Python: damaged ones are told with file and line, by both readers, and writers and readers agree."""

import os
import tempfile

import numpy as np

import hbvib.io
from common import check, close, finish, raises

folder = tempfile.mkdtemp()
path = os.path.join(folder, "a.uff")
f = np.linspace(10, 20, 11)
response = 1 / (15**2 - f**2 + 1j * f)
hbvib.io.write_universal(path, nodes=[7], positions=[[0, 0, 1]], functions=[("r", 7, 3, f, response)])
with open(path, encoding="latin-1") as file:
    whole = file.read()


def written(text, name="b.uff"):
    place = os.path.join(folder, name)
    with open(place, "wb") as file:
        file.write(text if isinstance(text, bytes) else text.encode("latin-1"))
    return place


def damaged(claim, text, words, reader=hbvib.io.read_uff):
    place = written(text)
    error = raises(claim, hbvib.io.ReadError, reader, place, words=words)
    check(f"{claim}: the file and the line", error is not None and str(error).startswith(f"{place}: line "), error)


found = hbvib.io.read_uff(path)
check("a function that was written is read", len(found) == 1 and found[0].node == 7 and found[0].direction == 3)
close("its frequencies", found[0].x, f, 1e-9)
close("its values", found[0].values, response, 1e-9)

# The head and the numbers of the function.
head = "         6        11         0"
check("the head is there", whole.count(head) == 1 and whole.count(" 12.000000000") == 1)
number = " 12.000000000"
damaged("NaN frequency", whole.replace(number, "          nan"), "'nan' needs to be a finite number")
damaged("infinite value", whole.replace("1.208053691275E-02", "               inf"), "'inf' needs to be a finite number")
damaged("too large a number", whole.replace(number, "        1e999"), "'1e999' needs to be a finite number")
damaged("text in a number", whole.replace(number, " 12.0x0000000"), "12.0x0000000")
damaged("digits in groups", whole.replace(number, " 12_000.00000"), "12_000.00000")
damaged("fewer points told than follow", whole.replace(head, head.replace("11", " 9")), "9 values")
damaged("more points told than follow", whole.replace(head, head.replace("11", "15")), "needs 45")
damaged("a point is missing in the last line", whole.replace(head, head.replace("11", "10")), "10 values")
damaged("a negative count", whole.replace(head, head.replace(" 11", "-11")), "-11 values")
damaged("a huge count", whole.replace(head, head.replace("         6        11", "         6 999999999")), "999999999 values")
damaged("unknown type of values", whole.replace(head, head.replace("6", "9", 1)), "type 9, needs 2, 4, 5 or 6")
damaged("unknown spacing", whole.replace(head, head[:-1] + "2"), "spacing = 2")
damaged("a word in the head", whole.replace(head, head.replace("11", "xx")), "'xx' needs to be a whole number")
damaged("the file ends within the function", whole[:whole.index(number) + len(number)], "the file ends within a data set")
damaged("the file ends within the head", whole[:whole.index(head)], "the file ends within a data set")
damaged("no universal file", "a, b\n1, 2\n", "needs a line with -1")
damaged("an empty file", "", "holds no data set")
damaged("a data set without number", "    -1\nabc\n    -1\n", "'abc' needs to be the number of a data set")
raises("no file", FileNotFoundError, hbvib.io.read_uff, os.path.join(folder, "none.uff"))

# Other marks and ends of lines, numbers that touch each other, exponents of Fortran.
turned = whole.replace("\n", "\r\n") + "    -1\r\n"
check("lines of Windows and a mark too many", (hbvib.io.read_uff(written(turned))[0].values == found[0].values).all())
lines = whole.splitlines()
at = next(k for k, line in enumerate(lines) if head in line)
even = ["         5         2         1  1.00000E+01  5.00000D-01  0.00000E+00"]
touching = lines[:at] + even + lines[at + 1:at + 5] + ["-1.00000E+00-2.50000D-01 3.00000E+00-4.00000E+00", "    -1"]
one = hbvib.io.read_uff(written("\n".join(touching)))[0]
check("numbers that touch", one.values.tolist() == [-1 - 0.25j, 3 - 4j] and one.x.tolist() == [10, 10.5], one)

# Binary functions: damaged lines and lengths.
values = np.array([1 + 2j, -0.5 + 0.25j, 3e-4 - 1j])
form = "         6         3         1  1.00000e+01  5.00000e-01  0.00000e+00"


def binary(data, first="    58b     1     2          11          48     0     0           0           0"):
    text = "\n".join(["    -1", first] + lines[at - 6:at] + [form] + lines[at + 1:at + 5]) + "\n"
    return text.encode("latin-1") + data + b"\n    -1\n"


data = values.view(float).astype("<f8").tobytes()
check("a binary function", (hbvib.io.read_uff(written(binary(data)))[0].values == values).all())
damaged("a binary function is cut", binary(data[:-9]), "does not end after 3 values")
damaged("a binary function has more", binary(data + data), "does not end after 3 values")
damaged("a format of numbers", binary(data, "    58b     1     1          11          48     0     0           0           0"), "format 2")
not_finite = np.array([1, np.nan, 0, 0, 0, 0]).astype("<f8").tobytes()
damaged("a binary NaN", binary(not_finite), "not finite")
damaged("another binary data set", b"    -1\n  2414b\n" + data + b"\n    -1\n", "data set 2414 is binary")

# Modes.
mode = ["    -1", "    55", "bending", "NONE", "NONE", "NONE", "NONE", "         1         2         2         8         2         3",
        "         2         4         1         3", "  1.25000e+01  1.00000e+00  5.00000e-03  0.00000e+00", "         7",
        "  0.00000e+00  1.00000e+00 -5.00000e-01", "    -1"]
check("a mode", hbvib.io.read_uff_modes(written("\n".join(mode)))[0].shape.real.tolist() == [[0, 1, -0.5]])
for claim, line, old, new, words in (
        ("a NaN in a shape", 11, "1.00000e+00", "nan", "'nan' needs to be a finite number"),
        ("a NaN of a frequency", 9, "1.25000e+01", "nan", "'nan' needs to be a finite number"),
        ("a word in a shape", 11, "1.00000e+00", "1.0x", "1.0x"),
        ("a number too many", 11, "1.00000e+00", "1.0 2.0", "more numbers follow than the 3 values of node 7"),
        ("a number too few", 11, "1.00000e+00", "", "ends after 2 values of node 7"),
        ("a negative count of values", 7, "         3", "        -3", "-3 values of a node"),
        ("a negative count of numbers", 8, "         2         4", "         2        -4", "[2, -4]"),
        ("type of the data", 7, "         8         2", "         8         4", "type 4, needs 2 (real) or 5 (complex)"),
        ("node", 10, "7", "7.5", "'7.5' needs to be a whole number")):
    damaged(claim, "\n".join(mode[:line] + [mode[line].replace(old, new)] + mode[line + 1:]), words, hbvib.io.read_uff_modes)
damaged("a mode without end", "\n".join(mode[:-1]), "the file ends within a data set", hbvib.io.read_uff_modes)
hidden = np.frombuffer(b"\n    -1\n" * 6, "<f8")
check("a mark among bytes", len(hbvib.io.read_uff_modes(written(binary(hidden.tobytes()) + "\n".join(mode).encode()))) == 1)
finish(75)
