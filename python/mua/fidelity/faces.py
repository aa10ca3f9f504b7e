"""Each expression of a character, drawn from its file and as an avatar shows it: a close look at the face."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import moderngl
import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera
from mua.avatar.decode import express, pose_splats
from mua.fidelity.measure import Pair, agreement
from mua.fidelity.source_faces import SCREEN, camera_of, patched, source_faces
from mua.fidelity.source_pose import Moment
from mua.fidelity.splats import SplatPainter
from mua.kernels.expressions import reach_of
from mua.scene import Source
from mua.teachers.simulated.still import StillTeacher

AT_REST = "at rest"


@dataclass(frozen=True, eq=False)
class ExpressionShot(Pair):
    """A face in one expression."""

    name: str


@dataclass(frozen=True)
class FaceFidelity:
    """The face at rest and in each expression at weight 1."""

    rest: ExpressionShot
    expressions: tuple[ExpressionShot, ...]

    @property
    def worst(self) -> ExpressionShot:
        return min(self.expressions, key=lambda shot: shot.agreement.psnr)


def compare_faces(
    context: moderngl.Context,
    teacher: StillTeacher,
    *,
    source: Source,
    rest: Moment,
    drawn: Sequence[Array] | None = None,  # the source's images, where they are drawn already
) -> FaceFidelity | None:
    """Draw source and splats at rest and in each expression alone; None where there are none.

    The source's targets move the file's own meshes, which its own matrices then pose. The splats are those of the pose
    at rest, bent as an avatar bends them.
    """
    expressions, scene = teacher.rig.expressions, source.scene
    if expressions is None:
        return None
    of_splats = _Splats(context, teacher, rest, camera_of(scene, rest))
    numbers = range(len(expressions.names))
    splats = itertools.chain([of_splats.at_rest], (of_splats.expressed(number) for number in numbers))
    images = source_faces(context, scene, rest, expressions.names) if drawn is None else drawn
    names = AT_REST, *expressions.names
    rest_shot, *shots = (
        ExpressionShot(image, splat, agreement(image, splat), name)
        for image, splat, name in zip(images, splats, names, strict=True)
    )
    return FaceFidelity(rest_shot, tuple(shots))


class _Splats:
    """Draws the splats of the pose at rest, bent as an avatar bends them; only those that an expression moves anew."""

    def __init__(self, context: moderngl.Context, teacher: StillTeacher, rest: Moment, camera: Camera) -> None:
        self._rig, self._pose, self._camera = teacher.rig, rest.pose, camera
        self._still = teacher.frame(rest.pose)
        self._paint = SplatPainter(context, SCREEN)
        self._posed = pose_splats(self._rig, self._still.mesh, texture=self._still.texture, pose=rest.pose)
        self._quads = self._paint.quads(self._posed, camera)
        self.at_rest = self._paint.drawn(self._quads)

    def expressed(self, number: int) -> Array:
        """The image [H, W, 4] in one expression."""
        expressions, texels = self._rig.expressions, self._rig.texels
        assert expressions is not None
        weights = np.zeros(len(expressions), np.float32)
        weights[number] = 1
        some = np.flatnonzero(reach_of(expressions.moved(weights), self._rig.mesh.faces, texels.triangles).texels)
        rig = replace(self._rig, texels=texels.some(some))
        mesh, texture = express(rig, self._still.mesh, texture=self._still.texture[some], weights=weights)
        posed = replace(pose_splats(rig, mesh, texture=texture, pose=self._pose), bounds=self._posed.bounds)
        moved = self._paint.quads(posed, self._camera)
        area = self._paint.area(self._quads.among(some), moved)
        return patched(self.at_rest, area, lambda: self._paint.drawn(self._quads.exchanged(some, moved), area))
