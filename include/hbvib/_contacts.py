"""Contacts of a model."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Literal, Optional, overload

import numpy as np
from numpy.typing import ArrayLike

from ._c import GROUND, ContactKind
from ._calls import _call, _Owner
from ._convert import _array, _columns, _numbers, _whole
from ._law import _REQUIRED, _law, _side
from ._results import Contact
from ._structs import _new
from ._types import ContactConstants

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._choices import ContactKinds


def _sides(a: int, b: int, sector_offset: int) -> tuple[int, int, int]:
    """The places of a spring or joint, whole numbers."""
    return _whole(a, name="a"), _whole(b, name="b"), _whole(sector_offset, name="sector_offset")


class _Contacts(_Owner):
    """Methods of Model for its contacts, one by one and many at once."""

    @property
    def contacts(self) -> int:
        """Number of contacts, user forces included.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> model.contacts
        1
        """
        return _call("hbvib_model_contacts", self.handle)

    def contact(self, number: int) -> Contact:
        """A contact, read back: its kind, sides and constants. OutOfRangeError (an IndexError) for a number that no
        contact has.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> model.contact(0).kind.name, model.contact(0).a, model.contact(0).constants
        ('JENKINS', (0, -1, -1), {'kt': 1.0, 'mu': 0.3, 'preload': 1.0})
        """
        law, per_speed2 = _new("hbvib_contact"), ctypes.c_double()
        self._call("hbvib_model_contact", number, law, per_speed2)
        names = [name for name in ContactConstants.__annotations__ if name != "sector_offset"]
        values = {name: getattr(law, name) for name in names}
        given = {name: tuple(value) if isinstance(value, ctypes.Array) else value for name, value in values.items()}
        if all(dof == GROUND for dof in given["rotation"]):
            given["rotation"] = ()
        kind = ContactKind(law.kind)
        needed = _REQUIRED.get(kind, ())
        constants = {name: value for name, value in given.items()
                          if name in needed or (any(value) if isinstance(value, tuple) else value)}
        return Contact(kind, tuple(law.dof_a), tuple(law.dof_b), law.sector_offset, constants, per_speed2.value)

    def _identified(self, name: str, *arguments: Any) -> int:
        """Calls a function that adds contacts and returns the number of the first."""
        first = ctypes.c_int64()
        self._call(name, *arguments, first)
        return first.value

    @overload
    def add_contact(self, kind: Literal["jenkins", ContactKind.JENKINS], a: ArrayLike, b: ArrayLike = GROUND, *,
                    kt: float, mu: float, preload: float, sector_offset: int = 0, normal: ArrayLike = (0, 0, 0),
                    tangent: ArrayLike = (0, 0, 0), rotation: ArrayLike = (-1, -1, -1), arm: ArrayLike = (0, 0, 0),
                    turn: float = 0) -> int: ...

    @overload
    def add_contact(self, kind: Literal["friction_2d", ContactKind.FRICTION_2D], a: ArrayLike, b: ArrayLike = GROUND,
                    *, kt: float, kn: float, mu: float, preload: float = 0, gap: float = 0, sector_offset: int = 0,
                    normal: ArrayLike = (0, 0, 0), tangent: ArrayLike = (0, 0, 0), rotation: ArrayLike = (-1, -1, -1), arm: ArrayLike = (0, 0, 0),
                    turn: float = 0) -> int: ...

    @overload
    def add_contact(self, kind: Literal["friction_3d", ContactKind.FRICTION_3D], a: ArrayLike, b: ArrayLike = GROUND,
                    *, kt: float, mu: float, kn: float = 0, preload: float = 0, gap: float = 0,
                    sector_offset: int = 0, normal: ArrayLike = (0, 0, 0), tangent: ArrayLike = (0, 0, 0), rotation: ArrayLike = (-1, -1, -1), arm: ArrayLike = (0, 0, 0),
                    turn: float = 0) -> int: ...

    @overload
    def add_contact(self, kind: Literal["unilateral", ContactKind.UNILATERAL], a: ArrayLike, b: ArrayLike = GROUND, *,
                    kn: float, preload: float = 0, gap: float = 0, sector_offset: int = 0,
                    normal: ArrayLike = (0, 0, 0), tangent: ArrayLike = (0, 0, 0), rotation: ArrayLike = (-1, -1, -1), arm: ArrayLike = (0, 0, 0),
                    turn: float = 0) -> int: ...

    @overload
    def add_contact(self, kind: Literal["cubic", ContactKind.CUBIC], a: ArrayLike, b: ArrayLike = GROUND, *,
                    cubic: float, kt: float = 0, sector_offset: int = 0, normal: ArrayLike = (0, 0, 0),
                    tangent: ArrayLike = (0, 0, 0), rotation: ArrayLike = (-1, -1, -1), arm: ArrayLike = (0, 0, 0),
                    turn: float = 0) -> int: ...

    @overload
    def add_contact(self, kind: Literal["regularised", ContactKind.REGULARISED], a: ArrayLike, b: ArrayLike = GROUND,
                    *, mu: float, preload: float, velocity: float, sector_offset: int = 0,
                    normal: ArrayLike = (0, 0, 0), tangent: ArrayLike = (0, 0, 0), rotation: ArrayLike = (-1, -1, -1), arm: ArrayLike = (0, 0, 0),
                    turn: float = 0) -> int: ...

    @overload
    def add_contact(self, kind: ContactKind, a: ArrayLike, b: ArrayLike = GROUND,
                    **constants: Unpack[ContactConstants]) -> int: ...

    def add_contact(self, kind: Any, a: Any, b: Any = GROUND, **constants: Any) -> int:
        """Adds a contact and returns its number.

        kind   a ContactKind or its name: "jenkins", "friction_2d", "friction_3d", "unilateral", "cubic", "regularised".
        a, b   degree of freedom of each side, or a sequence of them in the directions in which the law acts (t1 and n
               of friction_2d; t1, t2 and n, or t1 and t2 under a constant load, of friction_3d), or all three places.
        Constants of the kinds, those in brackets may be left out; TypeError where another one is:
        jenkins       kt, mu, preload            force kt y of a spring in series with a slider of limit mu preload
        friction_2d   kt, kn, mu, [preload, gap]   the same, limit mu N, N = max(preload + kn (x_b - x_a - gap), 0) along n
        friction_3d   kt, mu, [kn, preload, gap]   the same in the plane of t1 and t2; without kn under the preload
        unilateral    kn, [preload, gap]         N alone
        cubic         cubic, [kt]                kt y + cubic y^3
        regularised   mu, preload, velocity      mu preload tanh(y' / velocity)
        kt and kn are forces per length, preload a force, gap a length, velocity a length per time, y = x_a - x_b.
        normal, tangent   directions in the axes of three degrees of freedom a side.
        sector_offset     side b lies in sector s + sector_offset of a cyclic model.
        rotation, arm     side a is a point of a rigid body: its three rotations (-1: none), and the point from the centre
                          of mass, whose translations are a.
        turn              angle by which the axes of b are turned about the third one of a.

        >>> import hbvib
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=[[1, 0], [0, 1]])
        >>> model.add_contact("jenkins", 0, 1, kt=1, mu=0.3, preload=1)  # between degrees of freedom 0 and 1
        0
        >>> model.add_contact("unilateral", 1, kn=2, gap=0.1)  # between degree of freedom 1 and the ground
        1
        >>> model.add_contact("friction_2d", [0, 1], kt=1, kn=2, mu=0.3, preload=1)  # along 0 under a load along 1
        2
        """
        law = _law("add_contact", kind, constants)
        law.dof_a[:], law.dof_b[:] = (_side(ContactKind(law.kind), side) for side in (a, b))
        return self._identified("hbvib_model_add_contact", law)

    def set_slider(self, contact: int, place: float, direction: int = 0) -> None:
        """Places the slider of a friction contact before any motion: the residual state that an assembly or an earlier
        load has left. A contact that sticks through the period has the force kt (x - place); a place from which its
        limit would drag the slider acts as the nearest one within, and a contact that slips or opens forgets it.

        direction   0 for t1; 1 for t2, of friction_3d.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.01)
        >>> model.set_slider(contact, 0.1)
        >>> print("%.3f" % model.forced_response((0.9, 0.9)).harmonics(0)[0, 0].real)  # its spring of 1 beside that of 1
        0.050
        """
        self._call("hbvib_model_set_slider", contact, direction, place)

    def set_preload(self, contact: int, preload: float, per_speed2: float = 0.0) -> None:
        """Changes the normal load of a contact: preload + per_speed2 Omega^2 at the speed of rotation Omega; m R for a
        ring of mass m at the radius R.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> model.set_preload(0, 2.5)
        >>> model.contact(0).constants["preload"]
        2.5
        """
        self._call("hbvib_model_set_preload_at_speed", contact, preload, per_speed2)

    def add_jenkins(self, a: ArrayLike, b: ArrayLike, kt: ArrayLike, mu: ArrayLike, preload: ArrayLike,
                    sector_offset: ArrayLike = 0) -> range:
        """Adds many Jenkins contacts from arrays of one length, or numbers for all; returns their numbers.

        >>> import hbvib
        >>> model = hbvib.Model(3)
        >>> model.add_jenkins([0, 1, 2], hbvib.GROUND, kt=1, mu=0.3, preload=[1, 2, 3])
        range(0, 3)
        """
        sides = _columns(a=(a, np.int64), b=(b, np.int64), kt=(kt, float), mu=(mu, float), preload=(preload, float),
                         sector_offset=(sector_offset, np.int64))
        n, (dof_a, dof_b, *constants, offset) = len(sides[0]), sides
        first = self._identified("hbvib_model_add_jenkins", n, dof_a, dof_b, offset, *constants)
        return range(first, first + n)

    def add_springs(self, a: ArrayLike, b: ArrayLike, stiffness: ArrayLike, sector_offset: ArrayLike = 0) -> None:
        """Adds linear springs from arrays of one length, or numbers for all.

        >>> import hbvib
        >>> model = hbvib.Model(3)
        >>> model.add_springs([0, 1], [1, 2], 2.5)
        >>> model.springs.stiffness
        array([2.5, 2.5])
        """
        dof_a, dof_b, numbers, offset = _columns(a=(a, np.int64), b=(b, np.int64), stiffness=(stiffness, float),
                                                 sector_offset=(sector_offset, np.int64))
        self._call("hbvib_model_add_springs", len(dof_a), dof_a, dof_b, offset, numbers)

    def add_iwan(self, a: int, b: int = GROUND, *, slip_force: float, stiffness: float, chi: float, beta: float,
                 elements: int = 100, sector_offset: int = 0) -> range:
        """Adds an Iwan joint as that many Jenkins contacts; returns their numbers.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.add_iwan(0, slip_force=1, stiffness=1, chi=-0.5, beta=1, elements=20)
        range(0, 20)
        """
        elements = _whole(elements, name="elements")
        first = self._identified("hbvib_model_add_iwan", *_sides(a, b, sector_offset), slip_force, stiffness, chi, beta,
                                 elements)
        return range(first, first + elements)

    def add_table(self, a: int, b: int = GROUND, *, displacement: ArrayLike, force: ArrayLike,
                  sector_offset: int = 0) -> int:
        """Adds a spring whose force is a table: straight between its points, displacement ascending.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.add_table(0, displacement=[-1, 0, 1], force=[-1, 0, 3])  # stiffer in one direction
        0
        """
        y = _array("displacement", displacement, shape=[None])
        f = _array("force", force, shape=[len(y)])
        return self._identified("hbvib_model_add_table", *_sides(a, b, sector_offset), len(y), y, f)

    def add_spring_damper(self, a: int, b: int = GROUND, *, spring: ArrayLike = (), damper: ArrayLike = (),
                          sector_offset: int = 0) -> int:
        """Adds f = sum spring[k] y^(k+1) + sum damper[k] v^(k+1), y the motion of a over b and v = y'.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.add_spring_damper(0, spring=[0, 0, 0.5], damper=[0, 0.1])  # 0.5 y^3 + 0.1 v^2
        0
        """
        spring, damper = _array("spring", spring, shape=[None]), _array("damper", damper, shape=[None])
        return self._identified("hbvib_model_add_spring_damper", *_sides(a, b, sector_offset), len(spring), spring,
                                len(damper), damper)

    def add_polynomial(self, dofs: ArrayLike, direction: ArrayLike, coefficient: ArrayLike,
                       x_powers: Optional[ArrayLike] = None, v_powers: Optional[ArrayLike] = None) -> int:
        """Adds terms coefficient[t] prod x_j^x_powers[t, j] prod v_j^v_powers[t, j] to the force on
        dofs[direction[t]]; powers are terms x dofs, None: all 0.

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> model.add_polynomial([0, 1], direction=[0], coefficient=[2.0], x_powers=[[1, 2]])  # 2 x_0 x_1^2 on 0
        0
        """
        dofs, direction = _array("dofs", dofs, np.int64, [None]), _array("direction", direction, np.int64, [None])
        coefficient = _array("coefficient", coefficient, shape=[len(direction)])
        powers = []
        for name, given in (("x_powers", x_powers), ("v_powers", v_powers)):
            if given is not None:
                wide = _array(name, given, np.int64, [len(direction), len(dofs)])
                given = wide.clip(-1, 2**31 - 1).astype(np.int32)  # out of range stays so
            powers.append(given)
        return self._identified("hbvib_model_add_polynomial", dofs, len(dofs), len(direction), direction, coefficient,
                                *powers)

    def add_stiffness_tensors(self, dofs: ArrayLike, quadratic: Optional[ArrayLike] = None,
                              cubic: Optional[ArrayLike] = None) -> int:
        """Adds f_i = sum quadratic[i, j, k] x_j x_k + sum cubic[i, j, k, l] x_j x_k x_l on dofs[i].

        >>> import hbvib
        >>> stiffness = [[2, -1], [-1, 2]]
        >>> model = hbvib.Model(mass=[[1, 0], [0, 1]], stiffness=stiffness)
        >>> import numpy as np
        >>> cubic = np.zeros((2, 2, 2, 2))
        >>> cubic[0, 0, 0, 0] = 0.5
        >>> model.add_stiffness_tensors([0, 1], cubic=cubic)  # 0.5 x_0^3 on degree of freedom 0
        0
        """
        dofs = _array("dofs", dofs, np.int64, [None])
        n = len(dofs)
        quadratic = None if quadratic is None else _array("quadratic", quadratic, shape=[n] * 3)
        cubic = None if cubic is None else _array("cubic", cubic, shape=[n] * 4)
        return self._identified("hbvib_model_add_stiffness_tensors", dofs, n, quadratic, cubic)

    def add_patch(self, kind: ContactKinds, a: ArrayLike, b: Optional[ArrayLike], normal: ArrayLike, area: ArrayLike, *,
                  tangent: Optional[ArrayLike] = None, pressure: Optional[ArrayLike] = None,
                  gap: Optional[ArrayLike] = None, **constants: Any) -> range:
        """Adds a contact patch of n node pairs, each with an area; returns the numbers of the contacts.

        a, b      degrees of freedom along three axes, n x 3; b None: the ground.
        normal, tangent   directions, n x 3, or one for all.
        area, pressure, gap   n numbers, or one for all.
        kt, kn, mu, preload ...   constants of the kind per unit of area, sector_offset, as in add_contact.

        >>> import hbvib
        >>> model = hbvib.Model(6)
        >>> model.add_patch("friction_3d", [[0, 1, 2], [3, 4, 5]], None, normal=(0, 0, 1), area=[0.5, 0.25], pressure=10,
        ...                 kt=1, kn=2, mu=0.3)
        range(0, 2)
        >>> model.contact(1).constants["preload"]  # 0.25 * 10
        2.5
        """
        a = _array("a", a, np.int64, [None, 3])
        n = len(a)

        def each(name: str, value: Any, *shape: int) -> Any:
            if value is None:
                return None
            numbers = _numbers(name, value, np.float64)
            if numbers.shape == shape[1:]:
                numbers = np.broadcast_to(numbers, shape)
            return _array(name, numbers, shape=shape)

        b = None if b is None else _array("b", b, np.int64, [n, 3])
        first = self._identified(
            "hbvib_model_add_patch", _law("add_patch", kind, constants), n, a, b, each("normal", normal, n, 3),
            each("tangent", tangent, n, 3), each("area", area, n), each("pressure", pressure, n), each("gap", gap, n))
        return range(first, first + n)
