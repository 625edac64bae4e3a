"""Nodes of a sector on the axis of the wheel, which are one for all sectors."""
from __future__ import annotations

from typing import Any, Optional

import numpy as np

# Stiffness between a node on the axis and its image, over its own: waves that may not move it do so by a share of 1e-6.
_TIED = 1e6


class AxisNodes:
    """Images of nodes on the axis in the next sector, three rows for each node behind all others, and the stiffness that ties them:
    q(s) = R q(s + 1) holds along the axis in diameter 0, across it in diameter 1, and in no other wave."""

    def __init__(self, nodes: Any, stiffness: Any) -> None:
        self.nodes = np.asarray(nodes, np.int64)
        self.ndof = (*np.shape(stiffness), 1)[0]
        if self.nodes.ndim != 2 or self.nodes.shape[1] != 3:
            raise ValueError(f"on_axis has shape {self.nodes.shape}, needs (nodes, 3)")
        if self.nodes.size and not (0 <= self.nodes.min() and self.nodes.max() < self.ndof):
            raise ValueError(f"on_axis has degrees of freedom {self.nodes.min()} .. {self.nodes.max()}, needs 0 .. {self.ndof - 1}")
        self.images = self.ndof + np.arange(self.nodes.size).reshape(self.nodes.shape)
        self.stiffness = _TIED * float(np.abs(stiffness.diagonal()[self.nodes]).max()) if self.nodes.size else 0.0

    def extended(self, matrix: Any, tied: bool) -> Any:
        """A matrix with the rows of the images, and with the stiffness of the ties."""
        n, more = self.ndof, self.nodes.size
        if hasattr(matrix, "tocoo"):
            from scipy import sparse  # type: ignore[import-untyped, unused-ignore]
            whole = sparse.block_diag([matrix, sparse.csc_matrix((more, more))]).tocsc()
            if not tied:
                return whole
            a, b = self.nodes.ravel(), self.images.ravel()
            rows, columns = np.concatenate([a, b, a, b]), np.concatenate([a, b, b, a])
            values = self.stiffness * np.repeat([1.0, 1.0, -1.0, -1.0], more)
            return whole + sparse.csc_matrix((values, (rows, columns)), shape=(n + more, n + more))
        whole = np.pad(np.asarray(matrix), (0, more))
        if tied:
            whole = whole + 0.0
            for node, image in zip(self.nodes.ravel().tolist(), self.images.ravel().tolist()):
                whole[[node, image], [node, image]] += self.stiffness
                whole[[node, image], [image, node]] -= self.stiffness
        return whole

    def beside(self, axis: Any, angle: float) -> tuple[Any, Any]:
        """Positions of a point beside the axis for each node, and of its image in the next sector."""
        n = np.asarray(axis, float) / np.linalg.norm(axis)
        away = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
        image = np.cos(angle) * away + np.sin(angle) * np.cross(n, away)
        return np.tile(away, (len(self.nodes), 1)), np.tile(image, (len(self.nodes), 1))


def axis_nodes(nodes: Optional[Any], stiffness: Any, is_cartesian: bool) -> Optional[AxisNodes]:
    """None where there are none."""
    if nodes is None or not np.size(nodes):
        return None
    if not is_cartesian:
        raise ValueError("on_axis needs frame = 'cartesian': there is no radius on the axis")
    return AxisNodes(nodes, stiffness if hasattr(stiffness, "diagonal") else np.asarray(stiffness))
