"""Parts of a model that are read back, as named tuples."""
from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ._c import ContactKind

if TYPE_CHECKING:
    from typing import Any

    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]
    ComplexArray = NDArray[np.complex128]
    IntArray = NDArray[np.int64]

__all__ = ["AeroEntries", "Contact", "Forces", "Springs"]


class Contact(NamedTuple):
    """A contact of a model, read back.

    kind            ContactKind; TABLE, POLYNOMIAL and CALLER_LAW have no constants.
    a, b            degrees of freedom of the sides along t1, t2 and n, or GROUND.
    sector_offset   side b lies in sector s + sector_offset.
    constants       kt, kn, mu, preload, gap, cubic, velocity, normal and tangent, those that are not zero.
    per_speed2      the normal load is preload + per_speed2 Omega^2 at the speed of rotation Omega.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> model.contact(0).a, model.contact(0).constants["kt"]
    ((0, -1, -1), 1.0)
    """
    kind: ContactKind
    a: tuple[int, int, int]
    b: tuple[int, int, int]
    sector_offset: int
    constants: dict[str, Any]
    per_speed2: float


class Forces(NamedTuple):
    """Forces of a model: degree of freedom, harmonic, complex peak value; over omega^2 where `unbalance` is True.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, damping=0.1, stiffness=1)
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> model.forces.dof, model.forces.force
    (array([0]), array([0.2+0.j]))
    """
    dof: IntArray
    harmonic: IntArray
    force: ComplexArray
    unbalance: NDArray[np.bool_]


class AeroEntries(NamedTuple):
    """Aerodynamic forces of a model: degrees of freedom of force and motion, sector of the motion, complex coefficient.

    >>> import hbvib
    >>> model = hbvib.Model.cyclic(1, sectors=8, engine_order=2, mass=1, stiffness=3)
    >>> model.set_aero(0, [-0.1, 0.05, -0.05], [0, 1, -1])
    >>> len(model.aero().offset)
    3
    """
    dof_force: IntArray
    dof_motion: IntArray
    offset: IntArray
    coefficient: ComplexArray


class Springs(NamedTuple):
    """Linear springs of a model: sides a and b (GROUND is -1), sector_offset, stiffness.

    >>> import hbvib
    >>> model = hbvib.Model(2)
    >>> model.add_springs([0], [1], 2.5)
    >>> model.springs.stiffness
    array([2.5])
    """
    a: IntArray
    b: IntArray
    sector_offset: IntArray
    stiffness: FloatArray
