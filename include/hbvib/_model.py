"""The model: how it is made, copied, saved and freed. Its other methods are in the modules of its bases."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike

from ._aero import _Aero
from ._analyses import _Analyses
from ._axis_nodes import axis_nodes
from ._band import _Bands
from ._batch import _Batches
from ._blade_modes import _BladeModes
from ._c import MatrixKind, SectorFrame
from ._caller_law import _CallerLaws
from ._calls import _call
from ._convert import _array, _member, _whole
from ._damper import _Dampers
from ._fit import _Fits
from ._intentional import _Intentional
from ._library import lib
from ._life import _Lives
from ._linear_modes import _LinearModes
from ._mode_band import _ModeBands
from ._sensitivity import _Sensitivity
from ._static_history import _StaticHistories
from ._structs import _new
from ._time_integration import _TimeIntegration
from ._time_sweep import _TimeSweeps
from ._wheel import _Wheels
from ._wheel_identify import _WheelIdentifications
from ._wheel_quantile import _WheelQuantiles

if TYPE_CHECKING:
    from ._choices import MatrixKinds, SectorFrames


class Model(_CallerLaws, _Aero, _LinearModes, _Analyses, _TimeIntegration, _Sensitivity, _Batches, _Bands, _ModeBands, _Fits,
            _StaticHistories, _Wheels, _WheelQuantiles, _WheelIdentifications, _BladeModes, _Intentional, _Dampers, _Lives, _TimeSweeps):
    """A structure with its contacts and forces; `Model.cyclic` makes one of equal sectors, `Model.sector` one of a
    sector with both faces.

    ndof       degrees of freedom; may be left out where a matrix is given.
    mass, damping, stiffness   ndof x ndof matrices, symmetric or Hermitian: arrays, scipy.sparse, or a number for
               one degree of freedom; zero where left out. See `set_matrix` for others.
    rayleigh   (alpha, beta): adds alpha M + beta K to the damping.

    Freed by `free`, at the end of a `with` block, or with the last reference. `copy.copy` and `clone` copy it.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> model
    <hbvib.Model: 1 degree of freedom, 1 contact>
    """

    _release = staticmethod(lib.hbvib_model_free)

    def __init__(self, ndof: Optional[int] = None, *, mass: Any = None, damping: Any = None, stiffness: Any = None,
                 rayleigh: Optional[Sequence[float]] = None) -> None:
        self._create(None, ndof, {"mass": mass, "damping": damping, "stiffness": stiffness}, {}, rayleigh)

    @classmethod
    def cyclic(cls, ndof: Optional[int] = None, *, sectors: int, engine_order: int = 0, mass: Any = None,
               damping: Any = None, stiffness: Any = None, coupling: Optional[dict[str, Any]] = None,
               rayleigh: Optional[Sequence[float]] = None) -> Model:
        """A wheel of equal sectors under an engine order; ndof and matrices are those of one sector.

        coupling   matrices of a sector (rows) to the next one (columns): dict(stiffness=..., mass=...).
        engine_order   sector s + 1 lags behind s by 2 pi engine_order / sectors per harmonic; any sign and size.

        >>> import hbvib
        >>> model = hbvib.Model.cyclic(sectors=8, engine_order=2, mass=1, stiffness=3, coupling=dict(stiffness=-1))
        >>> model
        <hbvib.Model: 1 degree of freedom, 8 sectors, engine order 2, 0 contacts>
        >>> model.linear_modes(1, diameter=2).omega.round(12)
        array([1.73205081])
        """
        model = cls.__new__(cls)
        model._create(sectors, ndof, {"mass": mass, "damping": damping, "stiffness": stiffness}, coupling or {},
                      rayleigh)
        model.set_wave(engine_order)
        return model

    @classmethod
    def sector(cls, *, stiffness: Any, mass: Any, damping: Any = None, sectors: int, engine_order: int,
               left: ArrayLike, right: ArrayLike, fixed: ArrayLike = (), frame: SectorFrames = "cartesian",
               axis: ArrayLike = (0, 0, 1), direction: int = 1, coordinates: Any = None, on_axis: Any = None) -> Model:
        """A wheel from one sector with both faces, as a finite-element program writes it. The numbering of the sector
        is kept for matrices, contacts, forces and results; its couplings follow from its matrices.

        stiffness, mass, damping   matrices of the sector, with the degrees of freedom of both faces.
        left, right   degrees of freedom of both faces, of equal shape: (pairs, 3) x, y, z, or (pairs, 6) with
                      rotations, in a Cartesian frame, any shape in a cylindrical one; -1 where a component is missing.
        fixed         degrees of freedom that do not move.
        frame         "cartesian": the axes of both faces are equal; "cylindrical": any frame that turns with the
                      sector, as r, theta, z at each node.
        axis          of the wheel, through the origin.
        direction     1 or -1: sense about the axis in which sector s + 1 follows s. The wave has its sense from the
                      sign of engine_order.
        coordinates   (left, right), Cartesian positions of the nodes, (pairs, 3) each, which are then checked.
        on_axis       x, y, z of nodes on the axis, (nodes, 3), which are in neither face: they move along it in diameter 0, across it
                      in diameter 1, not in other waves. ndof is larger by three for each of them, whose rows come last.

        >>> import hbvib
        >>> import numpy as np
        >>> k = np.array([[1, -1], [-1, 1]])  # a spring from the left face to the right one
        >>> model = hbvib.Model.sector(stiffness=k, mass=np.eye(2) / 2, sectors=8, engine_order=2, left=[0], right=[1],
        ...                            frame="cylindrical")
        >>> model.linear_modes(1, diameter=2).omega.round(12)  # sqrt(2 - 2 cos(2 pi 2 / 8))
        array([1.41421356])
        """
        faces = [_array(name, face, np.int64) for name, face in (("left", left), ("right", right))]
        for name, face in zip(("left", "right"), faces):
            if face.ndim not in (1, 2):
                raise ValueError(f"{name} has shape {face.shape}, needs (pairs, components)")
        if faces[0].ndim == faces[1].ndim == 2 and faces[0].shape[1] != faces[1].shape[1]:
            raise ValueError(f"left has shape {faces[0].shape}, right {faces[1].shape}: needs equal shapes")
        components = faces[0].shape[1] if faces[0].ndim == 2 else 1
        centre = axis_nodes(on_axis, stiffness, _member(SectorFrame, frame) == SectorFrame.CARTESIAN)
        if centre is not None:
            faces = [np.concatenate([face.reshape(-1, 3), more]) for face, more in zip(faces, (centre.nodes, centre.images))]
            components = 3
            stiffness = centre.extended(stiffness, True)
            mass, damping = (None if matrix is None else centre.extended(matrix, False) for matrix in (mass, damping))
            if coordinates is not None:
                more = centre.beside(axis, direction * 2 * np.pi / sectors)
                coordinates = [np.concatenate([np.asarray(at, float), of]) for at, of in zip(coordinates, more)]
        places = dict.fromkeys(("left_coordinates", "right_coordinates"))
        if coordinates is not None:
            for name, face, positions in zip(places, faces, coordinates):
                places[name] = _array(name, positions, np.float64, [len(face), 3])
        still = _array("fixed", fixed if np.size(fixed) else np.empty(0, np.int64), np.int64).ravel()
        ndof = (*np.shape(stiffness), 1)[0]
        description = _new("hbvib_sector", frame=_member(SectorFrame, frame), ndof=ndof, sectors=sectors,
                           engine_order=engine_order, components=components, left=faces[0], left_len=faces[0].size,
                           right=faces[1], right_len=faces[1].size, fixed=still, fixed_len=still.size, axis=axis,
                           direction=direction, **places)
        model, handle = cls.__new__(cls), ctypes.c_void_p()
        model._handle = None
        _call("hbvib_cyclic_from_sector", description, handle)
        model._handle, model._kept = handle.value, []
        for kind, value in ((MatrixKind.STIFFNESS, stiffness), (MatrixKind.MASS, mass), (MatrixKind.DAMPING, damping)):
            if value is not None:
                model.set_matrix(kind, value)
        return model

    def _create(self, sectors: Any, ndof: Any, matrices: Mapping[MatrixKinds, Any], coupling: Mapping[Any, Any],
                rayleigh: Any) -> None:
        given = [(kind, value) for kind, value in matrices.items() if value is not None]
        if ndof is None:
            if not given:
                raise TypeError("needs ndof or a matrix")
            ndof = (*np.shape(given[0][1]), 1)[0]
        handle = ctypes.c_void_p()
        if sectors is None:
            _call("hbvib_model_new", _whole(ndof, name="ndof"), handle)
        else:
            _call("hbvib_cyclic_new", _whole(ndof, name="ndof"), _whole(sectors, name="sectors"), handle)
        self._handle, self._kept = handle.value, []
        for kind, value in given:
            self.set_matrix(kind, value)
        for kind, value in coupling.items():
            self.set_coupling(kind, value)
        if rayleigh is not None:
            self.set_rayleigh(*rayleigh)

    def free(self) -> None:
        """Frees the model; branches solved from it stay. FreedError if it was freed, BusyError while in use.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.free()
        >>> model
        <hbvib.Model, freed>
        """
        _call("hbvib_model_free", self.handle)
        self._handle, self._kept = None, []

    def clone(self) -> Model:
        """A copy with the same matrices, contacts, forces and user forces.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> copy = model.clone()
        >>> copy.add_force(0, 0.2)
        >>> len(copy.forces.dof), len(model.forces.dof)
        (1, 0)
        """
        handle, kept = ctypes.c_void_p(), self._kept
        self._call("hbvib_model_clone", handle)
        copy = type(self).__new__(type(self))
        copy._handle, copy._kept, copy._units = handle.value, list(kept), self._units
        return copy

    def longer_period(self, periods: int) -> Model:
        """A copy for motions with so many times the period of the forces: a force in harmonic h acts in harmonic periods * h
        of it, and its frequencies are those of the model over periods.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> model.add_force(0, 0.2)
        >>> model.longer_period(2).forces.harmonic.tolist()
        [2]
        """
        handle, kept = ctypes.c_void_p(), self._kept
        self._call("hbvib_model_longer_period", _whole(periods, 64, "periods"), handle)
        copy = type(self).__new__(type(self))
        copy._handle, copy._kept, copy._units = handle.value, list(kept), self._units
        return copy

    __copy__ = clone

    def __deepcopy__(self, _: dict[str, Any]) -> Model:
        return self.clone()

    def to_bytes(self) -> bytes:
        """The model as bytes of a versioned format with a checksum: from_bytes makes it again, in any process, and it
        solves to the same bits. pickle uses it. UnsupportedError for a model with a user force.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> data = model.to_bytes()
        >>> hbvib.Model.from_bytes(data)
        <hbvib.Model: 1 degree of freedom, 1 contact>
        """
        size = ctypes.c_int64()
        self._call("hbvib_model_save", 0, None, size)
        room = np.empty(size.value, np.uint8)
        self._call("hbvib_model_save", room.size, room, size)
        return room.tobytes()

    @classmethod
    def from_bytes(cls, data: Any) -> Model:
        """The model that to_bytes saved. ArgumentError for bytes that are no such model, incomplete or damaged,
        UnsupportedError for those of a newer format.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> hbvib.Model.from_bytes(model.to_bytes()).forces.force
        array([0.2+0.j])
        """
        given = np.frombuffer(data, np.uint8)
        model, handle = cls.__new__(cls), ctypes.c_void_p()
        model._handle = None
        _call("hbvib_model_load", given.size, given, handle)
        model._handle, model._kept = handle.value, []
        return model

    def save(self, path: Any) -> None:
        """Writes the bytes of the model to a file.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> import os, tempfile
        >>> path = os.path.join(tempfile.mkdtemp(), "model.hbvib")
        >>> model.save(path)
        >>> hbvib.Model.load(path)
        <hbvib.Model: 1 degree of freedom, 1 contact>
        """
        data = self.to_bytes()
        with open(path, "wb") as file:
            file.write(data)

    @classmethod
    def load(cls, path: Any) -> Model:
        """The model of a file that save wrote.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> import os, tempfile
        >>> path = os.path.join(tempfile.mkdtemp(), "model.hbvib")
        >>> model.save(path)
        >>> hbvib.Model.load(path).contacts
        1
        """
        with open(path, "rb") as file:
            return cls.from_bytes(file.read())

    def __reduce__(self) -> Any:
        """A pickle holds the bytes of the model."""
        return type(self).from_bytes, (self.to_bytes(),)
