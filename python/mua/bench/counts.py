"""What a frame of an avatar must do on any device: bytes, operations and dispatches, triangles and fragments.

Dispatches are those that the player appends; fragments are counted by drawing.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.asset.read import load
from mua.bench.work import Work, frame_work
from mua.camera import Camera, orbit
from mua.errors import InputError
from mua.gpu import Device
from mua.motion.facing import front_of
from mua.player.buffers import AvatarBuffers
from mua.player.draw import EXACT_FORMAT, SortedSplats, SplatRenderer, draw_image, image_format
from mua.player.frame import AvatarFrame
from mua.player.splats import SplatFrame
from mua.pose.clip import Clip
from mua.pose.resample import resample

SCREEN = (1680, 1760)  # pixels of one eye, as a Quest 3 has them unless told otherwise
FOCAL = 790  # pixels
DISTANCES = (2.2, 1.0, 0.6)  # metres from the figure's middle
VISIBLE_WORD = 4  # of the arguments that splat_sort writes
POSED = ("BlendVertices", "SplatProject", "CountDigits", "ScanDigits", "ScatterDigits")  # in every frame that poses


@dataclass(frozen=True)
class Drawn:
    """What is drawn for one eye from one distance."""

    distance: float  # metres
    triangles: int
    fragments: int
    overdraw: float  # fragments of a covered pixel


@dataclass(frozen=True)
class Counts:
    """Of one avatar before one eye, all of whose splats are in view."""

    avatar: str
    splats: int
    work: dict[str, Work]  # by kernel, in frame order
    decode_dispatches: int  # of a frame that decodes all, poses and sorts
    pose_dispatches: int  # of a frame that poses and sorts
    rest_dispatches: int  # of a frame in which only the camera moves
    drawn: tuple[Drawn, ...]

    @property
    def decode(self) -> Work:
        return sum((work for name, work in self.work.items() if name not in POSED), Work(0, 0))

    @property
    def pose(self) -> Work:
        return sum((self.work[name] for name in POSED), Work(0, 0))


class _Listed:
    """Passes dispatches on, and counts them."""

    def __init__(self, device: Device) -> None:
        self.commands, self.names = device.commands(), list[str]()

    def dispatch(self, kernel: Any, *arguments: Any, **constants: Any) -> None:
        self.names.append(kernel.name)
        self.commands.dispatch(kernel, *arguments, **constants)


def count(device: Device, path: Path) -> Counts:
    """Errors: InputError where the file holds no clip, or the device cannot hold the avatar or the picture."""
    buffers = AvatarBuffers(device, path)
    avatar = buffers.avatar
    if not avatar.clips:
        raise InputError(f"{path} holds no clips; mua-bench needs one to pose the avatar")
    clip = resample(avatar.clips[0], avatar.encoding.rate)
    frame = SplatFrame(device, [AvatarFrame(device, buffers)])
    drawn: list[Drawn] = []
    names: list[str] = []
    visible = 0
    for distance in DISTANCES:
        names, sorted_visible, seen = _draw(device, frame, clip, distance)
        visible = max(visible, sorted_visible)
        drawn.append(seen)
    work = frame_work(load(path), visible=visible, eyes=1)
    if set(names) != set(work):
        raise InputError(f"{path}: dispatches {sorted(set(names) ^ set(work))} are not counted")
    rest = names.index("SplatProject")
    return Counts(
        avatar=avatar.name,
        splats=len(avatar.rig.texels.texels),
        work=work,
        decode_dispatches=len(names),
        pose_dispatches=len(names) - names.index("BlendVertices"),
        rest_dispatches=len(names) - rest,
        drawn=tuple(drawn),
    )


def as_json(counts: Counts) -> dict[str, Any]:
    """Numbers and names only; distances are metres."""
    decode, pose = counts.decode, counts.pose
    return {
        "avatar": counts.avatar,
        "splats": counts.splats,
        "screen_pixels": list(SCREEN),
        "focal_pixels": FOCAL,
        "bytes": {"decode": decode.bytes, "pose": pose.bytes, "peak_frame": decode.bytes + pose.bytes},
        "operations": {"decode": decode.flops, "pose": pose.flops, "peak_frame": decode.flops + pose.flops},
        "dispatches": {
            "decode": counts.decode_dispatches,
            "pose": counts.pose_dispatches,
            "rest": counts.rest_dispatches,
        },
        "triangles": {str(d.distance): d.triangles for d in counts.drawn},
        "fragments": {str(d.distance): d.fragments for d in counts.drawn},
        "overdraw": {str(d.distance): d.overdraw for d in counts.drawn},
        "kernels": {name: {"bytes": work.bytes, "operations": work.flops} for name, work in counts.work.items()},
    }


def fragments(device: Device, splats: SortedSplats, camera: Camera) -> Array:
    """How many splats are drawn at each pixel, [H, W]. Errors: InputError where the device cannot count so far."""
    if image_format(device) != EXACT_FORMAT:
        raise InputError(f"{device.adapter}: the device does not blend floats, by which fragments are counted")
    renderer = SplatRenderer(device, EXACT_FORMAT, fragment="CountFrag")
    return draw_image(device, renderer, splats, [camera])[..., 0]


def _draw(device: Device, frame: SplatFrame[AvatarFrame], clip: Clip, distance: float) -> tuple[list[str], int, Drawn]:
    """The dispatches of a frame, how many splats it sorted, and what is drawn."""
    (avatar,) = frame.avatars
    window = avatar.avatar.avatar.encoding.frames(0)
    listed = _Listed(device)
    avatar.decode(listed, clip.rotations[window], clip.translations[window])  # type: ignore[arg-type]
    skeleton = avatar.avatar.avatar.rig.skeleton
    camera = _camera(avatar.bounds, front_of(skeleton, clip.rotations[0], clip.translations[0]), distance)
    frame.sort(listed, [camera])  # type: ignore[arg-type]
    listed.commands.submit()
    visible = int(frame.arguments.read()[VISIBLE_WORD])
    at = fragments(device, frame.sorted, camera)
    whole = int(at.sum(dtype=float))
    drawn = Drawn(distance, 2 * visible, whole, whole / max(int(np.count_nonzero(at)), 1))
    return listed.names, visible, drawn


def _camera(
    bounds: Array,  # [2, 3]
    azimuth: float,
    distance: float,
) -> Camera:
    """Before the figure's front, level with its middle."""
    camera = orbit(bounds, screen=SCREEN, azimuth=azimuth)
    view, projection = camera.view.copy(), camera.projection.copy()
    view[:3, 3] = [0, 0, -distance] - view[:3, :3] @ bounds.mean(axis=0)
    projection[0, 0], projection[1, 1] = (2 * FOCAL / side for side in SCREEN)
    return Camera(view, projection, SCREEN)
