"""Matrices, forces and rotation of a model."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Literal, Optional, Union, overload

import numpy as np
from numpy.typing import ArrayLike

from ._c import Block, MatrixKind, Part
from ._calls import _call
from ._convert import _array, _member, _whole
from ._results import Forces, Springs
from ._structs import _matrix
from ._units import _HasUnits

if TYPE_CHECKING:
    from ._choices import Blocks, MatrixKinds, Parts
    from ._results import ComplexArray, FloatArray


class _Matrices(_HasUnits):
    """Methods of Model for its structure and the forces on it."""

    @property
    def ndof(self) -> int:
        """Degrees of freedom, of one sector.

        >>> import hbvib
        >>> hbvib.Model(3).ndof
        3
        """
        return _call("hbvib_model_dofs", self.handle)

    @property
    def sectors(self) -> int:
        """Sectors; 1 for a plain structure.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-1))
        >>> model.sectors
        8
        """
        return _call("hbvib_model_sectors", self.handle)

    @property
    def engine_order(self) -> int:
        """Engine order of the excitation; 0 for a plain structure.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-1))
        >>> model.engine_order
        2
        """
        order = ctypes.c_int64()
        self._call("hbvib_model_wave", order)
        return order.value

    @property
    def forces(self) -> Forces:
        """The forces, read back in the order in which they were added.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> model.forces.force
        array([0.2+0.j])
        """
        kinds = [np.int64, np.int64, complex, np.int64]
        dof, harmonic, force, unbalance = self._listed("hbvib_model_forces", (), kinds)
        return Forces(dof, harmonic, force, unbalance != 0)

    @property
    def springs(self) -> Springs:
        """The linear springs of `add_springs`, read back.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.add_springs(0, hbvib.GROUND, 2.5)
        >>> model.springs.stiffness
        array([2.5])
        """
        return Springs(*self._listed("hbvib_model_springs", (), [np.int64] * 3 + [float]))

    @overload
    def matrix(self, which: MatrixKinds, block: Blocks = "own", *,
               sparse: Literal[False] = False) -> Union[FloatArray, ComplexArray]: ...

    @overload
    def matrix(self, which: MatrixKinds, block: Blocks = "own", *, sparse: bool) -> Any: ...

    def matrix(self, which: MatrixKinds, block: Blocks = "own", *, sparse: bool = False) -> Any:
        """A matrix, read back: (ndof, ndof), real where it has no imaginary part; without Rayleigh damping, springs and
        contacts. UnsupportedError where it was given per nodal diameter.

        which    as in set_matrix.
        block    of a cyclic model: "own", "next" (columns of the next sector) or "previous" (where it was given; else it
                 is the transpose of "next").
        sparse   True: a scipy matrix in compressed columns, for large models.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.matrix("stiffness")
        array([[ 2., -1.],
               [-1.,  2.]])
        """
        row, column, value = self._listed("hbvib_model_matrix", (_member(MatrixKind, which), _member(Block, block)),
                                          [np.int64, np.int64, complex])
        if not value.imag.any():
            value = value.real.copy()
        if sparse:
            from scipy.sparse import csc_matrix  # type: ignore[import-untyped, unused-ignore]
            return csc_matrix((value, (row, column)), shape=(self.ndof, self.ndof))
        dense = np.zeros((self.ndof, self.ndof), value.dtype)
        dense[row, column] = value
        return dense

    def set_matrix(self, which: MatrixKinds, matrix: Any, part: Parts = Part.FULL) -> None:
        """Sets a matrix: which is "mass", "damping", "stiffness", "structural" (D of the structural damping i D in
        harmonics above 0), "gyroscopic" (G, skew-symmetric), "stiffness_speed2" (K1 of K + Omega^2 K1) or a
        MatrixKind; matrix is ndof x ndof.

        part   "full": symmetric or Hermitian, which is checked; "lower", "upper": that triangle of such a one, the
               rest is not read; "general": any but the mass; "symmetric", "symmetric_lower", "symmetric_upper": the
               same for A = A^T, where A may be complex.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.set_matrix("damping", [[0.1, 0], [9, 0.1]], "upper")  # the 9 is not read
        >>> model.matrix("damping")
        array([[0.1, 0. ],
               [0. , 0.1]])
        """
        kind = _member(MatrixKind, which)
        self._call("hbvib_model_set_matrix", kind, _matrix(matrix, part, kind.name.lower()))

    def fix(self, dofs: ArrayLike) -> None:
        """Fixes degrees of freedom: they do not move, whatever matrices, contacts and forces say. Numbers stay as
        they are; pairs on the faces of a sector are fixed together.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.fix([1])
        >>> model.linear_modes(1).omega.round(12)  # sqrt(2)
        array([1.41421356])
        """
        still = _array("dofs", dofs if np.size(dofs) else np.empty(0, np.int64), np.int64).ravel()
        self._call("hbvib_model_fix", still.size, still)

    def set_rayleigh(self, alpha_mass: float, beta_stiffness: float) -> None:
        """Adds alpha_mass M + beta_stiffness K to the damping (1 / time, time); replaces an earlier call.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.set_rayleigh(0, 0.02)
        >>> model.damped_modes(2).damping_ratio.round(12)  # 0.01 omega
        array([0.01      , 0.01732051])
        """
        self._call("hbvib_model_set_rayleigh", alpha_mass, beta_stiffness)

    def set_loss_factor(self, loss_factor: float) -> None:
        """Structural damping i loss_factor K of the structure's own stiffness in harmonics above 0; replaces an
        earlier call.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.set_loss_factor(0.01)
        >>> model.add_force(0, 1)
        >>> model.forced_response((0.5, 2)).peaks().amplitude.round(2)
        array([50.  , 16.67])
        """
        self._call("hbvib_model_set_loss_factor", loss_factor)

    def set_modal_damping(self, ratios: ArrayLike) -> None:
        """Damping ratios of the lowest natural modes without contacts, in the order of rising frequency, of each
        nodal diameter; call it when matrices, springs and fixed degrees of freedom are complete. []: none.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.set_modal_damping([0.01, 0.02])
        >>> model.damped_modes(2).damping_ratio.round(12)
        array([0.01, 0.02])
        """
        given = _array("ratios", ratios, np.float64).ravel()
        self._call("hbvib_model_set_modal_damping", given.size, given)

    def set_speed(self, speed: Optional[float] = None, *, per_omega: Optional[float] = None) -> None:
        """Speed of rotation: fixed, or tied to the frequency of the response, Omega = per_omega omega (1 / EO for an
        excitation of engine order EO).

        >>> import hbvib
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=[[1, 0], [0, 1]])  # a disk, x and y
        >>> model.set_matrix("gyroscopic", [[0, 0.2], [-0.2, 0]])
        >>> model.set_speed(1.0)
        >>> model.damped_modes(2).omega.round(6)
        array([0.904988, 1.104988])
        """
        if (speed is None) == (per_omega is None):
            raise TypeError("set_speed needs either a speed or per_omega")
        if per_omega is None:
            self._call("hbvib_model_set_speed", speed)
        else:
            self._call("hbvib_model_set_speed_per_omega", per_omega)

    def set_coupling(self, which: MatrixKinds, to_next: Any) -> None:
        """Coupling of a sector (rows) to the next (columns), ndof x ndof; its transpose couples to the previous.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3)
        >>> model.set_coupling("stiffness", -1)
        >>> model.matrix("stiffness", "next")
        array([[-1.]])
        """
        kind = _member(MatrixKind, which)
        coupling = _matrix(to_next, Part.GENERAL, f"coupling of the {kind.name.lower()}")
        self._call("hbvib_cyclic_set_coupling", kind, coupling)

    def set_coupling_previous(self, which: MatrixKinds, to_previous: Any) -> None:
        """Coupling to the previous sector where it is not the transpose: damping and stiffness only.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(1, sectors=8, mass=1, stiffness=3)
        >>> model.set_coupling("damping", 0.1)
        >>> model.set_coupling_previous("damping", -0.1)  # without symmetry
        >>> model.matrix("damping", "previous")
        array([[-0.1]])
        """
        kind = _member(MatrixKind, which)
        coupling = _matrix(to_previous, Part.GENERAL, f"coupling of the {kind.name.lower()}")
        self._call("hbvib_cyclic_set_coupling_previous", kind, coupling)

    def set_diameter(self, which: MatrixKinds, diameter: int, matrix: Any, part: Parts = Part.FULL) -> None:
        """The complex matrix of the wave of a signed nodal diameter, modulo the sectors, instead of sector blocks. A wave
        of which only the other sense was given has the conjugate of that.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(1, sectors=4, engine_order=1)
        >>> for diameter in range(3):
        ...     model.set_diameter("mass", diameter, 1)
        ...     model.set_diameter("stiffness", diameter, 1 + diameter)
        ...
        >>> model.linear_modes(1, diameter=2).omega.round(12)  # sqrt(3)
        array([1.73205081])
        """
        kind = _member(MatrixKind, which)
        self._call("hbvib_cyclic_set_diameter", kind, _whole(diameter, name="diameter"),
                   _matrix(matrix, part, kind.name.lower()))

    def set_wave(self, engine_order: int) -> None:
        """Engine order of the excitation, of any sign and size.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-1))
        >>> model.set_wave(3)
        >>> model.engine_order
        3
        """
        self._call("hbvib_cyclic_set_wave", _whole(engine_order, name="engine_order"))

    def add_force(self, dof: int, force: complex, harmonic: int = 1) -> None:
        """Adds Re(force exp(i harmonic omega t)) on a degree of freedom, a peak value; harmonic 0 is constant.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.add_force(0, 0.2)       # 0.2 cos(omega t)
        >>> model.add_force(0, -0.1j, 3)  # 0.1 sin(3 omega t)
        >>> model.forces.harmonic
        array([1, 3])
        """
        if isinstance(force, (str, bytes)):
            raise TypeError(f"force needs a number, not {force!r}")
        force = complex(force)
        self._call("hbvib_model_add_force", _whole(dof, name="dof"), _whole(harmonic, name="harmonic"), force.real, force.imag)

    def add_unbalance(self, dof_x: int, dof_y: int, m_e: float, phase: float = 0.0) -> None:
        """Adds m_e omega^2 cos(omega t + phase) on dof_x and m_e omega^2 sin(omega t + phase) on dof_y, omega the
        frequency of the response.

        >>> import hbvib
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=[[1, 0], [0, 1]], rayleigh=(0.1, 0))
        >>> model.add_unbalance(0, 1, m_e=1e-3)
        >>> branch = model.forced_response((0.5, 1.5), response_dof=0)
        >>> branch.peaks().amplitude.round(4)  # 1e-3 / 0.1
        array([0.01])
        """
        self._call("hbvib_model_add_unbalance", _whole(dof_x, name="dof_x"), _whole(dof_y, name="dof_y"), m_e, phase)

    def clear_forces(self) -> None:
        """Removes all forces, unbalances included.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> model.clear_forces()
        >>> len(model.forces.dof)
        0
        """
        self._call("hbvib_model_clear_forces")
