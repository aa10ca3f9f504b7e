"""Each expression of a character, drawn from its file and as an avatar shows it: a close look at the face."""

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import moderngl
import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera, orbit
from mua.avatar.decode import express, pose_splats
from mua.fidelity.canvas import Area
from mua.fidelity.measure import Pair, agreement
from mua.fidelity.painter import Painter
from mua.fidelity.posing import Moment, skinned
from mua.fidelity.splats import SplatPainter
from mua.kernels.expressions import reach_of
from mua.scene import Part, Scene, Source
from mua.teachers.simulated.still import StillTeacher

AT_REST = "at rest"
SCREEN = (288, 288)  # width, height, pixels
MOVES = 0.1  # of how far an expression moves any vertex: those that it moves more are in the picture
USUAL = 97  # percent of the vertices that are moved: a hat that one expression lifts does not make the picture
AWAY = float(np.radians(15))  # of the view from the front, so that depth shows


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


def source_faces(context: moderngl.Context, scene: Scene, rest: Moment, names: Sequence[str]) -> Iterator[Array]:
    """Images [H, W, 4] of the file's own meshes at rest and in each expression alone."""
    of_source = _Source(context, scene, rest, camera_of(scene, rest))
    yield of_source.at_rest
    yield from map(of_source.expressed, names)


class _Source:
    """Draws the file's own meshes; for an expression only where it moves them."""

    def __init__(self, context: moderngl.Context, scene: Scene, rest: Moment, camera: Camera) -> None:
        self._scene, self._rest, self._camera = scene, rest, camera
        self._paint = Painter(context, scene.parts, scene.materials, screen=SCREEN)
        self._places = [skinned(scene, part, rest.nodes) for part in scene.parts]
        self.at_rest = self._paint(self._places, camera)

    def expressed(self, name: str) -> Array:
        """The image [H, W, 4] in one expression."""
        places, moved = list(self._places), [np.empty((0, 3))]
        for index, part in enumerate(self._scene.parts):
            if vertices := [target.vertices for target in part.targets if target.name == name]:
                places[index] = skinned(self._scene, _with_target(part, name), self._rest.nodes)
                corners = np.unique(part.faces[np.isin(part.faces, np.concatenate(vertices)).any(axis=1)])
                moved += [at[index][corners] for at in (self._places, places)]
        area = Area.of_points(np.concatenate(moved), self._camera)
        return _patched(self.at_rest, area, lambda: self._paint(places, self._camera, area))


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
        return _patched(self.at_rest, area, lambda: self._paint.drawn(self._quads.exchanged(some, moved), area))


def _patched(image: Array, area: Area, drawn: Callable[[], Array]) -> Array:
    """The image with a part of it drawn anew."""
    if area.empty:
        return image
    patched = image.copy()
    area.of(patched)[:] = drawn()
    return patched


def _with_target(part: Part, name: str) -> Part:
    """The part with one of its targets at weight 1."""
    positions = part.positions.copy()
    for target in part.targets:
        if target.name == name:
            positions[target.vertices] += target.offsets
    return replace(part, positions=positions)


def camera_of(scene: Scene, rest: Moment) -> Camera:
    """The camera that looks at what expressions move."""
    return orbit(_box(scene), screen=SCREEN, azimuth=rest.yaw + AWAY)


def _box(scene: Scene) -> Array:
    """The box [2, 3] about what expressions usually move, as the file stands."""
    found = []
    for part in scene.parts:
        moved = np.zeros(len(part.positions), bool)
        for target in part.targets:
            lengths = np.linalg.norm(target.offsets, axis=1)
            moved[target.vertices[lengths > MOVES * lengths.max(initial=0)]] = True
        moved &= np.isin(np.arange(len(moved)), part.faces)
        found.append(skinned(scene, part, scene.rest)[moved])
    return np.percentile(np.concatenate(found), [100 - USUAL, USUAL], axis=0)
