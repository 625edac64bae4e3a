"""Functions of universal files (UFF, data sets 58 and 58b): frequency responses and histories of test programs."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np

from ._universal_lines import UniversalLines

if TYPE_CHECKING:
    from ._results import ComplexArray, FloatArray

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
    A file that is damaged is a ReadError with file, line and reason: numbers that are not finite, more or fewer than its head tells.

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
    lines = UniversalLines(path)
    found: list[TestFunction] = []
    for number, first in lines.data_sets():
        if number == 58:
            found.append(function(lines, first))
        else:
            lines.pass_over()
    return found


#: Columns of the whole numbers in the sixth line of a function, and of those in the seventh.
_FIELDS = ((0, 5, "type of function"), (41, 51, "response node"), (51, 55, "response direction"), (66, 76, "reference node"),
           (76, 80, "reference direction"))
_FORM = ((0, 10, "type of values"), (10, 20, "number of values"), (20, 30, "spacing"))


def function(lines: UniversalLines, first_line: str) -> TestFunction:
    """Reads a function and the end of its data set, whose first line tells a binary one."""
    text = [lines.expect("a line of the head of a function").strip() for _ in range(5)]
    line = lines.expect("the line of response and reference")
    kind, node, direction, reference, along = (lines.whole(line[a:b], what) for a, b, what in _FIELDS)
    line = lines.expect("the line of the form of values")
    ordinate, count, even = (lines.whole(line[a:b], what) for a, b, what in _FORM)
    first, step = (lines.real(line[a:a + 13].strip()) for a in (30, 43))
    if ordinate not in _TYPES:
        lines.fail(f"values of type {ordinate}, needs 2, 4, 5 or 6")
    if even not in (0, 1):
        lines.fail(f"spacing = {even}, needs 0 (uneven) or 1 (even)")
    if not 0 <= count <= len(lines.data):
        lines.fail(f"{count} values of a function in a file of {len(lines.data)} bytes, needs 0 or more, as many as follow")
    lines.expect("the line of the abscissa")
    quantity = lines.whole(lines.expect("the line of the ordinate")[:10], "quantity")
    for _ in range(2):
        lines.expect("a line of the head of a function")
    width, pairs = _TYPES[ordinate]
    columns = (2 if pairs else 1) + (0 if even else 1)
    if "b" in first_line.lower():
        numbers = _binary(lines, first_line, width, (count, columns, even))
    else:
        numbers = np.array(lines.reals(count * columns, f"numbers of a function of {count} values"), float)
    lines.end(f"the {count} values of the function")
    table = numbers.reshape(count, columns)
    x = first + step * np.arange(count) if even else table[:, 0]
    values = table[:, -2] + 1j * table[:, -1] if pairs else table[:, -1]
    x = np.asarray(x, np.float64)
    return TestFunction(text, kind, node, direction, reference, along, _QUANTITIES.get(quantity, ""), x, values)


def _binary(lines: UniversalLines, first_line: str, width: str, shape: tuple[int, int, int]) -> FloatArray:
    words = lines.wholes(" ".join(first_line.split()[1:]), "binary function")
    if len(words) < 4 or words[0] not in (1, 2) or words[1] != 2:
        lines.fail("needs the byte order 1 or 2, the format 2 (IEEE 754), lines of the head and bytes of a binary function")
    count, columns, even = shape
    order = "<" if words[0] == 1 else ">"
    # Abscissas of uneven spacing are single; some programs write them as the ordinates, and others tell a wrong length.
    for of_x in (width,) if even else ("f4", width):
        form = np.dtype([("x", order + of_x), ("value", order + width, (columns - 1,))] if not even else [
            ("value", order + width, (columns,))])
        if lines.mark_follows(count * form.itemsize):
            rows = np.frombuffer(lines.take(count * form.itemsize), form)
            values = rows["value"].astype(float).reshape(count, -1)
            numbers = values if even else np.column_stack([rows["x"].astype(float), values])
            if not np.isfinite(numbers).all():
                lines.fail("a value of a binary function is not finite")
            return numbers.ravel()
    lines.fail(f"the data set does not end after {count} values; {words[3]} bytes are told")
