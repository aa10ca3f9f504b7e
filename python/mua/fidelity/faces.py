"""Each expression of a character, drawn from its file and as an avatar shows it: a close look at the face."""

from dataclasses import dataclass, replace

import moderngl
import numpy as np

from mua.arrays import Array
from mua.avatar.camera import orbit
from mua.avatar.decode import Splats, express, pose_splats
from mua.fidelity.measure import Pair, agreement
from mua.fidelity.painter import Painter
from mua.fidelity.posing import Moment, skinned
from mua.fidelity.splats import SplatPainter
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
    context: moderngl.Context, teacher: StillTeacher, *, source: Source, rest: Moment
) -> FaceFidelity | None:
    """Draw source and splats at rest and in each expression alone; None where there are none.

    The source's targets move the file's own meshes, which its own matrices then pose. The splats are those of the pose
    at rest, bent as an avatar bends them.
    """
    expressions, scene = teacher.rig.expressions, source.scene
    if expressions is None:
        return None
    still = teacher.frame(rest.pose)
    camera = orbit(_box(scene), screen=SCREEN, azimuth=rest.yaw + AWAY)
    paint_source = Painter(context, scene.parts, scene.materials, screen=SCREEN)
    paint_splats = SplatPainter(context, SCREEN)
    shots = []
    for name, weights in zip((None, *expressions.names), _each_alone(len(expressions)), strict=True):
        places = [skinned(scene, _with_target(part, name), rest.nodes) for part in scene.parts]
        mesh, texture = express(teacher.rig, still.mesh, texture=still.texture, weights=weights)
        drawn = paint_source(places, camera), paint_splats(_posed(teacher, mesh, texture, rest), camera)
        shots.append(ExpressionShot(*drawn, agreement(*drawn), name or AT_REST))
    return FaceFidelity(shots[0], tuple(shots[1:]))


def _posed(teacher: StillTeacher, mesh: Array, texture: Array, moment: Moment) -> Splats:
    return pose_splats(teacher.rig, mesh, texture=texture, pose=moment.pose)


def _each_alone(count: int) -> Array:
    """Weights [count + 1, count]: all 0, then each at 1 with the others at 0."""
    return np.eye(count + 1, count, k=-1, dtype=np.float32)


def _with_target(part: Part, name: str | None) -> Part:
    """The part with one of its targets at weight 1; None: with none."""
    positions = part.positions.copy()
    for target in part.targets:
        if target.name == name:
            positions[target.vertices] += target.offsets
    return replace(part, positions=positions)


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
