"""Work of a frame of an avatar on any device: bytes, operations and dispatches, triangles and fragments.

Dispatches are those that the player appends; fragments are counted by drawing.
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from mua.arrays import Array
from mua.asset.count import parameters
from mua.avatar.camera import Camera, orbit
from mua.avatar.coarser import coarsest, texel_length
from mua.avatar.decode_turns import ALONE
from mua.avatar.level_choice import LARGEST_TEXEL
from mua.bench.work import NOTHING, Work, by_kernel, gathered, total
from mua.errors import InputError
from mua.gpu import Bound, Device
from mua.motion.facing import front_of
from mua.player.buffers import AvatarBuffers
from mua.player.draw import EXACT_FORMAT, SortedSplats, SplatRenderer, draw_image, image_format
from mua.player.frame import AvatarFrame
from mua.player.splats import SplatFrame
from mua.pose.clip import Clip
from mua.pose.resample import resample

SCREEN = (1680, 1760)  # pixels of one eye: the default of a Quest 3
FOCAL = 790  # pixels
DISTANCES = (2.2, 1.0, 0.6)  # metres from the figure's middle
T = TypeVar("T")
VISIBLE_WORD = 4  # word of the arguments that splat_sort writes: how many splats some eye sees


@dataclass(frozen=True)
class Drawn:
    """The draw for one eye from one distance."""

    distance: float  # metres
    triangles: int
    fragments: int
    overdraw: float  # fragments of a covered pixel


@dataclass(frozen=True)
class Part:
    """Dispatches that follow one another."""

    kernels: dict[str, Work]  # by entry point, in frame order
    dispatches: int

    @property
    def work(self) -> Work:
        return sum(self.kernels.values(), NOTHING)


@dataclass(frozen=True)
class Face:
    """What a decode does besides where expressions move."""

    work: Work
    dispatches: int


@dataclass(frozen=True)
class LevelCounts:
    """One level of detail."""

    texels: int  # along a side
    splats: int
    chosen: float  # metres from the nearest point of the figure's box, from which on it is chosen
    decode: tuple[Part, ...]
    pose: Part
    drawn: Drawn  # from the first of DISTANCES


@dataclass(frozen=True)
class Counts:
    """Counts for one avatar before one eye, with all its splats in view."""

    avatar: str
    file_bytes: int
    parameters: int
    splats: int
    decode: tuple[Part, ...]  # from a window of poses to mesh and channels
    pose: Part  # from these to sorted splats, in every displayed frame that poses
    rest: int  # dispatches of a frame in which only the camera moves
    drawn: tuple[Drawn, ...]
    levels: tuple[LevelCounts, ...] = ()  # the finest first
    face: Face | None = None  # where all expressions move; None: the avatar has none

    @property
    def kernels(self) -> dict[str, Work]:
        """Work of a frame that decodes everything, by entry point."""
        spent: dict[str, Work] = {}
        for part in (*self.decode, self.pose):
            for name, work in part.kernels.items():
                spent[name] = spent.get(name, NOTHING) + work
        return spent

    @property
    def peak(self) -> Work:
        """Work of the displayed frame that moves most bytes, of an avatar that is alone in view."""
        return self.pose.work + max((added(half) for half in halves(self.decode)), key=lambda work: work.bytes)

    @property
    def whole(self) -> Part:
        """The whole decode."""
        kernels = {name: work for name, work in self.kernels.items() if name not in self.pose.kernels}
        return Part(kernels, sum(part.dispatches for part in self.decode))


def count(device: Device, path: Path) -> Counts:
    """Count a frame. Errors: InputError where the file holds no clip, or the device cannot hold avatar or image."""
    buffers = AvatarBuffers(device, path)
    avatar = buffers.avatar
    if not avatar.clips:
        raise InputError(f"{path} holds no clips; mua-bench needs one to pose the avatar")
    clip = resample(avatar.clips[0], avatar.encoding.rate)
    frame = SplatFrame(device, [AvatarFrame(device, buffers)])
    views = [_draw(device, frame, clip, distance) for distance in DISTANCES]
    share = max(visible for _, visible, _ in views) / frame.splat_count
    posed = views[0][0]
    return Counts(
        avatar=avatar.name,
        file_bytes=path.stat().st_size,
        parameters=sum(parameters(avatar).values()),
        splats=len(avatar.rig.texels.texels),
        decode=tuple(_part(bound, share) for bound in _decode_parts(device, frame.avatars[0], clip)),
        pose=_part(posed, share),
        rest=len(posed) - [each.kernel for each in posed].index("SplatProject"),
        drawn=tuple(drawn for _, _, drawn in views),
        levels=tuple(_level(device, frame, clip, level) for level in range(coarsest(avatar) + 1)),
        face=_face(device, frame.avatars[0], clip, share) if avatar.expressions else None,
    )


def as_json(counts: Counts) -> dict[str, Any]:
    """Numbers and names only; distances are metres."""
    works = {"decode": counts.whole.work, "pose": counts.pose.work, "peak_frame": counts.peak}
    return {
        "avatar": counts.avatar,
        "file_bytes": counts.file_bytes,
        "parameters": counts.parameters,
        "splats": counts.splats,
        "screen_pixels": list(SCREEN),
        "focal_pixels": FOCAL,
        "bytes": {name: work.bytes for name, work in works.items()},
        "operations": {name: work.flops for name, work in works.items()},
        "face": None if counts.face is None else asdict(counts.face.work),
        "parts": [{"bytes": part.work.bytes, "dispatches": part.dispatches} for part in counts.decode],
        "dispatches": {
            "decode": counts.whole.dispatches + counts.pose.dispatches,
            "pose": counts.pose.dispatches,
            "rest": counts.rest,
        },
        "triangles": {str(d.distance): d.triangles for d in counts.drawn},
        "fragments": {str(d.distance): d.fragments for d in counts.drawn},
        "overdraw": {str(d.distance): d.overdraw for d in counts.drawn},
        "levels": [
            {
                "texels": level.texels,
                "splats": level.splats,
                "chosen_from": level.chosen,
                "bytes": {"decode": added(level.decode).bytes, "pose": level.pose.work.bytes},
                "fragments": {str(level.drawn.distance): level.drawn.fragments},
            }
            for level in counts.levels
        ],
        "kernels": {name: {"bytes": work.bytes, "operations": work.flops} for name, work in counts.kernels.items()},
    }


def fragments(device: Device, splats: SortedSplats, camera: Camera) -> Array:
    """How many splats are drawn at each pixel, [H, W]. Errors: InputError where the device cannot blend floats."""
    if image_format(device) != EXACT_FORMAT:
        raise InputError(f"{device.adapter}: the device does not blend floats, by which fragments are counted")
    renderer = SplatRenderer(device, EXACT_FORMAT, fragment="CountFrag")
    return draw_image(device, renderer, splats, [camera])[..., 0]


def halves(decode: Sequence[T]) -> list[Sequence[T]]:
    """The parts of a decode by displayed frame, of an avatar that is alone in view."""
    return [decode[i : i + ALONE] for i in range(0, len(decode), ALONE)]


def added(parts: Sequence[Part]) -> Work:
    return sum((part.work for part in parts), NOTHING)


def _part(bound: Sequence[Bound], share: float) -> Part:
    """The work of dispatches where some eye sees this share of the splats."""
    return Part(by_kernel(bound, share=share), len(bound))


def _level(device: Device, frame: SplatFrame[AvatarFrame], clip: Clip, level: int) -> LevelCounts:
    posed, visible, drawn = _draw(device, frame, clip, DISTANCES[0], level)
    (avatar,) = frame.avatars
    share, shown = visible / max(frame.splat_count, 1), avatar.level
    return LevelCounts(
        texels=shown.size,
        splats=shown.splat_count,
        chosen=texel_length(avatar.avatar.avatar) * 2**level * FOCAL / LARGEST_TEXEL if level else 0.0,
        decode=tuple(_part(bound, share) for bound in _decode_parts(device, avatar, clip, level)),
        pose=_part(posed, share),
        drawn=drawn,
    )


def _face(device: Device, avatar: AvatarFrame, clip: Clip, share: float) -> Face:
    """What a face in which all expressions move costs beside a decode of the finest level."""
    weights, held = np.ones(len(avatar.avatar.avatar.expressions)), avatar.avatar.expressions
    with_face, without = (
        [bound for part in _decode_parts(device, avatar, clip, expressions=given) for bound in part]
        for given in (weights, None)
    )
    work = gathered(held.bent_count, held.triangle_count, avatar.avatar.level(0).reached)
    work += total(with_face, share=share) - total(without, share=share)
    return Face(work, len(with_face) - len(without))


def _decode_parts(
    device: Device, avatar: AvatarFrame, clip: Clip, level: int = 0, expressions: Array | None = None
) -> list[tuple[Bound, ...]]:
    """The dispatches of a decode by part."""
    window = avatar.avatar.avatar.encoding.frames(0)
    avatar.begin(clip.rotations[window], clip.translations[window], expressions, level=level)
    parts = []
    while avatar.parts_left > 0:
        commands = device.commands()
        avatar.advance(commands)
        parts.append(commands.bound)
    return parts


def _draw(
    device: Device, frame: SplatFrame[AvatarFrame], clip: Clip, distance: float, level: int = 0
) -> tuple[tuple[Bound, ...], int, Drawn]:
    """The dispatches of a frame that only poses, how many splats it sorted, and what is drawn."""
    (avatar,) = frame.avatars
    window = avatar.avatar.avatar.encoding.frames(0)
    decoding, commands = device.commands(), device.commands()
    avatar.decode_channels(decoding, clip.rotations[window], clip.translations[window], level=level)
    decoding.submit()
    avatar.repose(commands, clip.rotations[0], clip.translations[0])
    skeleton = avatar.avatar.avatar.rig.skeleton
    camera = eye_before(avatar.bounds, front_of(skeleton, clip.rotations[0], clip.translations[0]), distance)
    frame.sort(commands, [camera])
    commands.submit()
    arguments = frame.arguments.read()
    visible, triangles = int(arguments[VISIBLE_WORD]), int(arguments[0]) // 3
    at = fragments(device, frame.sorted, camera)
    whole = int(at.sum(dtype=float))
    drawn = Drawn(distance, triangles, whole, whole / max(int(np.count_nonzero(at)), 1))
    return commands.bound, visible, drawn


def eye_before(
    bounds: Array,  # [2, 3]
    azimuth: float,
    distance: float,
) -> Camera:
    """An eye in front of the figure, level with its middle."""
    camera = orbit(bounds, screen=SCREEN, azimuth=azimuth)
    view, projection = camera.view.copy(), camera.projection.copy()
    view[:3, 3] = [0, 0, -distance] - view[:3, :3] @ bounds.mean(axis=0)
    projection[0, 0], projection[1, 1] = (2 * FOCAL / side for side in SCREEN)
    return Camera(view, projection, SCREEN)
