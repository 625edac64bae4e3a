"""Modes of tests: data at nodes of universal files (UFF, data set 55)."""
from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING, Any, NamedTuple, Optional

import numpy as np

from ._measured import Measured
from ._test_files import _MARK, _line

if TYPE_CHECKING:
    from ._results import ComplexArray, FloatArray, IntArray

#: Numbers of fixed width may touch each other.
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?")
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
    with open(os.fspath(path), "rb") as file:
        data = file.read()
    found: list[TestMode] = []
    at = 0
    while True:
        begin = _MARK.search(data, at)
        if begin is None:
            return found
        line, after = _line(data, begin.end() + 1)
        words = line.split()
        if words and words[0].lower() == "58b":
            # Numbers may look like the end of the data set: their length is in the line.
            for _ in range(11):
                _, after = _line(data, after)
            after += int(line[31:43])
        end = _MARK.search(data, after)
        last = len(data) if end is None else end.start()
        if words and words[0] == "55":
            one = _mode(data[after:last].decode("latin-1").splitlines())
            found += [] if one is None else [one]
        at = len(data) if end is None else end.end()


def _mode(lines: list[str]) -> Optional[TestMode]:
    try:
        head = [int(word) for word in lines[5].split()]
        analysis, kind, per_node = head[1], head[4], head[5]
        if analysis != _NORMAL and analysis not in _COMPLEX:
            return None
        # The counts of whole and other numbers stand first; the numbers go on over further lines.
        integers, at = [int(word) for word in lines[6].split()], 7
        while len(integers) < 2 + integers[0]:
            integers += [int(word) for word in lines[at].split()]
            at += 1
        reals: list[float] = []
        while len(reals) < integers[1]:
            reals += _numbers(lines[at])
            at += 1
        nodes, rows = [], []
        count = per_node * (2 if kind == 5 else 1)
        while at < len(lines) and lines[at].strip():
            nodes.append(int(lines[at].split()[0]))
            at += 1
            own: list[float] = []
            while len(own) < count:
                own += _numbers(lines[at])
                at += 1
            rows.append(own[:count])
        if kind not in (2, 5):
            raise ValueError(f"data of type {kind}, needs 2 (real) or 5 (complex)")
        frequency, damping = reals[0], reals[2] if analysis == _NORMAL else 0.0
        if analysis in _COMPLEX:
            size = float(np.hypot(reals[0], reals[1]))
            frequency, damping = size / (2 * np.pi), -reals[0] / size if size > 0 else 0.0
    except (ValueError, IndexError) as error:
        raise ValueError(f"data set 55: it cannot be read ({error})") from None
    table = np.array(rows, float).reshape(len(rows), count)
    shape = table[:, 0::2] + 1j * table[:, 1::2] if kind == 5 else table.astype(complex)
    text = [line.strip() for line in lines[:5]]
    number = integers[3] if len(integers) > 3 else 0
    return TestMode(text, number, float(frequency), float(damping), np.array(nodes, np.int64), shape)


def _numbers(line: str) -> list[float]:
    return [float(word.replace("D", "e").replace("d", "e")) for word in _NUMBER.findall(line)]
