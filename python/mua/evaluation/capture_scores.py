"""How near a teacher, avatars and systems are to the images of a capture, by cameras that no training used.

Over white and inside the box around the mask; PSNR over all pixels and colours, SSIM with the usual window.
"""

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import torch

from mua.arrays import Array
from mua.asset.read import read
from mua.avatar.camera import Camera
from mua.avatar.decode import PoseWindow, Splats, decode, pose_splats
from mua.avatar.rendering import to_bytes
from mua.capture import Capture
from mua.capture.view import View
from mua.errors import InputError
from mua.evaluation.cost import Cost, file_cost
from mua.evaluation.metrics import Scores, compare, mean
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton
from mua.pose.windows import window_of
from mua.splatting.perceptual import Lpips
from mua.splatting.projection import Eye, TorchSplats
from mua.splatting.rasterise import rasterise
from mua.teacher import TeacherFrame
from mua.teachers.trained.teacher import TrainedTeacher

EVERY = 10  # frames: the paper's protocol
TRAINED, UNSEEN = "training poses", "clips held out"
SPLITS = (TRAINED, UNSEEN)
IMAGE, BASELINE, TEACHER = "image", "mean texture", "teacher"

Show = Callable[[Clip, int], Splats]  # of a frame of a clip
See = Callable[[str, int, str], View]  # what a camera saw of a frame of a clip, in the box around the mask
NEAR = 1e-4  # of a skeleton's size: joints that are so near in the bind pose are in the same place


@dataclass(frozen=True)
class FilmedEntry:
    """What is compared with the images: a teacher, an avatar file or a trained system."""

    name: str
    show: Show
    cost: Cost = field(default_factory=Cost)
    system: str = ""  # of the paper's tables; empty: none of these
    scale: float = 1.0  # of a system's size


@dataclass(frozen=True)
class Shot:
    """A view to compare with."""

    split: str
    clip: str
    frame: int
    camera: str


@dataclass(frozen=True, eq=False)
class Judged:
    """One view: the capture's image, then every entry's by name where images are kept, and what these are worth."""

    shot: Shot
    pictures: dict[str, Array]  # [H, W, 3] uint8
    scores: dict[str, Scores]  # none where nobody is in the view


@dataclass(frozen=True)
class Standing:
    """How our system stands in a split, beside a rival; differences are of PSNR in dB, ours less the rival's."""

    split: str
    rival: str  # the nearest to the images of those that cost at most as much
    difference: float  # mean over views
    ahead: int  # views in which ours is nearer
    views: int


def shots(capture: Capture, most: int | None) -> list[Shot]:
    """Every tenth frame of each clip, or `most` of each split, evenly; by the cameras that are held out.

    Errors: InputError where none is.
    """
    cameras = [camera.name for camera in capture.cameras if camera.held_out]
    if not cameras:
        raise InputError(
            f"{capture.file}: cameras: none has held_out, expected one at least that no teacher learns from"
        )
    chosen = []
    for split in SPLITS:
        clips = [clip for clip in capture.clips if clip.held_out == (split == UNSEEN)]
        frames = [(clip.name, frame) for clip in clips for frame in range(clip.frames)]
        if most is None:
            frames = [(name, frame) for name, frame in frames if frame % EVERY == 0]
        else:
            count = min(most, len(frames))
            frames = [frames[i] for i in ((np.arange(count) + 0.5) * len(frames) / max(count, 1)).astype(int)]
        chosen += [Shot(split, name, frame, camera) for name, frame in frames for camera in cameras]
    return chosen


def teacher_entries(folder: Path, template: Skeleton) -> list[FilmedEntry]:
    """The teacher of a folder, and its mean texture on the skinned template: what it must beat.

    Errors: InputError where it was trained on another template than the capture's.
    """
    teacher = TrainedTeacher(folder)
    require_skeleton(f"--teacher {folder}", teacher.rig.skeleton, template)
    still = TrainedTeacher(folder, moving=False)
    return [FilmedEntry(BASELINE, _shown(still)), FilmedEntry(TEACHER, _shown(teacher))]


def avatar_entry(path: Path, template: Skeleton) -> FilmedEntry:
    """An avatar file; raises InputError where its skeleton is not that of the capture's template."""
    avatar = read(path)
    require_skeleton(str(path), avatar.rig.skeleton, template)

    def show(clip: Clip, frame: int) -> Splats:
        poses = window_of(clip, frame, avatar.encoding)
        return decode(avatar, PoseWindow(poses.rotations, poses.translations))

    return FilmedEntry(path.stem, show, file_cost(path, avatar))


def require_skeleton(name: str, own: Skeleton, template: Skeleton) -> None:
    """Raises InputError where joints are not the template's, by name and by place."""
    if own.names != template.names:
        raise InputError(f"{name}: its joints are not those of the capture's template")
    places = [one.world(one.bind_rotations, one.bind_translations)[1] for one in (own, template)]
    apart = float(np.abs(places[0] - places[1]).max())
    if apart > NEAR * template.size:
        raise InputError(f"{name}: its joints are up to {apart:.3g} m from those of the capture's template")


def judge(
    capture: Capture,
    chosen: Sequence[Shot],
    entries: Sequence[FilmedEntry],
    *,
    see: See,
    kept: Collection[Shot] = (),  # those whose images are kept
    lpips: Lpips | None = None,
) -> Iterator[Judged]:
    """Each view in turn; views of one frame follow each other, so that every entry decodes a frame once.

    Views without the person have neither images nor scores.
    """
    motions = {clip.name: capture.moving(clip.name) for clip in capture.clips}
    decoded: dict[str, Splats] = {}
    last = None
    for shot in chosen:
        view = see(shot.clip, shot.frame, shot.camera)
        if view.empty:
            yield Judged(shot, {}, {})
            continue
        if (shot.clip, shot.frame) != last:
            last = shot.clip, shot.frame
            decoded = {one.name: one.show(motions[shot.clip], capture.steps * shot.frame) for one in entries}
        truth = view.mask[..., None] * view.image + (1 - view.mask[..., None])
        pictures = {name: drawn(splats, view.camera) for name, splats in decoded.items()}
        scores = {name: compare(picture, truth, lpips=lpips, multiscale=False)[0] for name, picture in pictures.items()}
        shown = {IMAGE: truth, **pictures} if shot in kept else {}
        yield Judged(shot, {name: to_bytes(picture) for name, picture in shown.items()}, scores)


@torch.no_grad()
def drawn(splats: Splats, camera: Camera) -> Array:
    """Splats over white [H, W, 3], in 0..1."""
    box = torch.from_numpy(np.asarray(splats.bounds, np.float32))
    return np.asarray(rasterise(TorchSplats.of(splats), Eye.of(camera, box), box, background=torch.ones(3)).clamp(0, 1))


def mean_of(judged: Sequence[Judged], name: str, split: str) -> Scores:
    """The mean of an entry over the views of a split, nan over none."""
    return mean([one.scores[name] for one in judged if one.shot.split == split])


def _shown(teacher: TrainedTeacher) -> Show:
    def show(clip: Clip, frame: int) -> Splats:
        (made,) = (one for one in teacher.frames(clip.cut(slice(frame + 1)), {frame}) if isinstance(one, TeacherFrame))
        return pose_splats(teacher.rig, made.mesh, texture=made.texture, pose=made.pose)

    return show
