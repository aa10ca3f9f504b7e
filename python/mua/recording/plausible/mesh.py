"""Canonical meshes: their unit, their axes, and whether they are posed."""

from collections.abc import Iterator

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.kernels.dq_skinning import blend_vertices
from mua.pose.skeleton import Pose
from mua.recording.plausible.finding import Finding
from mua.recording.plausible.fit import EXPLAINED, explain, rms, unit_of
from mua.rig.rig import Rig

SAMPLES = 1024  # vertices that are checked
NEAR = 0.05  # share of the figure's size: mean distance of a canonical mesh from the template, loose clothes included
FAR = 1.0  # likewise, for a mesh that no known mistake explains


class Meshes:
    """Checks the canonical meshes of one rig."""

    def __init__(
        self,
        rig: Rig,
        size: float,  # size of the figure, metres
    ) -> None:
        count = len(rig.mesh.vertices)
        self._rows = np.unique(np.linspace(0, count - 1, min(count, SAMPLES)).astype(int))
        self._rig, self._size = rig, size
        self._template = rig.mesh.vertices[self._rows]

    def __call__(
        self,
        mesh: Array,  # [V, 3]
        pose: Pose,
    ) -> Iterator[Finding]:
        """Likely mistakes in a mesh of the right shape."""
        given = np.asarray(mesh[self._rows], dtype=np.float64)
        away = rms(given - self._template)
        if away <= NEAR * self._size:
            return
        found = f"mesh is {away:.3g} m from the template on average, whose longest side is {self._size:.3g} m"
        mistake = explain(given, self._template)
        if mistake is not None:
            yield Finding(f"{found}: {mistake.question}", certain=True)
        elif rms(given - self._posed(pose)) < EXPLAINED * away:
            yield Finding(f"{found}, and near it in this pose: is it posed? canonical space is expected", certain=True)
        elif away > FAR * self._size:
            unit = unit_of(_spread(given) / max(_spread(self._template), 1e-12))
            question = f"are these {unit}?" if unit else "is it another mesh, another order of vertices?"
            yield Finding(f"{found}: {question}", certain=True)

    def _posed(self, pose: Pose) -> Array:
        """The sampled vertices of the template in a pose."""
        joints = self._rig.skeleton.skinning(pose.rotations, pose.translations)
        rows = self._rows
        duals = blend_vertices(joints, self._rig.skin_indices[rows], self._rig.skin_weights[rows])
        return rotation.dual_transform(duals, self._template)


def _spread(points: Array) -> float:
    return rms(points - points.mean(axis=0))
