"""How a clip is filmed: from where, how large, still, orbiting or following, with one eye or two."""

from dataclasses import dataclass

import numpy as np

from mua.arrays import Array
from mua.bounds import frame_boxes, root_positions, union
from mua.camera import Camera, orbit, stereo
from mua.motion.clip import Clip
from mua.rig.rig import Rig

GROUND = np.array([1.0, 0, 1])  # a camera that follows keeps its height


@dataclass(frozen=True)
class Shot:
    """What a camera does; the figure is in the picture at every frame."""

    screen: tuple[int, int]  # width, height of one eye, pixels
    azimuth: float = 0.0  # radians, as mua.camera.orbit
    elevation: float = 0.0
    turning: float = 0.0  # radians per second round the figure, towards its left
    follow: bool = False  # go along with the figure; else stand where all of the clip is in the picture
    eyes: float | None = None  # metres between two eyes; one eye if None


def film(shot: Shot, rig: Rig, clip: Clip) -> list[tuple[Camera, ...]]:
    """The camera of one eye or two for every frame of a clip."""
    boxes = frame_boxes(rig, clip)
    moved = np.zeros((len(clip), 3))
    if shot.follow:
        roots = root_positions(rig, clip)
        moved = (roots - roots[0]) * GROUND
    framed = union(boxes - moved[:, None])
    return [_eyes(shot, framed + moved[i], i / clip.rate) for i in range(len(clip))]


def _eyes(
    shot: Shot,
    box: Array,  # [2, 3]
    seconds: float,
) -> tuple[Camera, ...]:
    azimuth = shot.azimuth + shot.turning * seconds
    camera = orbit(box, screen=shot.screen, azimuth=azimuth, elevation=shot.elevation)
    return (camera,) if shot.eyes is None else stereo(camera, shot.eyes)
