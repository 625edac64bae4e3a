"""Modes of tests: data at nodes of universal files (UFF, data set 55)."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Optional

import numpy as np

from ._measured import Measured
from ._test_files import function
from ._universal_lines import UniversalLines

if TYPE_CHECKING:
    from ._results import ComplexArray, FloatArray, IntArray

#: Kinds of analysis: a normal mode, and complex modes of first and second order.
_NORMAL, _COMPLEX = 2, (3, 7)


class TestMode(NamedTuple):
    """A mode of a universal file; made by hbvib.io.read_uff_modes.

    text        the lines of text of its head.
    number      of the mode.
    frequency   in hertz: of a complex mode |lambda| / (2 pi).
    damping     viscous damping ratio: of a complex mode -Re lambda / |lambda|.
    nodes, shape   numbers of the nodes, and the motion of each, one row of 3 or 6 complex numbers.

    >>> import hbvib, hbvib.io
    >>> import numpy as np
    >>> hbvib.io.TestMode([], 1, 10.0, 0.01, np.array([7]), np.ones((1, 3), complex)).measured(0.001).x
    array([0.])
    """
    text: list[str]
    number: int
    frequency: float
    damping: float
    nodes: IntArray
    shape: ComplexArray

    def measured(self, sigma: float, damping_sigma: Optional[float] = None, mode: int = 0) -> Measured:
        """The data of a fit: the mode in which all contacts stick.

        sigma           standard deviation of the frequency in hertz.
        damping_sigma   of the damping ratio; None: it is no datum.
        mode            number of the linear mode of the model, from 0.

        >>> import hbvib, hbvib.io
        >>> import numpy as np
        >>> hbvib.io.TestMode([], 1, 10.0, 0.01, np.array([7]), np.ones((1, 3), complex)).measured(0.1).value.real.round(3)
        array([62.832])
        """
        turn = 2 * np.pi
        return Measured("linear_mode", [0.0], [turn * self.frequency], turn * sigma, second=[self.damping],
                        second_sigma=damping_sigma, mode=mode)


def read_uff_modes(path: Any) -> list[TestMode]:
    """Reads the modes (data sets 55 of normal and complex modes) of a universal file; other data sets are passed over.
    A file that is damaged is a ReadError with file, line and reason, as in read_uff.

    >>> import hbvib, hbvib.io
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "modes.uff")
    >>> head = ["    -1", "    55", "bending", "NONE", "NONE", "NONE", "NONE", "         1         2         2         8         2         3",
    ...         "         2         4         1         3", "  1.25000e+01  1.00000e+00  5.00000e-03  0.00000e+00"]
    >>> with open(path, "w") as file:
    ...     print("\\n".join(head + ["         7", "  0.00000e+00  1.00000e+00 -5.00000e-01", "    -1"]), file=file)
    ...
    >>> found = hbvib.io.read_uff_modes(path)[0]
    >>> found.number, found.frequency, found.damping, found.shape.real
    (3, 12.5, 0.005, array([[ 0. ,  1. , -0.5]]))
    """
    lines = UniversalLines(path)
    found: list[TestMode] = []
    for number, first in lines.data_sets():
        if number == 55:
            one = _mode(lines)
            found += [] if one is None else [one]
        elif number == 58:
            # Numbers of binary functions may look like the end of the data set.
            function(lines, first)
        else:
            lines.pass_over()
    return found


def _mode(lines: UniversalLines) -> Optional[TestMode]:
    text = [lines.expect("a line of text of data set 55").strip() for _ in range(5)]
    head = lines.wholes(lines.expect("the kind of data set 55"), "kind of data")
    if len(head) < 6:
        lines.fail(f"{len(head)} numbers of the kind of data set 55, needs 6")
    analysis, kind, per_node = head[1], head[4], head[5]
    if analysis != _NORMAL and analysis not in _COMPLEX:
        lines.pass_over()
        return None
    if kind not in (2, 5):
        lines.fail(f"data of type {kind}, needs 2 (real) or 5 (complex)")
    if not 1 <= per_node <= len(lines.data):
        lines.fail(f"{per_node} values of a node, needs at least 1")
    # The counts of whole and other numbers stand first; the numbers go on over further lines.
    integers = lines.wholes(lines.expect("the whole numbers of the analysis"), "numbers of the analysis")
    needed = (0, 3 if analysis == _NORMAL else 2)
    if len(integers) < 2 or any(not least <= count <= 1000 for least, count in zip(needed, integers)):
        lines.fail(f"the counts {integers[:2]} of whole and real numbers of the analysis, needs {needed[0]} and {needed[1]} at least")
    while len(integers) < 2 + integers[0]:
        integers += lines.wholes(lines.expect("more whole numbers of the analysis"), "numbers of the analysis")
    reals = lines.reals(integers[1], "numbers of the analysis of data set 55")
    nodes, rows = [], []
    count = per_node * (2 if kind == 5 else 1)
    while True:
        line = lines.item()
        if line is None:
            break
        if not line.strip():
            continue
        own = lines.wholes(line, "node")
        if len(own) != 1:
            lines.fail(f"{line.strip()!r} needs to be the number of a node")
        nodes += own
        rows.append(lines.reals(count, f"values of node {own[0]} of data set 55"))
    frequency, damping = reals[0], reals[2] if analysis == _NORMAL else 0.0
    if analysis in _COMPLEX:
        size = float(np.hypot(reals[0], reals[1]))
        frequency, damping = size / (2 * np.pi), -reals[0] / size if size > 0 else 0.0
    table = np.array(rows, float).reshape(len(rows), count)
    shape = table[:, 0::2] + 1j * table[:, 1::2] if kind == 5 else table.astype(complex)
    number = integers[3] if integers[0] > 1 else 0
    return TestMode(text, number, float(frequency), float(damping), np.array(nodes, np.int64), shape)
