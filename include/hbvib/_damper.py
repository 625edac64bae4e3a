"""Dampers under the platforms of blades, and centrifugal forces."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Mapping, NamedTuple, Sequence

from ._calls import _Owner
from ._library import structs
from ._structs import _options

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class DamperPlace(NamedTuple):
    """Degrees of freedom and contacts of a damper in its model; made by Model.add_damper.

    >>> import hbvib
    >>> hbvib.DamperPlace(range(1, 4), range(0, 2)).dofs[1]
    2
    """
    dofs: range
    contacts: range


class _Dampers(_Owner):
    """Methods of Model for dampers."""

    def add_damper(self, faces: Sequence[Mapping[str, Any]], *, mass: float, motions: int = 3, inertia: ArrayLike = (0, 0, 0),
                   radius: float = 0, length: float = 0, orbit: float = 0, support: ArrayLike = (0, 0),
                   support_damping: ArrayLike = (0, 0)) -> DamperPlace:
        """Adds a damper under platforms: a rigid body whose motions are new degrees of freedom behind all others, so that
        matrices that are set later have the new size; in a cyclic model one in each sector. Axes: x along the wheel
        towards the next sector, y outward, z along the axis of rotation.

        faces      on platforms, each a dict of: dofs (three degrees of freedom of the platform along x, y and z, -1 the
                   ground), sector_offset, angle (between the platform and the direction along the wheel in radians,
                   positive on the side of the next sector), turn (angle by which the axes of dofs are turned about z),
                   centre and width across z (of a face that is no line of a cylinder), points_across and points_along,
                   kt and kn of the whole face, mu, gap.
        motions    3: along x and y and the roll about z, with contacts friction_2d; 6: all, with friction_3d.
        inertia    about x, y and z; zeros: of a solid cylinder.
        radius     of a cylinder, whose faces are lines; 0: faces have their centres.
        length     along z, over which points are spread.
        orbit      distance of the centre of mass from the axis of rotation: the force mass orbit Omega^2 acts outward.
        support, support_damping   to the ground, of translations and of rotations.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))  # a blade that moves along the wheel
        >>> faces = [dict(dofs=[-1, -1, -1], angle=-0.8, kt=1, kn=1.5, mu=0.6),
        ...          dict(dofs=[0, -1, -1], angle=0.8, kt=1, kn=1.5, mu=0.15)]
        >>> model.add_damper(faces, mass=0.01, radius=0.05, length=0.2, orbit=25)
        DamperPlace(dofs=range(1, 4), contacts=range(0, 2))
        >>> model.set_speed(2.0)
        >>> model.forces.force  # outward
        array([1.+0.j])
        """
        own = structs["hbvib_damper_face"]
        each = [_options("add_damper", "hbvib_damper_face", face) for face in faces]
        array = (own * len(each))(*each)
        damper = _options("add_damper", "hbvib_damper", dict(
            motions=motions, mass=mass, inertia=inertia, radius=radius, length=length, orbit=orbit, support=support,
            support_damping=support_damping))
        damper.faces, damper.faces_len = ctypes.addressof(array), len(each)
        dof, contact = ctypes.c_int64(), ctypes.c_int64()
        model: Any = self
        self._call("hbvib_model_add_damper", damper, dof, contact)
        return DamperPlace(range(dof.value, model.ndof), range(contact.value, model.contacts))

    def add_centrifugal(self, dof: int, mass_radius: float) -> None:
        """Adds the constant force mass_radius Omega^2 on a degree of freedom, at the speed Omega of the model.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=10)
        >>> model.add_centrifugal(0, 0.5)
        >>> model.set_speed(2.0)
        >>> model.static_history().motion.round(6)
        array([[1.]])
        """
        self._call("hbvib_model_add_centrifugal", dof, mass_radius)
