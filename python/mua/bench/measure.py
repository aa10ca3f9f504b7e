"""Time on a device: every kernel of a frame, the drawing, and a large copy to compare them with."""

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import wgpu

from mua.arrays import Array
from mua.avatar.camera import Camera
from mua.bench.work import Work, by_kernel
from mua.errors import InputError
from mua.gpu import Commands, Device
from mua.gpu.failure import naming
from mua.gpu.timestamps import Timestamps
from mua.player.buffers import AvatarBuffers
from mua.player.draw import IMAGE_FORMAT, SortedSplats, SplatRenderer
from mua.player.frame import AvatarFrame
from mua.player.shot import Shot, film
from mua.player.splats import SplatFrame
from mua.pose.clip import Clip
from mua.pose.resample import resample

WARM_UP = 3  # frames before the first that counts
COPIED = 128 << 20  # bytes of the copy; more than any cache holds
COPIES = 5
VISIBLE_WORD = 4  # word of the arguments that splat_sort writes: how many splats some eye sees


@dataclass(frozen=True)
class Timing:
    """Milliseconds of a kernel over frames."""

    median: float
    low: float  # a tenth of the frames are faster
    high: float  # a tenth of the frames are slower


@dataclass(frozen=True)
class Measured:
    """The cost of one avatar on one device."""

    device: str
    avatar: str
    splats: int
    visible: int  # median over the frames
    screen: tuple[int, int]  # width, height of one eye, pixels
    eyes: int
    frames: int
    copy_bandwidth: float  # bytes a second, read and written
    kernels: dict[str, Timing]  # in frame order
    work: dict[str, Work]  # by the same kernels
    draw: Timing  # vertices and fragments of all eyes


def measure(device: Device, path: Path, *, frames: int, screen: tuple[int, int], eyes: float | None) -> Measured:
    """Play `frames` frames of the first clip of the file at `path`; `eyes` is the distance between two eyes in metres.

    Errors: InputError where the device has no timestamps or too little memory, or the file no clip.
    """
    if not device.timestamps:
        raise InputError(f"{device.adapter}: the device has no timestamps, which mua-bench reads")
    buffers = AvatarBuffers(device, path)
    if not buffers.avatar.clips:
        raise InputError(f"{path} holds no clips; mua-bench needs one to pose the avatar")
    clip, played = resample(buffers.avatar.clips[0], buffers.avatar.encoding.rate), WARM_UP + frames
    clip = clip.cut(slice(played))
    shots = film(Shot(screen, eyes=eyes), buffers.avatar.rig, clip)
    bandwidth = copy_bandwidth(device)
    frame = SplatFrame(device, [AvatarFrame(device, buffers)])
    spent, visible = _compute_frames(device, frame, clip, shots, frames)
    drawn = _draw_frames(device, frame, clip, shots, frames)  # after all computing, for the reason given there
    work = by_kernel(_compute(device, frame, clip, shots, 0).bound, share=visible / frame.splat_count)
    return Measured(
        device=str(device.adapter),
        avatar=buffers.avatar.name,
        splats=len(buffers.avatar.rig.texels.texels),
        visible=visible,
        screen=screen,
        eyes=len(shots[0]),
        frames=frames,
        copy_bandwidth=bandwidth,
        kernels={name: _timing(spent[name]) for name in work},
        work=work,
        draw=_timing(drawn),
    )


def copy_bandwidth(device: Device) -> float:
    """Bytes a second that the device reads and writes when it copies a large buffer to another; the median copy."""
    size = min(COPIED, device.limits["max-buffer-size"])
    usage = wgpu.BufferUsage.COPY_SRC | wgpu.BufferUsage.COPY_DST
    with naming("buffers of the copy"):
        source, target = (device.wgpu.create_buffer(size=size, usage=usage) for _ in range(2))

    def record(encoder: wgpu.GPUCommandEncoder, timestamps: Timestamps) -> None:
        for index in range(1, COPIES + 1):
            encoder.copy_buffer_to_buffer(source, 0, target, 0, size)
            encoder.begin_compute_pass(timestamp_writes=timestamps.of_pass(index)).end()

    return float(2 * size / (1e-3 * np.median(_timed(device, COPIES, record))))


def _compute_frames(
    device: Device, frame: SplatFrame[AvatarFrame], clip: Clip, shots: list[tuple[Camera, ...]], frames: int
) -> tuple[dict[str, list[float]], int]:
    """Milliseconds of every counted frame by kernel, and the median of the visible splats."""
    spent: dict[str, list[float]] = defaultdict(list)
    visible = []
    for index in range(WARM_UP + frames):
        times = _compute(device, frame, clip, shots, index).milliseconds()
        if index >= WARM_UP:
            visible.append(frame.arguments.read()[VISIBLE_WORD])
            for name, milliseconds in times.items():
                spent[name].append(milliseconds)
    return spent, int(np.median(visible))


def _draw_frames(
    device: Device, frame: SplatFrame[AvatarFrame], clip: Clip, shots: list[tuple[Camera, ...]], frames: int
) -> list[float]:
    """Milliseconds of drawing every counted frame.

    After an image was drawn, Mesa's lavapipe puts timestamps off to the next barrier: a kernel's time would then count
    for the kernel after it.
    """
    renderer = SplatRenderer(device, IMAGE_FORMAT)
    taken = []
    for index in range(WARM_UP + frames):
        _compute(device, frame, clip, shots, index)
        taken.append(_draw(device, renderer, frame.sorted, shots[index % len(clip)]))
    return taken[WARM_UP:]


def _compute(
    device: Device, frame: SplatFrame[AvatarFrame], clip: Clip, shots: list[tuple[Camera, ...]], index: int
) -> Commands:
    """Submit everything up to the sort of a frame; the clip starts over at its end."""
    (avatar,) = frame.avatars
    window = [i % len(clip) for i in avatar.avatar.avatar.encoding.frames(index)]
    commands = device.commands(timed=True)
    avatar.decode(commands, clip.rotations[window], clip.translations[window])
    frame.sort(commands, shots[window[0]])
    commands.submit()
    return commands


def _draw(device: Device, renderer: SplatRenderer, splats: SortedSplats, cameras: tuple[Camera, ...]) -> float:
    """Milliseconds of drawing all eyes side by side."""
    width, height = cameras[0].screen
    size = (len(cameras) * width, height, 1)
    with naming(f"image of {size[0]} x {size[1]} pixels"):
        target = device.wgpu.create_texture(size=size, format=IMAGE_FORMAT, usage=wgpu.TextureUsage.RENDER_ATTACHMENT)

    def record(encoder: wgpu.GPUCommandEncoder, timestamps: Timestamps) -> None:
        cleared = {"view": target.create_view(), "load_op": "clear", "store_op": "store", "clear_value": (0, 0, 0, 0)}
        render_pass = encoder.begin_render_pass(color_attachments=[cleared], timestamp_writes=timestamps.of_pass(1))
        renderer.draw(render_pass, splats, cameras)
        render_pass.end()

    (taken,) = _timed(device, 1, record)
    return float(taken)


def _timed(
    device: Device, passes: int, record: Callable[[wgpu.GPUCommandEncoder, Timestamps], None]
) -> Array:  # [passes] milliseconds
    """Time what `record` appends, whose passes take the timestamps from 1 on."""
    timestamps = Timestamps(device.wgpu, 1 + passes)
    with naming("mua-bench"):
        encoder = device.wgpu.create_command_encoder()
        encoder.begin_compute_pass(timestamp_writes=timestamps.of_pass(0)).end()
        record(encoder, timestamps)
        timestamps.resolve(encoder)
        device.wgpu.queue.submit([encoder.finish()])
    return np.asarray(np.diff(timestamps.milliseconds()))


def _timing(times: list[float]) -> Timing:
    low, median, high = np.percentile(times, (10, 50, 90))
    return Timing(float(median), float(low), float(high))
