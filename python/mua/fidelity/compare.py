"""Draws the source character and its splats in the same poses and views, and compares the images."""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import moderngl
import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera
from mua.avatar.decode import pose_splats
from mua.fidelity.canvas import opened
from mua.fidelity.faces import FaceFidelity, compare_faces
from mua.fidelity.measure import Agreement, Pair, agreement, together, worst_place
from mua.fidelity.posed_source import Moment, Poser, dominant_joints
from mua.fidelity.source_faces import camera_of
from mua.fidelity.source_poses import SCREEN, Sitting, source_poses
from mua.fidelity.source_process import SourceProcess, continued
from mua.fidelity.splat_faces import StillFace
from mua.fidelity.splats import SplatPainter
from mua.pose.clip import Clip
from mua.rig.character import Character
from mua.scene import Scene, Source
from mua.teachers.simulated.still import StillTeacher

NEAR_BY = 6.0  # pixels about a place within which the nearest surface names the joint
POSED = 3  # frames of the clips beside the pose of the file
STILL = 0.01  # of a quaternion's numbers: about a degree, less than breathing turns a chest
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
    process: SourceProcess | None = None,
) -> Fidelity:
    """Draw a character's source and its still `teacher`'s splats, as the file stands and in frames spread over `clips`.

    With a `process`, which draws part of that, also close up in each of the character's expressions.
    Raises InputError where this machine has no OpenGL.
    """
    sittings = sittings_of(character, clips, source)
    rest = sittings[0].moment
    face = face_of(teacher, source.scene, rest) if process else None
    if process and face:
        process.draw_faces_of(face)
    with opened() as context:
        here = source_poses(context, source.scene, sittings)
        studio = _Studio(context, source, continued(process.poses(), here) if process else here)
        poses = tuple(studio.pictured(teacher, sitting) for sitting in sittings)
        if process is None or face is None:
            return Fidelity(poses)
        return Fidelity(poses, compare_faces(context, face, scene=source.scene, rest=rest, process=process))


def sittings_of(character: Character, clips: Sequence[Clip], source: Source) -> list[Sitting]:
    """The poses that a character is drawn in: as the file stands, and in frames spread over `clips`."""
    poser = Poser(source, character.skeleton, character.expression_names)
    moments = [poser.rest(), *(poser.of_clip(clip, frame) for clip, frame in spread(clips, POSED))]
    views = [ROUND, *({side: degrees} for side, degrees in itertools.islice(itertools.cycle(IN_MOTION), POSED))]
    return [Sitting(*sitting) for sitting in zip(moments, views, strict=False)]


def spread(clips: Sequence[Clip], count: int) -> list[tuple[Clip, int]]:
    """At most `count` frames, each in the middle of its share of all clips one after the other.

    Clips that stand still, such as the T-pose of a library, have no share where others move.
    """
    moving = [clip for clip in clips if np.ptp(clip.rotations, axis=0).max() > STILL]
    frames = [(clip, frame) for clip in moving or clips for frame in range(len(clip))]
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
    """The images of the source and the painter of the splats."""

    def __init__(
        self,
        context: moderngl.Context,
        source: Source,
        images: Iterator[Array],  # as of `source_poses`
    ) -> None:
        self._scene, self._images = source.scene, images
        self._paint_splats = SplatPainter(context, SCREEN)
        self._dominant_joints = np.concatenate([dominant_joints(source.scene, part) for part in source.scene.parts])

    def pictured(self, teacher: StillTeacher, sitting: Sitting) -> PoseFidelity:
        """One pose from all its sides."""
        moment, places = sitting.moment, sitting.places(self._scene)
        textured = teacher.frame(moment.pose, moment.stretches)
        frame = pose_splats(teacher.rig, textured.mesh, texture=textured.texture, pose=moment.pose)
        shots = []
        for view, camera in zip(sitting.views, sitting.cameras(self._scene, places), strict=True):
            splats, source = self._paint_splats(frame, camera), next(self._images)
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
