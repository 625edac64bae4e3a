"""The branch: how it is freed, saved and drawn. Its other methods are in the modules of its bases."""
from __future__ import annotations

import threading
import weakref
from typing import TYPE_CHECKING, Any, Callable, Optional

from ._branch_fields import _BranchFields
from ._branch_points import _BranchPoints
from ._branch_responses import _BranchResponses
from ._c import Field, Status
from ._calls import _call
from ._children import _BranchChildren
from ._errors import ArgumentError, BusyError
from ._library import lib
from ._modal_coordinates import _ModalCoordinates
from ._run_up import _RunUps
from ._units import Units, _HasUnits

if TYPE_CHECKING:
    from ._origin import Origin
    from ._responses import Response


class Branch(_BranchFields, _BranchPoints, _BranchResponses, _BranchChildren, _ModalCoordinates, _RunUps, _HasUnits):
    """Solutions along a curve, from a forced response or a nonlinear mode; made by the solves.

    Fields (`omega`, `amplitude`, ...) are read-only arrays over the points of the curve without a copy: each keeps the
    branch's memory, and `free` is refused with BufferError while one lives. All else is copied out. Points are numbers
    0 .. len(branch) - 1 on the curve; `peaks`, `folds` and `at` have the numbers of the points beside it.

    message   the library's sentence where the solve stopped early, else empty.

    >>> import hbvib
    >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
    >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
    >>> model.add_force(0, 0.2)
    >>> branch = model.forced_response((0.8, 1.6))
    >>> branch
    <hbvib.Branch: 45 points, omega 0.8 to 1.6, peak 0.583649 at omega = 1.23202, OK>
    """

    _release = staticmethod(lib.hbvib_branch_free)

    def __init__(self, handle: int, kept: tuple[Any, ...], message: str, units: Units = Units()) -> None:
        self._handle, self._kept, self.message, self._units = handle, kept, message, units
        self._leases: Any = weakref.WeakSet()
        self._living: Any = weakref.WeakSet()  # children that the caller has
        self._freeing = threading.RLock()  # of a signal's handler, too
        self._origin: Optional[Origin] = None
        self._responses: tuple[Response, ...] = ()

    def free(self) -> None:
        """Frees the branch and its children. BufferError while arrays look into its memory, BusyError while a call uses it,
        FreedError if it was freed, ArgumentError for a child, which its parent frees.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.free()
        >>> branch
        <hbvib.Branch, freed>
        """
        # One thread at a time: where two have read the handle, a refused one would give it back while the other frees.
        with self._freeing:
            handle, self._handle = self.handle, None  # first, so that no thread borrows an array from here on
            try:
                if self._leased():
                    raise BufferError(
                        f"{self._leased()} arrays look into the memory of this branch: delete or copy them")
                _call("hbvib_branch_free", handle)
            except (ArgumentError, BufferError, BusyError):
                self._handle = handle
                raise
            self._forget()
            self._kept, self._origin = (), None

    def __del__(self) -> None:
        if self._parent is None:
            super().__del__()

    def __len__(self) -> int:
        """Number of points on the curve."""
        return _call("hbvib_branch_points", self.handle)

    @property
    def stored(self) -> int:
        """Number of all stored points: the curve, then peaks, folds and requested solutions.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.stored - len(branch)  # peaks, folds and requested solutions
        1
        """
        return _call("hbvib_branch_stored", self.handle)

    @property
    def status(self) -> Status:
        """Status of the solve: OK, or why it stopped early.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.status
        <Status.OK: 0>
        """
        return Status(_call("hbvib_branch_status", self.handle))

    @property
    def complete(self) -> bool:
        """Whether the whole range was covered.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.complete
        True
        """
        return self.status == Status.OK

    @property
    def is_mode(self) -> bool:
        """Whether the branch is a nonlinear mode.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.is_mode
        False
        """
        try:
            self.field(Field.DAMPING_RATIO)
        except ArgumentError:
            return False
        return True

    def __reduce__(self) -> tuple[Callable[..., Branch], tuple[Any, ...]]:
        """A pickle holds what a file holds, see save."""
        from ._storage import SavedBranch, contents
        return SavedBranch, (contents(self),)

    def __copy__(self) -> Branch:
        """The branch itself, which never changes."""
        return self

    def __deepcopy__(self, _: dict[str, Any]) -> Branch:
        return self

    def save(self, path: Any, *, harmonics: bool = True) -> None:
        """Writes the branch to one file in numpy's NPZ format: fields, special points, energies and slip fractions of all
        stored points, to the last bit. `hbvib.load` reads it; np.load(path) too, in any version of numpy.

        harmonics   with those of all degrees of freedom at all points, most of the file, and with the model, from which
                    loops and summaries of contacts are computed again. A model with a force of the caller is not saved.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> import os, tempfile
        >>> path = os.path.join(tempfile.mkdtemp(), "branch.npz")
        >>> branch.save(path)
        >>> hbvib.load(path)
        <hbvib.SavedBranch: 45 points, omega 0.8 to 1.6, peak 0.583649 at omega = 1.23202, OK>
        """
        from . import _storage
        _storage.save(self, path, harmonics)

    def to_dataframe(self) -> Any:
        """A pandas.DataFrame, a row for each point of the curve: columns named as the fields, slip_fraction_0 and so on for
        contacts; `attrs` has status and message, and what `hbvib.from_dataframe` needs to make a branch of it again.
        ImportError without pandas.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> branch.to_dataframe()[["omega", "amplitude"]].shape == (len(branch), 2)
        True
        """
        from . import _tables
        return _tables.dataframe(self)

    def to_xarray(self, *, harmonics: bool = False) -> Any:
        """An xarray.Dataset of the fields over point and contact, with omega (in a mode log10_amplitude) as coordinate, and units
        where the model has them. `hbvib.from_xarray` makes a branch of it again. ImportError without xarray.

        harmonics   with those of all stored points, (stored, harmonic, dof, part) with the parts "re" and "im", and with the bytes
                    of the model.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> dict(branch.to_xarray().sizes)["contact"]
        1
        """
        from . import _tables
        return _tables.dataset(self, harmonics)

    def plot(self, ax: Any = None, *, hertz: bool = False, **line: Any) -> Any:
        """Draws the branch with matplotlib: amplitude over angular frequency, peaks as dots; of a nonlinear mode
        frequency and damping ratio over the modal amplitude. Children are drawn in colours of their own, over the
        frequency of the forces. Returns the axes, of a mode two. ImportError without matplotlib.

        ax      axes to draw into, of a mode a pair; None: new ones.
        hertz   True: frequencies omega / (2 pi).    line   options of ax.plot, such as label or color.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> axes = branch.plot(label="0.2 N")
        >>> axes.get_xlabel()
        'angular frequency omega'
        """
        from . import _plots
        return _plots.plot(self, ax, hertz, line)

    def plot_loop(self, point: int, contact: int, direction: int = 0, n: int = 256, *, ax: Any = None,
                  **line: Any) -> Any:
        """Draws the hysteresis loop of a contact at a point with matplotlib: force over relative motion. Returns the
        axes. ImportError without matplotlib. Arguments as in `loop` and `plot`.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1, rayleigh=(0, 0.02))
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.3, preload=1)
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response((0.8, 1.6))
        >>> axes = branch.plot_loop(branch.peaks().point[0], 0)
        >>> axes.get_ylabel()
        'force of contact 0'
        """
        from . import _plots
        return _plots.loop(self, point, contact, direction, n, ax, line)
