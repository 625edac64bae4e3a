"""Motions of a branch in coordinates of modes, with which finite-element programs recover stresses."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ._results import ModalCoordinates

if TYPE_CHECKING:
    from ._branch import Branch


class _ModalCoordinates:
    """The method of Branch for modal coordinates."""

    def modal_coordinates(self, point: int, shapes: Any, mass: Any, *, stiffness: Any = None) -> ModalCoordinates:
        """The motion of a point in coordinates of modes, with which a finite-element program recovers stresses: in each harmonic
        x = shapes.T @ q as nearly, in the mass, as the modes allow.

        shapes      (modes, ndof), real or complex, in the order of the matrices, as linear_modes gives them.
        mass        M of the model, numpy or scipy.
        stiffness   K; then lacking has the share that stresses lack, too.

        ValueError for modes that are sums of others.

        >>> import hbvib
        >>> import numpy as np
        >>> mass, stiffness = np.diag([1, 2]), np.array([[3, -1], [-1, 1]])
        >>> model = hbvib.Model(mass=mass, stiffness=stiffness, rayleigh=(0, 0.02))
        >>> model.add_force(0, 0.2)
        >>> branch = model.forced_response(0.9, harmonics=1)
        >>> modes = model.linear_modes(2)
        >>> q, lacking = branch.modal_coordinates(0, modes.shapes, mass)
        >>> bool(np.allclose(q @ modes.shapes, branch.harmonics(0))), q.shape  # harmonics, modes
        (True, (2, 2))
        """
        phi = np.atleast_2d(np.asarray(shapes)).T
        x = cast("Branch", self).harmonics(point).T
        for name, matrix in (("shapes", phi), ("mass", mass), ("stiffness", stiffness)):
            if matrix is not None and np.shape(matrix)[0] != len(x):
                raise ValueError(f"{name} has {np.shape(matrix)[0]} rows or columns, needs ndof = {len(x)}")
        scale = np.sqrt(np.einsum("ij,ij->j", phi.conj(), mass @ phi).real)
        if not (scale > 0).all():
            raise ValueError(f"shapes[{int(np.argmin(scale > 0))}] does not move a mass")
        phi = phi / scale
        gram = phi.conj().T @ (mass @ phi)
        values = np.linalg.eigvalsh(gram)
        if values[0] < 1e-14 * values[-1]:
            raise ValueError("shapes has modes that are sums of others")
        q = np.zeros((phi.shape[1], x.shape[1]), complex)
        rest = x.copy()
        for _ in range(2):  # the second time what rounding has left
            more = np.linalg.solve(gram, phi.conj().T @ (mass @ rest))
            q, rest = q + more, rest - phi @ more

        def share(matrix: Any) -> Any:
            left, whole = (np.einsum("ij,ij->j", z.conj(), matrix @ z).real for z in (rest, x))
            return np.sqrt(np.divide(np.abs(left), whole, out=np.zeros(len(whole)), where=whole > 0))

        measures = [mass] if stiffness is None else [mass, stiffness]
        return ModalCoordinates((q.T / scale), np.array([share(matrix) for matrix in measures]))
