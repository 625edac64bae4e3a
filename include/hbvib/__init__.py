"""hbvib for Python: steady-state vibration of structures with friction contacts, by harmonic balance.

    M x'' + C x' + K x + f_contact(x) = f_excitation,      x(t) = Re sum_{h=0..H} X_h exp(i h omega t)

Two objects: a `Model` (matrices, contacts, forces) and the `Branch` of solutions that a solve returns.
Units are any consistent set; angular frequencies are in rad per time unit, amplitudes are peak values.
Degrees of freedom, points, contacts and harmonics count from 0. The mathematics, and what each option
means, is in the docstrings; the functions of hbvib.h are all reachable, with prototypes, as `hbvib.lib.hbvib_...`.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)  # of mass and ground
    >>> model.add_force(0, 0.2)  # 0.2 cos(omega t)
    >>> branch = model.forced_response((0.8, 1.6))
    >>> print("%.4f" % branch.peaks().omega[0])
    1.2320

Errors      Below zero, a status is raised as a subclass of `Error` that is also Python's own (ValueError,
            IndexError, MemoryError ...). Above zero, the branch is returned and `StoppedEarly` is warned of,
            unless the caller stopped the solve. Wrong types are TypeError, wrong shapes ValueError.
Arrays      C- or Fortran-ordered and strided float64 and complex128 matrices are handed over without a
            copy; types that numpy calls safe to cast are converted; scipy.sparse matrices of any format are taken.
            Fields of a branch are read-only arrays in the library's own memory and keep the branch alive.
Threads     Any number of threads may solve one model and read one branch at once: calls release the GIL.
            Changing or freeing an object in use is BusyError.
Callbacks   run on the calling thread. An exception that they raise leaves the call that led there, the same object;
            an attribute `branch` holds the points found so far, if the solve had begun a branch.
Ctrl-C      stops every call that may be long within a fraction of a second: while it runs in the main thread, the
            handler of SIGINT is wrapped, as asyncio does, and KeyboardInterrupt carries `branch` as well where points
            were found. One factorisation of a large sparse matrix ends first.
"""
from __future__ import annotations

import importlib
from typing import Any

from . import _c, _results, _types
from ._band import Band, BandCurve, BandEnd, BandStates, FreeSlider
from ._batch import Batch
from ._blade_modes import BladeModes
from ._branch import Branch
from ._c import *
from ._caller_law import ForceCall
from ._calls import CancelFlag
from ._damper import DamperPlace
from ._decay import Decay, decay_backbone
from ._errors import (ArgumentError, BusyError, CallbackError, Error, FreedError, NumericalError, OutOfMemoryError,
                      OutOfRangeError, Stopped, StoppedEarly, UnsupportedError)
from ._fit_results import Fit, Predicted, Profile, SuspiciousUnits
from ._intentional import IntentionalPattern, WorstCase
from ._law import evaluate_contact
from ._library import __version__, get_include, lib, structs
from ._life import Life, LifeEvents
from ._measured import Measured, Unknown
from ._mode_band import ModeBand, ModeBandEnd
from ._model import Model
from ._results import *
from ._responses import Response, WatchedResponse
from ._run_up import CampbellResponse, Mission, RunUp, campbell_response
from ._sensitivity import ComplexSensitivities, Parameter, Sensitivities
from ._static_history import StaticHistory
from ._storage import SavedBranch, load
from ._stored_point import StoredPoint
from ._tables import from_dataframe, from_xarray
from ._time_sweep import TimeSweep
from ._types import *
from ._units import Units
from ._wheel_identify import IdentifiedPattern
from ._wheel_quantile import WheelQuantile
from ._wheel_results import Quantile, WheelPeaks, WheelStudy, WheelWeibull, WorstPattern

__all__ = [
    # errors
    "Error", "ArgumentError", "OutOfRangeError", "FreedError", "BusyError", "NumericalError", "UnsupportedError",
    "OutOfMemoryError", "CallbackError", "Stopped", "StoppedEarly",
    # objects
    "Model", "Response", "WatchedResponse", "Parameter", "Sensitivities", "ComplexSensitivities",
    "Measured", "Unknown", "Fit", "Predicted", "Profile", "SuspiciousUnits", "Decay", "Band", "BandEnd", "BandStates", "BandCurve", "ModeBand", "ModeBandEnd",
    "FreeSlider", "StaticHistory", "DamperPlace", "Life", "LifeEvents", "TimeSweep", "RunUp", "Mission", "CampbellResponse",
    "IdentifiedPattern", "IntentionalPattern", "WorstCase", "WheelPeaks", "WheelQuantile", "WheelStudy", "WheelWeibull", "WorstPattern", "Quantile", "Batch", "BladeModes", "Branch", "SavedBranch", "StoredPoint", "CancelFlag", "ForceCall",
    "Units",
    # functions
    "forced_response", "nonlinear_mode", "time_response", "verify", "floquet", "sensitivity", "evaluate_contact", "load", "from_dataframe", "from_xarray", "decay_backbone", "campbell_response",
    "get_include",
    # the C interface
    "lib", "structs",
]
__all__ += _c.__all__
__all__ += _results.__all__
__all__ += _types.__all__

forced_response = Model.forced_response
nonlinear_mode = Model.nonlinear_mode
time_response = Model.time_response
verify = Model.verify
floquet = Model.floquet
sensitivity = Model.sensitivity


def __getattr__(name: str) -> Any:
    """hbvib.io, the readers of finite-element files, and hbvib.testing are loaded on first use."""
    if name not in ("io", "testing"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return importlib.import_module(f"hbvib.{name}")


def __dir__() -> list[str]:
    """Names for the completion of a terminal, with the modules that are not loaded yet."""
    return sorted({*globals(), "io", "testing"})


# Classes are named hbvib.Model in messages and pickles, whichever module they are in.
for _value in [globals()[_name] for _name in __all__]:
    if isinstance(_value, type):
        _value.__module__ = __name__
