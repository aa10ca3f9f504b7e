"""The plan of a virtual capture: the frames of a motion, kept on the spot, and the cameras."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import gaussian_filter1d

from mua.arrays import Array
from mua.capture import CaptureCamera
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

RUN = 20  # frames in a row, at most: a teacher sees motion, not single poses
GAP = 15  # frames between training and held-out ones of one clip, so that they are not the same pose
SWAY = 0.5  # seconds: slower ways of the hips through the world are taken out
LOW, HIGH, BETWEEN = np.radians([3.0, 25.0, 14.0])  # elevations of the two rings, and of held-out cameras
JITTER = 0.1  # share of the angle between two cameras
DISTANCE = 3.0  # times the figure's size
FILL = 0.94  # share of the image's half size that the figure reaches


@dataclass(frozen=True)
class Run:
    """Frames of a clip in a row."""

    clip: int
    first: int
    frames: int


def chosen_runs(stretches: Sequence[Run], frames: int) -> list[Run]:
    """About `frames` frames out of `stretches`, as many of each as it has and its share allows, spread over it."""
    chosen: dict[int, list[Run]] = {}
    left = frames
    for done, i in enumerate(sorted(range(len(stretches)), key=lambda i: stretches[i].frames)):
        share = min(stretches[i].frames, -(-left // (len(stretches) - done)))
        chosen[i] = _spread(stretches[i], share)
        left -= share
    return [run for i in range(len(stretches)) for run in chosen[i]]


def held_back(
    lengths: Sequence[int],  # frames of all clips
    *,
    named: int,  # how many of the last ones are held out by name
    frames: int,  # to be held out
) -> tuple[list[Run], list[Run]]:
    """Frames filmed for training and frames held out: the named clips, else the last, else the only one's end."""
    whole = [Run(i, 0, length) for i, length in enumerate(lengths)]
    if not frames:
        return whole[: len(whole) - named], []
    if named or len(whole) > 1:
        first = len(whole) - (named or 1)
        return whole[:first], whole[first:]
    kept = max(lengths[0] - frames - GAP, 0)
    return [Run(0, 0, kept)], [Run(0, lengths[0] - frames, frames)] if lengths[0] >= frames else []


def _spread(stretch: Run, frames: int) -> list[Run]:
    """Runs of a stretch, evenly spaced; the whole of it where all its frames are wanted."""
    if frames == stretch.frames:
        return [stretch] if frames else []
    count = -(-frames // RUN)
    lengths = [len(part) for part in np.array_split(np.arange(frames), count)] if count else []
    unused = (stretch.frames - frames) * np.arange(1, count + 1) // (count + 1)  # before each run
    before = stretch.first + np.cumsum([0, *lengths[:-1]])[:count] + unused
    return [Run(stretch.clip, int(first), length) for first, length in zip(before, lengths, strict=True)]


def on_the_spot(clip: Clip, skeleton: Skeleton) -> Clip:
    """The clip without the way of the hips over the ground, so that cameras that do not move see the figure large."""
    _, places = skeleton.world(clip.rotations, clip.translations)
    way = gaussian_filter1d(places[:, skeleton.root], SWAY * clip.rate, axis=0, mode="nearest")
    way[:, 1] = 0
    translations = clip.translations.copy()
    translations[:, skeleton.parents < 0] -= way[:, None]
    return replace(clip, translations=translations)


def ring(
    points: Array,  # [N, 3] everything that is to be seen, metres
    *,
    cameras: int,
    held_out: int,
    size: int,  # side of the square images, pixels
    rng: np.random.Generator,
) -> tuple[CaptureCamera, ...]:
    """Cameras about the points at two heights in turn, and held-out ones between them, all with one lens."""
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    radius = DISTANCE * float(np.ptp(points, axis=0).max())
    step = 2 * np.pi / cameras
    start = rng.uniform(0, step)
    turns = start + step * (np.arange(cameras) + rng.uniform(-JITTER, JITTER, cameras))
    between = start + step * (0.5 + np.floor(np.arange(held_out) * cameras / max(held_out, 1)))
    placed = [(float(turn), (LOW, HIGH)[i % 2], False) for i, turn in enumerate(turns)]
    placed += [(float(turn), BETWEEN, True) for turn in between]
    views = [_looking_at(middle, radius, turn=turn, elevation=float(up)) for turn, up, _ in placed]
    focal = min(_focal(points, view, size) for view in views)
    return tuple(
        CaptureCamera(
            name=f"cam{i:02d}",
            size=(size, size),
            focal=(focal, focal),
            centre=(size / 2, size / 2),
            world_to_camera=view,
            held_out=held,
        )
        for i, (view, (_, _, held)) in enumerate(zip(views, placed, strict=True))
    )


def _looking_at(middle: Array, radius: float, *, turn: float, elevation: float) -> Array:
    """World to camera [4, 4] of a camera that looks at the middle; turn 0 faces the figure, along -Z."""
    flat = np.cos(elevation)
    away = np.array([flat * np.sin(turn), np.sin(elevation), flat * np.cos(turn)])
    right = np.array([np.cos(turn), 0, -np.sin(turn)])
    matrix = np.eye(4)
    matrix[:3, :3] = right, np.cross(-away, right), -away  # x to the right, y down, z forward
    matrix[:3, 3] = -matrix[:3, :3] @ (middle + radius * away)
    return matrix


def _focal(points: Array, view: Array, size: int) -> float:
    """The longest focal length in pixels with which a camera sees all points."""
    x, y, z = (points @ view[:3, :3].T + view[:3, 3]).T
    return float(FILL * size / 2 / np.max(np.maximum(np.abs(x), np.abs(y)) / z))
