"""Fields of a branch: arrays in the library's own memory."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional, overload

import numpy as np

from ._c import Field
from ._calls import _call, _Owner
from ._convert import _member
from ._structs import _new

if TYPE_CHECKING:
    from ._choices import Fields
    from ._results import FloatArray


class _Lease:
    """Owner of a borrowed array (its `base`): keeps the branch, and its memory with it."""

    __slots__ = ("branch", "__array_interface__", "__weakref__")

    def __init__(self, branch: _BranchFields) -> None:
        self.branch = branch


class _FieldProperty(property):
    """A field as a read-only attribute, which type checkers know as an array."""

    def __init__(self, field: Field, text: str) -> None:
        super().__init__(lambda branch: branch.field(field))
        self.__doc__ = text  # that of the class would hide it

    if TYPE_CHECKING:
        @overload
        def __get__(self, instance: None, owner: Optional[type] = None) -> _FieldProperty: ...
        @overload
        def __get__(self, instance: _BranchFields, owner: Optional[type] = None) -> FloatArray: ...
        def __get__(self, instance: Any, owner: Optional[type] = None) -> Any: ...


class _BranchFields(_Owner):
    """Methods of Branch for its fields."""

    _leases: Any

    def field(self, field: Fields) -> FloatArray:
        """A field, by Field or name, in the library's memory: (points), slip_fraction (points, contacts),
        d_amplitude_by_place (points, contacts, 2).

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> bool((branch.field("omega") == branch.omega).all())
        True
        """
        return self._viewed("hbvib_branch_field", field)

    def _stored_field(self, field: Fields) -> Optional[FloatArray]:
        """The same with the points beside the curve after those on it, NaN for stability there; None for a loaded branch."""
        return self._viewed("hbvib_branch_stored_field", field)

    def _viewed(self, function: str, field: Fields) -> FloatArray:
        lease = _Lease(self)
        self._leases.add(lease)  # before the handle is read: free looks for leases after it has taken the handle
        view = _new("hbvib_view")
        try:
            _call(function, self.handle, _member(Field, field), view)
        except BaseException:
            self._leases.discard(lease)  # the traceback holds it, and no array was made
            raise
        dtype = np.dtype(np.float64)
        shape = tuple(view.shape[:view.rank])
        if not view.data or 0 in shape:
            empty = np.empty(shape, dtype)
            empty.flags.writeable = False
            return empty
        lease.__array_interface__ = dict(  # type: ignore[attr-defined]
            version=3, typestr=dtype.str, shape=shape, data=(view.data, True),
            strides=tuple(dtype.itemsize * distance for distance in view.stride[:view.rank]))
        return np.asarray(lease)

    omega = _FieldProperty(Field.OMEGA, "Angular frequency.")
    amplitude = _FieldProperty(Field.AMPLITUDE, "Peak amplitude of the fundamental of the response dof.")
    residual = _FieldProperty(Field.RESIDUAL, "Relative residual.")
    newton_iterations = _FieldProperty(Field.NEWTON_ITERATIONS, "Newton iterations, as float64.")
    harmonics_used = _FieldProperty(Field.HARMONICS_USED, "Highest harmonic number carried, as float64.")
    slip_fraction = _FieldProperty(Field.SLIP_FRACTION, "Share of the period that each contact slips.")
    sampling_error = _FieldProperty(Field.SAMPLING_ERROR, "Relative change of forces with half the samples; NaN where a law"
                                     " failed at the other samples.")
    error_estimate = _FieldProperty(Field.ERROR_ESTIMATE, "Relative error of the response (modes: of the frequency) by"
                                     " harmonics left out; NaN where unknown, or with a fixed number unless estimate_error.")
    floquet_radius = _FieldProperty(Field.FLOQUET_RADIUS, "With `stability`: largest modulus of the ordinary Floquet"
                                     " multipliers; NaN where unknown.")
    unstable_directions = _FieldProperty(Field.UNSTABLE_DIRECTIONS, "With `stability`: number of those outside the unit"
                                          " circle, as float64; 0 for a stable motion.")
    free_sliders = _FieldProperty(Field.FREE_SLIDERS, "With `freedom`: number of free sliders, as float64, as Model.freedom"
                                   " lists them for one point; NaN where unknown.")
    d_amplitude_by_place = _FieldProperty(Field.D_AMPLITUDE_BY_PLACE, "With `freedom`: derivative of the amplitude by the place"
                                           " of each slider at a fixed frequency (points, contacts, 2); NaN where not free.")
    damping_error_estimate = _FieldProperty(Field.DAMPING_ERROR_ESTIMATE, "Modes: error of D, NaN as error_estimate.")
    damping_ratio = _FieldProperty(Field.DAMPING_RATIO, "Modes: damping ratio D.")
    mode_energy = _FieldProperty(Field.ENERGY, "Modes: twice the mean kinetic energy of a sector.")
    dissipation = _FieldProperty(Field.DISSIPATION, "Modes: work of friction per cycle and sector.")
    structural_loss = _FieldProperty(Field.STRUCTURAL_LOSS, "Modes: work of the structure's damping per cycle.")
    log10_amplitude = _FieldProperty(Field.LOG10_AMPLITUDE, "Modes: log10 of the amplitude, the parameter.")
    modal_amplitude = _FieldProperty(Field.MODAL_AMPLITUDE, "Modes: sqrt(X_1^H M X_1).")
    parameter_values = _FieldProperty(Field.PARAMETER_VALUE, """Parameter responses: value of the parameter.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, damping=0.1)
        >>> model.add_force(0, 0.2)
        >>> found = model.parameter_response(hbvib.Parameter("force"), (1, 3), omega=1.0, harmonics=1)
        >>> float(found.parameter_values[-1])
        3.0
        """)
    d_amplitude = _FieldProperty(Field.D_AMPLITUDE, "Parameter responses: total derivative of the amplitude by the"
                                  " parameter; NaN where there is none.")
    d_damping = _FieldProperty(Field.D_DAMPING, "Parameter responses of a mode: total derivative of its largest damping"
                                " ratio by the parameter.")
    modal_assurance = _FieldProperty(Field.MODAL_ASSURANCE, "Modes: likeness to the point before, 0 to 1.")
