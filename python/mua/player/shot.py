"""How a figure is filmed: from where, how near, still, orbiting or following, with one eye or two."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera, stereo
from mua.errors import InputError
from mua.motion.facing import front_of
from mua.player.focus import find_focus
from mua.player.levels import FULL, Wanted
from mua.player.toggles import Toggles
from mua.player.viewpoint import Viewpoint, directions, framing
from mua.pose.clip import Clip
from mua.rig.bounds import frame_boxes, root_positions, union, way_out
from mua.rig.rig import Rig

GROUND = np.array([1.0, 0, 1])  # a camera that follows keeps its height
TURN_SPEED, TURN_RATE = 60.0, 30.0  # degrees and images per second of a turntable
SLOWEST, FASTEST = 1.0, 360.0  # degrees per second: a turn in six minutes, or in a second
Color = tuple[float, float, float]  # sRGB, 0..1


@dataclass(frozen=True)
class Shot:
    """A camera's settings; at nearness 1 the figure is in the image at every frame."""

    screen: tuple[int, int]  # width, height of one eye, pixels
    azimuth: float = 0.0  # radians from the figure's front in the first frame, towards its left
    elevation: float = 0.0
    turning: float = 0.0  # radians per second round the figure, towards its left
    follow: bool = False  # follow the figure, or what is looked at; else stand where all of the clip is seen
    eyes: float | None = None  # metres between two eyes; one eye if None
    zoom: float = 1.0  # factor by which the camera is nearer than where all of the figure is seen
    look_at: str | None = None  # joint or part of the body in the middle of the image


@dataclass(frozen=True)
class Look:
    """Settings of an image, a video or a window: what it shows of an avatar, and from where."""

    shot: Shot
    toggles: Toggles
    background: Color | None  # None: transparent
    level: Wanted = FULL  # level of detail
    weights: Mapping[str, float] = field(default_factory=dict)  # of expressions, in place of the clip's


def film(shot: Shot, rig: Rig, clip: Clip) -> list[tuple[Camera, ...]]:
    """The camera of one eye or two for every frame of a clip.

    Errors: InputError where the rig has no such joint to look at.
    """
    boxes = frame_boxes(rig, clip)
    framed, moved = _framed(shot, rig, clip, boxes)
    turned = shot.turning / clip.rate * np.arange(len(clip))
    azimuths = front_of(rig.skeleton, clip.rotations[0], clip.translations[0]) + shot.azimuth + turned
    view = framing(framed, shot.screen, azimuths=azimuths, elevation=shot.elevation).nearer(shot.zoom)
    target = np.zeros(3) if shot.look_at else view.target
    view = view.outside(way_out(boxes, target + moved, directions(azimuths, shot.elevation)).max())
    views = [replace(view, target=target + at, azimuth=a) for at, a in zip(moved, azimuths, strict=True)]
    return [eyes_of(view, shot.screen, shot.eyes) for view in views]


def eyes_of(view: Viewpoint, screen: tuple[int, int], eyes: float | None) -> tuple[Camera, ...]:
    """One eye at a viewpoint, or two at this distance in metres."""
    camera = view.camera(screen)
    return (camera,) if eyes is None else stereo(camera, eyes)


def _framed(
    shot: Shot,
    rig: Rig,
    clip: Clip,
    boxes: Array,  # [F, 2, 3] of its frames, metres
) -> tuple[Array, Array]:
    """The box [2, 3] to frame, and the path of the camera's target [F, 3], metres."""
    roots = root_positions(rig, clip)
    if shot.look_at is not None:
        places = find_focus(rig, shot.look_at).places(rig.skeleton, clip.rotations, clip.translations)
        return union(boxes - roots[:, None]), places if shot.follow else np.broadcast_to(places[0], places.shape)
    moved = (roots - roots[0]) * GROUND * shot.follow
    return union(boxes - moved[:, None]), moved


def full_turn(shot: Shot) -> tuple[Shot, int, float]:
    """A shot that goes round once at its speed, how many images that takes and how many there are a second.

    The image after the last would be the first again. Errors: InputError where it turns too slowly or too fast.
    """
    speed = np.degrees(shot.turning) or TURN_SPEED
    if not SLOWEST <= abs(speed) <= FASTEST:
        raise InputError(f"--orbit is {speed:g}; a turntable turns by {SLOWEST:g} to {FASTEST:g} degrees per second")
    count = round(360 / abs(speed) * TURN_RATE)
    return replace(shot, turning=float(np.copysign(2 * np.pi, speed)) * TURN_RATE / count), count, TURN_RATE
