"""Static states along a load history."""
from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Optional, cast

import numpy as np
from numpy.typing import ArrayLike

from ._c import LogLevel, Status
from ._calls import _call, _Guard, _hooks, _Owner
from ._convert import _array
from ._errors import Stopped, UnsupportedError, _sentence

if TYPE_CHECKING:
    from ._calls import CancelFlag, Hook
    from ._model import Model
    from ._results import FloatArray


class StaticHistory(NamedTuple):
    """Static states of each step of a load history; made by Model.static_history.

    motion   steps x ndof.
    places   of the sliders of each contact along t1 and t2, steps x contacts x 2: for Model.set_sliders.
    forces   of each contact along t1, t2 and n, steps x contacts x 3; the one along n is minus the normal load.

    >>> import hbvib
    >>> import numpy as np
    >>> history = hbvib.StaticHistory(np.zeros((2, 1)), np.zeros((2, 1, 2)), np.zeros((2, 1, 3)))
    >>> history.places.shape
    (2, 1, 2)
    """
    motion: FloatArray
    places: FloatArray
    forces: FloatArray


class _StaticHistories(_Owner):
    """Methods of Model for load histories."""

    def static_history(self, factors: Optional[ArrayLike] = None, speeds: Optional[ArrayLike] = None, *, phase: Hook = None,
                       cancel: Optional[CancelFlag] = None) -> StaticHistory:
        """Static states along a load history, with friction: constant forces and speeds that rise and fall, between
        straight steps. The places of a step are the residual state that the history has left there. Sliders begin at
        those of set_slider; the first load is reached at once.

        factors   of the constant forces, one for each step, or a number for one step; None: 1.
        speeds    fixed speeds of rotation, likewise; None: that of the model.
        phase, cancel   as in forced_response; Stopped is raised where they stop it.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.5, preload=1)
        >>> model.add_force(0, 1, harmonic=0)
        >>> history = model.static_history([2, 0])  # slips under twice the force, and keeps a force of the other sense
        >>> history.forces[:, 0, 0].round(6).tolist()
        [0.5, -0.5]
        >>> model.set_sliders(history.places[-1])
        """
        model = cast("Model", self)
        given = [None if values is None else np.atleast_1d(_array(name, values))
                 for name, values in (("factors", factors), ("speeds", speeds))]
        steps = max([len(values) for values in given if values is not None] or [1])
        for name, values in zip(("factors", "speeds"), given):
            if values is not None and values.shape != (steps,):
                raise ValueError(f"{name} has shape {values.shape}, needs ({steps},)")
        contacts = model.contacts
        motion, places = np.zeros((steps, model.ndof)), np.zeros((steps, contacts, 2))
        forces = np.zeros((steps, contacts, 3))
        with _Guard() as guard:
            hooks = _hooks(guard, None, None, LogLevel.INFO, cancel, phase)
            status = _call("hbvib_static_history", self.handle, None, steps, *given, hooks, motion, motion.size, places,
                           places.size, forces, forces.size, guard=guard)
        if status == Status.STOPPED_BY_CALLER:
            raise Stopped(_sentence(status), Status(status), 0)
        return StaticHistory(motion, places, forces)

    def set_sliders(self, places: ArrayLike) -> None:
        """Places the sliders of all contacts, as set_slider does: contacts x 2, along t1 and t2. A place of 0 is passed
        over where a contact has no slider.

        >>> import hbvib
        >>> model = hbvib.Model(mass=1, stiffness=1)
        >>> contact = model.add_contact("jenkins", 0, kt=1, mu=0.5, preload=1)
        >>> model.set_sliders([[0.2, 0]])
        """
        model, table = cast("Model", self), _array("places", places)
        if table.shape != (model.contacts, 2):
            raise ValueError(f"places has shape {table.shape}, needs ({model.contacts}, 2)")
        for contact, of_contact in enumerate(table):
            for direction, place in enumerate(of_contact):
                try:
                    model.set_slider(contact, float(place), direction)
                except UnsupportedError:
                    if place != 0:
                        raise
