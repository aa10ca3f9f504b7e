"""Draws the source character and its splats in the same poses and views, and compares the images."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import moderngl
import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera, orbit
from mua.avatar.decode import pose_splats
from mua.fidelity.canvas import opened
from mua.fidelity.face_process import FaceProcess
from mua.fidelity.faces import FaceFidelity, compare_faces
from mua.fidelity.measure import Agreement, Pair, agreement, together, worst_place
from mua.fidelity.painter import Painter
from mua.fidelity.posing import Moment, Poser, dominant_joints, skinned
from mua.fidelity.source_faces import camera_of
from mua.fidelity.splat_faces import StillFace
from mua.fidelity.splats import SplatPainter
from mua.pose.clip import Clip
from mua.rig.character import Character
from mua.scene import Scene, Source
from mua.teachers.simulated.still import StillTeacher

SCREEN = (384, 512)  # width, height, pixels
NEAR_BY = 6.0  # pixels about a place within which the nearest surface names the joint
POSED = 3  # frames of the clips beside the pose of the file
ABOVE = float(np.radians(5))
ROUND = {"front": 0.0, "left": 90.0, "back": 180.0, "front, right": -40.0}  # degrees round the figure
IN_MOTION = ("front, right", -40.0), ("back, left", 140.0)  # one side for each frame, in turn


@dataclass(frozen=True, eq=False)
class Shot(Pair):
    """One pose from one side."""

    view: str
    place: tuple[int, int]  # column and row of the worst place
    joint: str  # joint of the source that carries the surface nearest to it
    difference: float  # mean difference there, in 0..1


@dataclass(frozen=True)
class PoseFidelity:
    """The comparison of one pose from all its sides."""

    pose: str
    shots: tuple[Shot, ...]

    @property
    def agreement(self) -> Agreement:
        return together([shot.agreement for shot in self.shots])

    @property
    def worst(self) -> Shot:
        return max(self.shots, key=lambda shot: shot.difference)


@dataclass(frozen=True)
class Fidelity:
    """The comparison over all poses."""

    poses: tuple[PoseFidelity, ...]
    face: FaceFidelity | None = None  # None where the character has no expressions, or none was asked for

    @property
    def iou(self) -> float:
        """Overlap in the pose whose silhouettes overlap least."""
        return min(pose.agreement.iou for pose in self.poses)

    @property
    def psnr(self) -> float:
        """Decibels in the pose whose colours differ most."""
        return min(pose.agreement.psnr for pose in self.poses)

    @property
    def worst(self) -> PoseFidelity:
        return max(self.poses, key=lambda pose: pose.worst.difference)


def compare(
    character: Character,
    clips: Sequence[Clip],
    *,
    teacher: StillTeacher,
    source: Source,
    faces: FaceProcess | None = None,
) -> Fidelity:
    """Draw a character's source and its still `teacher`'s splats, as the file stands and in frames spread over `clips`.

    With `faces`, also close up in each of the character's expressions, which that process draws meanwhile.
    Raises InputError where this machine has no OpenGL.
    """
    poser = Poser(source, character.skeleton)
    moments = [poser.rest(), *(poser.of_clip(clip, frame) for clip, frame in spread(clips, POSED))]
    face = face_of(teacher, source.scene, moments[0]) if faces else None
    if faces and face:
        faces.go_on(face)
    with opened() as context:
        studio = _Studio(context, source, poser)
        views = [ROUND, *({side: degrees} for side, degrees in itertools.islice(itertools.cycle(IN_MOTION), POSED))]
        poses = tuple(studio.pictured(teacher, m, v) for m, v in zip(moments, views, strict=False))
        if faces is None or face is None:
            return Fidelity(poses)
        return Fidelity(poses, compare_faces(context, face, scene=source.scene, rest=moments[0], process=faces))


def spread(clips: Sequence[Clip], count: int) -> list[tuple[Clip, int]]:
    """At most `count` frames, each in the middle of its share of all clips one after the other."""
    frames = [(clip, frame) for clip in clips for frame in range(len(clip))]
    count = min(count, len(frames))
    return [frames[int((i + 0.5) * len(frames) / count)] for i in range(count)]


def face_of(teacher: StillTeacher, scene: Scene, rest: Moment) -> StillFace | None:
    """The splats of the pose at rest and the camera that looks at their face; None where there are no expressions."""
    expressions = teacher.rig.expressions
    if expressions is None:
        return None
    still = teacher.frame(rest.pose)
    return StillFace(teacher.rig, still.mesh, still.texture, rest.pose, camera_of(scene, rest), expressions)


class _Studio:
    """The painters of the source and of the splats."""

    def __init__(self, context: moderngl.Context, source: Source, poser: Poser) -> None:
        self._scene, self._poser = source.scene, poser
        self._paint_source = Painter(context, source.scene.parts, source.scene.materials, screen=SCREEN)
        self._paint_splats = SplatPainter(context, SCREEN)
        self._dominant_joints = np.concatenate([dominant_joints(source.scene, part) for part in source.scene.parts])

    def pictured(self, teacher: StillTeacher, moment: Moment, views: dict[str, float]) -> PoseFidelity:
        """One pose, drawn from all `views`."""
        places = [skinned(self._scene, part, moment.nodes) for part in self._scene.parts]
        used = [at[np.unique(part.faces)] for at, part in zip(places, self._scene.parts, strict=True)]
        points = np.concatenate(used)
        bounds = np.stack([points.min(axis=0), points.max(axis=0)])
        textured = teacher.frame(moment.pose, moment.stretches)
        frame = pose_splats(teacher.rig, textured.mesh, texture=textured.texture, pose=moment.pose)
        shots = []
        for view, degrees in views.items():
            azimuth = moment.yaw + float(np.radians(degrees))
            camera = orbit(bounds, screen=SCREEN, azimuth=azimuth, elevation=ABOVE)
            source, splats = self._paint_source(places, camera), self._paint_splats(frame, camera)
            column, row, difference = worst_place(source, splats)
            joint = self._joint_at(np.concatenate(places), camera, (column, row))
            shots.append(Shot(source, splats, agreement(source, splats), view, (column, row), joint, difference))
        return PoseFidelity(moment.name, tuple(shots))

    def _joint_at(self, points: Array, camera: Camera, place: tuple[int, int]) -> str:
        """The name of the node that carries what is seen at a place: the nearest to the eye of the points about it."""
        pixels, depths = camera.pixels(points)
        away = np.linalg.norm(pixels - (np.array(place) + 0.5), axis=1)
        about = np.flatnonzero(away <= max(NEAR_BY, float(away.min())))
        return self._scene.node_names[int(self._dominant_joints[about[np.argmin(depths[about])]])]
