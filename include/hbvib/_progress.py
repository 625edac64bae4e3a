"""The bar of progress=True: tqdm if it is installed, else one line on the standard error."""
from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, Optional

if TYPE_CHECKING:
    from ._results import Progress


class Bar:
    """A callback of progress."""

    def __init__(self) -> None:
        self.bar: Optional[Any] = None
        self.shown = -1
        try:
            from tqdm.auto import tqdm  # type: ignore[import-untyped, unused-ignore]
        except ImportError:
            return
        self.bar = tqdm(total=100, unit="%", bar_format="{l_bar}{bar}| {elapsed}<{remaining}{postfix}")

    def __call__(self, state: Progress) -> None:
        percent = int(100 * min(max(state.fraction_done, 0), 1))
        if self.bar is not None:
            self.bar.update(percent - self.bar.n)
            self.bar.set_postfix_str(f"point {state.point}, at {state.parameter:.6g}", refresh=False)
        elif percent != self.shown:
            self.shown = percent
            print(f"\r{percent:3d} %, point {state.point}, at {state.parameter:.6g}", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        """Ends the bar, wherever it stands."""
        if self.bar is not None:
            self.bar.close()
        elif self.shown >= 0:
            print(file=sys.stderr)
