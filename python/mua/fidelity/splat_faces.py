"""Each expression of a character as an avatar shows it: a close look at the face.

It loads little, because a process of its own draws these images.
"""

from dataclasses import dataclass, replace

import moderngl
import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera
from mua.avatar.decode import express, pose_splats
from mua.fidelity.canvas import Area
from mua.fidelity.source_faces import SCREEN, Patch
from mua.fidelity.splats import BEYOND, SplatPainter
from mua.kernels.expressions import reach_of
from mua.pose.skeleton import Pose
from mua.rig.expressions import Expressions
from mua.rig.rig import Rig


@dataclass(frozen=True, eq=False)
class StillFace:
    """The splats of a character as the file stands, its expressions, and the camera that looks at what these move."""

    rig: Rig
    mesh: Array  # [V, 3]
    texture: Array  # [N, 23]
    pose: Pose
    camera: Camera
    expressions: Expressions


class SplatFaces:
    """The image of the splats at rest, and what is other in that of each expression alone.

    Splats of the pose at rest are bent as an avatar bends them; only those that an expression moves are drawn anew.
    """

    def __init__(self, context: moderngl.Context, face: StillFace) -> None:
        self._face = face
        self._paint = SplatPainter(context, SCREEN)
        self._posed = pose_splats(face.rig, face.mesh, texture=face.texture, pose=face.pose)
        self._quads = self._paint.quads(self._posed, face.camera)
        self._layers = self._paint.layers(self._quads)
        self.at_rest = self._paint.drawn(self._quads)

    def __len__(self) -> int:
        return 1 + len(self._face.expressions)

    def patch(self, number: int) -> Patch:
        """The first is the image at rest, the others what is other in each expression."""
        return self._expressed(number - 1) if number else Patch(Area(0, 0, *SCREEN), self.at_rest)

    def _expressed(self, number: int) -> Patch:
        face, texels = self._face, self._face.rig.texels
        weights = np.zeros(len(face.expressions), np.float32)
        weights[number] = 1
        moves = reach_of(face.expressions.moved(weights), face.rig.mesh.faces, texels.triangles)
        some = np.flatnonzero(moves.texels)
        rig = replace(face.rig, texels=texels.some(some))
        mesh, texture = express(rig, face.mesh, texture=face.texture[some], weights=weights)
        posed = replace(pose_splats(rig, mesh, texture=texture, pose=face.pose), bounds=self._posed.bounds)
        moved = self._paint.quads(posed, face.camera)
        before = self._quads.among(some)
        area = self._paint.area(before, moved)
        if area.empty:
            return Patch(area, area.of(self.at_rest))
        farthest = min(quads.keys.min(initial=BEYOND - 1) for quads in (before, moved))
        behind = next(layer for layer in reversed(self._layers) if layer.key <= farthest)
        return Patch(area, self._paint.drawn(self._quads.exchanged(some, moved), area, behind))
