"""Functions of universal files (UFF, data sets 58 and 58b): frequency responses and histories of test programs."""
from __future__ import annotations

import os
import re
import struct
from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np

if TYPE_CHECKING:
    from ._results import ComplexArray, FloatArray

_MARK = re.compile(rb"(?m)^ {0,4}-1[ \t]*\r?$")
#: Ordinate types: numpy type of its numbers, and whether these are pairs.
_TYPES = {2: ("f4", False), 4: ("f8", False), 5: ("f4", True), 6: ("f8", True)}
#: Kinds of quantities, as data set 58 numbers them.
_QUANTITIES = {8: "displacement", 9: "reaction force", 11: "velocity", 12: "acceleration", 13: "excitation force", 15: "pressure"}


class TestFunction(NamedTuple):
    """A function of a universal file; made by hbvib.io.read_uff.

    text         the lines of text of its head.
    kind         1: a history in time, 4: a frequency response, 6: a coherence, 12: a spectrum.
    node, direction, reference_node, reference_direction   of response and reference; 1 to 3 along x, y, z, negative against them.
    quantity     of the ordinate: "displacement", "velocity", "acceleration", ..., or "".
    x, values    times or frequencies in hertz, real or complex numbers.

    >>> import hbvib, hbvib.io
    >>> import numpy as np
    >>> hbvib.io.TestFunction([], 4, 1, 3, 1, 3, "acceleration", np.array([10.0]), np.array([1j])).omega.round(3)
    array([62.832])
    """
    text: list[str]
    kind: int
    node: int
    direction: int
    reference_node: int
    reference_direction: int
    quantity: str
    x: FloatArray
    values: Union[FloatArray, ComplexArray]

    @property
    def omega(self) -> FloatArray:
        """Angular frequencies of a function of frequency."""
        return 2 * np.pi * self.x

    def response(self, force: float = 1.0) -> ComplexArray:
        """Complex displacements of a frequency response under a force of this amplitude, both along the positive axes: velocities and
        accelerations are divided by i omega once or twice, and a negative direction turns the sign.

        >>> import hbvib, hbvib.io
        >>> import numpy as np
        >>> one = hbvib.io.TestFunction([], 4, 1, 3, 1, 3, "acceleration", np.array([1 / (2 * np.pi)]), np.array([2.0 + 0j]))
        >>> one.response(0.5).round(9)
        array([-1.-0.j])
        """
        order = {"velocity": 1, "acceleration": 2}.get(self.quantity, 0)
        sense = -1.0 if (self.direction < 0) != (self.reference_direction < 0) else 1.0
        return np.asarray(sense * force * self.values / (1j * self.omega) ** order)


def read_uff(path: Any) -> list[TestFunction]:
    """Reads the functions (data sets 58, text, and 58b, binary) of a universal file; other data sets are passed over.

    >>> import hbvib, hbvib.io
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "test.uff")
    >>> head = ["    -1", "    58", "drive point", "NONE", "NONE", "NONE", "NONE",
    ...         "    4         1    0         0       NONE         7   3       NONE         7   3",
    ...         "         5         2         1  1.00000e+01  5.00000e-01  0.00000e+00"]
    >>> axes = ["        18    0    0    0", "        12    0    0    0", "        13    0    0    0", "         0    0    0    0"]
    >>> with open(path, "w") as file:
    ...     print("\\n".join(head + axes + ["  1.0e+00  0.0e+00  0.0e+00 -2.0e+00", "    -1"]), file=file)
    ...
    >>> found = hbvib.io.read_uff(path)[0]
    >>> found.x, found.values, found.quantity, found.node
    (array([10. , 10.5]), array([1.+0.j, 0.-2.j]), 'acceleration', 7)
    """
    with open(os.fspath(path), "rb") as file:
        data = file.read()
    found: list[TestFunction] = []
    at = 0
    while True:
        mark = _MARK.search(data, at)
        if mark is None:
            return found
        line, begin = _line(data, mark.end() + 1)
        words = line.split()
        if words and words[0] in ("58", "58b", "58B"):
            one, at = _function(data, begin, line if words[0] != "58" else "")
            found.append(one)
        else:
            at = begin
        end = _MARK.search(data, at)
        if end is None:
            return found
        at = end.end()


def _line(data: bytes, at: int) -> tuple[str, int]:
    end = data.find(b"\n", at)
    end = len(data) if end < 0 else end
    return data[at:end].decode("latin-1").rstrip("\r"), end + 1


def _function(data: bytes, at: int, binary: str) -> tuple[TestFunction, int]:
    lines = []
    for _ in range(11):
        line, at = _line(data, at)
        lines.append(line)
    try:
        of = lines[5]
        kind, node, direction = int(of[:5]), int(of[41:51]), int(of[51:55])
        reference, along = int(of[66:76]), int(of[76:80])
        form = lines[6]
        ordinate, count, even = int(form[:10]), int(form[10:20]), int(form[20:30])
        first, step = float(form[30:43]), float(form[43:56])
        quantity = int(lines[8][:10])
        numpy_type, pairs = _TYPES[ordinate]
    except (ValueError, KeyError) as error:
        raise ValueError(f"data set 58: the head cannot be read ({error})") from None
    columns = (2 if pairs else 1) + (0 if even else 1)
    if binary:
        order, size = int(binary[7:13]), int(binary[31:43])
        numbers = _binary(data[at:at + size], numpy_type, "<" if order == 1 else ">", (count, columns, even))
        at += size
    else:
        end = _MARK.search(data, at)
        text = data[at:len(data) if end is None else end.start()].decode("latin-1").replace("D", "e")
        numbers = np.array(text.split(), float)
    if numbers.size < count * columns:
        raise ValueError(f"data set 58: {numbers.size} numbers, needs {count * columns}")
    table = numbers[:count * columns].reshape(count, columns)
    x = first + step * np.arange(count) if even else table[:, 0]
    values = table[:, -2] + 1j * table[:, -1] if pairs else table[:, -1]
    text_of_head = [line.strip() for line in lines[:5]]
    x = np.asarray(x, np.float64)
    return TestFunction(text_of_head, kind, node, direction, reference, along, _QUANTITIES.get(quantity, ""), x, values), at


def _binary(data: bytes, numpy_type: str, order: str, shape: tuple[int, int, int]) -> FloatArray:
    count, columns, even = shape
    if even or numpy_type == "f4":
        return np.frombuffer(data, np.dtype(order + numpy_type))[:count * columns].astype(float)
    # Abscissas of uneven spacing are single where ordinates are double.
    form = order + "f" + "d" * (columns - 1)
    return np.array([row for row in struct.iter_unpack(form, data[:count * struct.calcsize(form)])]).ravel()
