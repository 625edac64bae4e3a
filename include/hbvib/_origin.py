"""The model of a branch as it was when the branch was solved."""
from __future__ import annotations

import contextlib
import ctypes
from typing import TYPE_CHECKING, Optional

import numpy as np

from ._calls import _call, _Owner
from ._errors import Error
from ._library import lib

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Origin(_Owner):
    """A copy of a model, which shares its matrices until one of them is changed, and the samples of the solve."""

    _release = staticmethod(lib.hbvib_model_free)

    def __init__(self, handle: int, samples: int) -> None:
        self._handle, self.samples = handle, samples

    @classmethod
    def of(cls, model: int, samples: int) -> Optional[Origin]:
        """The origin of a solve that begins; None where the model cannot be copied, of which the solve itself tells."""
        handle = ctypes.c_void_p()
        with contextlib.suppress(Error):
            _call("hbvib_model_clone", model, handle)
        return None if handle.value is None else cls(handle.value, samples)

    def saved(self) -> NDArray[np.uint8]:
        """The bytes of the model. UnsupportedError for one with a force of the caller."""
        size = ctypes.c_int64()
        self._call("hbvib_model_save", 0, None, size)
        room = np.empty(size.value, np.uint8)
        self._call("hbvib_model_save", room.size, room, size)
        return room
