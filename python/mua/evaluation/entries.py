"""What is compared: avatar files and the mean texture, each as a row that can give a texture."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.bench.measure import measure
from mua.bench.report import total_milliseconds
from mua.errors import InputError
from mua.evaluation.cost import Cost, file_cost, learnt_cost
from mua.gpu import Device
from mua.kernels.inverse_dwt import unpack_channels
from mua.player.buffers import AvatarBuffers
from mua.player.frame import AvatarFrame
from mua.recording import Recording, WholeFrame
from mua.rig.rig import Rig

FPS_FRAMES = 5  # timed of each file
MEAN = "mean texture"
PLAYED = ", own mesh"


@dataclass(frozen=True, eq=False)
class Picture:
    """What an entry makes of a frame."""

    texture: Array  # [N, 23] raw channels
    mesh: Array | None = None  # [V, 3] canonical vertices, metres; None: the teacher's


@dataclass(frozen=True)
class Entry:
    """One row: how to make a frame, or the sentence that says why it cannot."""

    name: str
    picture: Callable[[WholeFrame], Picture] | None
    cost: Cost = field(default_factory=Cost)
    own_mesh: bool = False  # its images bring a mesh
    failure: str = ""


def mean_entry(recording: Recording) -> Entry:
    """The mean texture of the training frames: what a system must beat."""
    texture = recording.mean_texture().astype(np.float32)
    return Entry(MEAN, lambda _: Picture(texture), learnt_cost(texture.size, flops=0))


def avatar_entries(device: Device, path: Path, rig: Rig, *, size: int, played: bool) -> list[Entry]:
    """An avatar file on the teacher's mesh and, where `played`, on its own as a user sees it.

    Errors: InputError where the file is broken, of another rig than the recording, or too large for the device.
    """
    buffers = AvatarBuffers(device, path)
    _check_rig(path, buffers.avatar.rig, rig)
    decoder = _Decoder(device, buffers)
    avatar = buffers.avatar
    cost = file_cost(path, avatar, fps=frames_per_second(device, path, size=size))
    entries = [Entry(path.stem, lambda frame: Picture(decoder(frame).texture), cost)]
    return [*entries, Entry(path.stem + PLAYED, decoder, cost, own_mesh=True)] if played else entries


def frames_per_second(device: Device, path: Path, *, size: int) -> float | None:
    """Of the whole frame, inference and drawing as in the paper (Sec. Metrics); None where it cannot be timed."""
    try:
        measured = measure(device, path, frames=FPS_FRAMES, screen=(size, size), eyes=None)
    except InputError:  # no timestamps, or no clip to play
        return None
    spent = total_milliseconds(measured) + measured.draw.median  # milliseconds
    return 1000 / spent if spent > 0 else None


def sentence(error: Exception) -> str:
    """What went wrong, in one line."""
    text = " ".join(str(error).split())
    return text if isinstance(error, InputError) else f"{type(error).__name__}: {text}"


class _Decoder:
    """Textures and meshes of an avatar file as the player's kernels make them; the last frame is kept."""

    def __init__(self, device: Device, buffers: AvatarBuffers) -> None:
        self._device = device
        self._frame = AvatarFrame(device, buffers)
        self._last: tuple[tuple[str, int], Picture] | None = None

    def __call__(self, frame: WholeFrame) -> Picture:
        key = (frame.clip.name, frame.index)
        if self._last is None or self._last[0] != key:
            self._last = (key, self._decode(frame))
        return self._last[1]

    def _decode(self, frame: WholeFrame) -> Picture:
        window = self._frame.avatar.avatar.encoding.frames(frame.index)
        commands = self._device.commands()
        weights = frame.clip.pose(frame.index).expressions
        self._frame.decode(commands, frame.clip.rotations[window], frame.clip.translations[window], expressions=weights)
        commands.submit()
        texture = unpack_channels(self._frame.texel_channels.read())
        return Picture(texture, self._frame.mesh.read(np.float32).reshape(-1, 3))


def _check_rig(path: Path, own: Rig, recorded: Rig) -> None:
    pairs = (
        ("texels", own.texels.texels, recorded.texels.texels),
        ("triangles", own.mesh.faces, recorded.mesh.faces),
        ("joints", np.array(own.skeleton.names), np.array(recorded.skeleton.names)),
    )
    for what, found, expected in pairs:
        if not np.array_equal(found, expected):
            raise InputError(f"{path}: its {what} are not those of the recording: it was distilled from another rig")
