"""Results of a parameter response that are arrays, as named tuples."""
from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]
    IntArray = NDArray[np.int64]
    StringArray = NDArray[np.str_]


class Optima(NamedTuple):
    """Optima of a parameter response: value of the parameter, amplitude or damping ratio, kind, point number.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> model.add_force(0, 0.2)
    >>> found = model.parameter_response(hbvib.Parameter("force"), (1, 3), omega=1.0, follow="peak")
    >>> found.optima().kind.tolist()  # the peak only rises
    []
    """
    parameter: FloatArray
    value: FloatArray
    kind: StringArray
    point: IntArray


class Turns(NamedTuple):
    """Points at which a parameter response turns: value of the parameter, omega, amplitude, kind, point number.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> model.add_force(0, 0.2)
    >>> found = model.parameter_response(hbvib.Parameter("force"), (1, 3), omega=1.0, follow="peak_through_folds")
    >>> found.turns().kind.tolist()  # a linear peak exists under each force
    []
    """
    parameter: FloatArray
    omega: FloatArray
    amplitude: FloatArray
    kind: StringArray
    point: IntArray


class HigherPeaks(NamedTuple):
    """Peaks higher than a followed one: value of the parameter, omega, amplitude, point number of the followed one.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> model.add_force(0, 0.2)
    >>> found = model.parameter_response(hbvib.Parameter("force"), (1, 3), omega=1.0, follow="peak")
    >>> len(found.higher_peaks().parameter)
    0
    """
    parameter: FloatArray
    omega: FloatArray
    amplitude: FloatArray
    point: IntArray
