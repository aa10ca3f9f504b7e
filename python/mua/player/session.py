"""What an interactive player shows and how it moves, apart from any window."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import wgpu

from mua.arrays import Array
from mua.camera import EYE_DISTANCE, Camera, stereo
from mua.errors import InputError
from mua.gpu import Device
from mua.motion.clip import Clip
from mua.player.buffers import AvatarBuffers
from mua.player.motion import named_clip, player_clips
from mua.player.overlays import ground_height
from mua.player.scene import Scene, Toggles
from mua.player.splats import SplatFrame
from mua.player.viewpoint import Viewpoint, framing

BACKGROUND = (0.93, 0.94, 0.95, 1.0)  # sRGB
SMOOTHING = 0.1  # share of the newest frame in the times on screen
HORIZONTAL = np.array([1.0, 0, 1])  # a camera that follows keeps its height


@dataclass(frozen=True)
class Source:
    """What the player was asked to show."""

    files: tuple[Path, ...]  # avatars
    motion: Path | None = None  # in place of the files' own clips
    mapping: Mapping[str, str] | None = None  # avatar's joint to joint of the motion


class Stage:
    """One loaded avatar."""

    def __init__(self, device: Device, source: Source, file: Path, *, color_format: str) -> None:
        """Errors: InputError where the file is broken or too large, or the motion does not fit."""
        avatar = AvatarBuffers(device, file)
        self.clips, self.notes = player_clips(avatar.avatar, file, motion=source.motion, mapping=source.mapping)
        self.frame = SplatFrame(device, [avatar])
        self.scene = Scene(device, self.frame, color_format=color_format, background=BACKGROUND)
        self.rig, self.encoding, self.bounds = avatar.avatar.rig, avatar.avatar.encoding, avatar.avatar.bounds
        self._grounds: dict[str, float] = {}

    def ground(self, clip: Clip) -> float:
        """Height on which a clip stands, metres."""
        if clip.name not in self._grounds:
            self._grounds[clip.name] = ground_height(self.rig, clip)
        return self._grounds[clip.name]


class Session:
    """The state behind the window; every change shows in the next `draw`."""

    def __init__(self, device: Device, source: Source, *, clip: str | None, color_format: str) -> None:
        """Load the first avatar.

        Errors: InputError as of Stage, or where no clip has that name.
        """
        self._device, self._source, self._color_format = device, source, color_format
        self._stages: dict[Path, Stage] = {}
        self.toggles = Toggles(shadow=True)
        self.stereo, self.follow = False, True
        self.playing, self.speed, self.time = True, 1.0, 0.0  # time in frames of the clip
        self.failure = ""  # why the last avatar asked for is not shown
        self.milliseconds: dict[str, float] = {}  # by kernel, smoothed
        self.timed = False  # whether to measure them
        self.file = source.files[0]
        self._stage = self._load(self.file)
        self._clip = named_clip(self._stage.clips, clip, source=source.motion or self.file)
        self._drawn: tuple[object, ...] = ()  # what the frame holds: avatar, clip, index
        self.view: Viewpoint | None = None  # framed by the first draw

    @property
    def files(self) -> tuple[Path, ...]:
        """The avatars that can be chosen."""
        return self._source.files

    @property
    def clips(self) -> Sequence[Clip]:
        """The clips of this avatar."""
        return self._stage.clips

    @property
    def clip(self) -> Clip:
        """The clip that plays."""
        return self._clip

    @property
    def notes(self) -> tuple[str, ...]:
        """What retargeting has to tell."""
        return self._stage.notes

    @property
    def splats(self) -> int:
        """How many this avatar has."""
        return self._stage.frame.splat_count

    @property
    def can_time(self) -> bool:
        """Whether the device has timestamps."""
        return self._device.timestamps

    @property
    def index(self) -> int:
        """The frame of the clip that is shown."""
        return int(self.time) % len(self._clip)

    def choose_file(self, file: Path) -> None:
        """Show another avatar, at the clip of the same name if it has one; keep this one where it cannot be loaded."""
        try:
            self._stage = self._load(file)
        except InputError as error:
            self.failure = str(error)
            return
        self.file, self.failure = file, ""
        same = [clip for clip in self._stage.clips if clip.name == self._clip.name]
        self.choose_clip(same[0] if same else self._stage.clips[0])
        self.view = None

    def choose_clip(self, clip: Clip) -> None:
        """Play another clip from its start."""
        self._clip, self.time = clip, 0.0

    def step(self, frames: int) -> None:
        """Stop and go so many frames on."""
        self.playing, self.time = False, float((self.index + frames) % len(self._clip))

    def advance(self, seconds: float) -> None:
        """Play on for so long, round and round."""
        if self.playing:
            self.time = (self.time + seconds * self.speed * self._clip.rate) % len(self._clip)

    def toggle(self, name: str) -> None:
        """Show or hide one of Toggles."""
        self.toggles = replace(self.toggles, **{name: not getattr(self.toggles, name)})

    def draw(self, target: wgpu.GPUTexture) -> None:
        """Submit the picture of the present state; a stereo pair shares the width of the target."""
        width, height, _ = target.size
        cameras = self._cameras((max(width // 2, 1) if self.stereo else width, height))
        commands = self._device.commands(timed=self.timed and self.can_time)
        window = self._stage.encoding.frames(self.index)
        rotations, translations = self._clip.rotations[window], self._clip.translations[window]
        shown = (self.file, self._clip.name, self.index)
        if shown != self._drawn:
            self._stage.frame.avatars[0].decode(commands, rotations, translations)
            self._stage.scene.pose(rotations[0], translations[0], ground=self._stage.ground(self._clip))
        self._stage.frame.sort(commands, cameras)
        commands.submit()
        self._drawn = shown
        self._stage.scene.draw(target, cameras, self.toggles)
        if self.timed and self.can_time:
            self._note(commands.milliseconds())

    def _load(self, file: Path) -> Stage:
        if file not in self._stages:
            self._stages[file] = Stage(self._device, self._source, file, color_format=self._color_format)
        return self._stages[file]

    def _root(self) -> Array:
        """Where the root joint is, [3] metres, with the height that it has at the start of the clip."""
        skeleton, clip = self._stage.rig.skeleton, self._clip
        frames = [self.index, 0]
        _, placed = skeleton.world(clip.rotations[frames], clip.translations[frames])
        now, start = placed[:, skeleton.root]
        return np.where(HORIZONTAL > 0, now if self.follow else start, start)

    def _cameras(self, screen: tuple[int, int]) -> tuple[Camera, ...]:
        root = self._root()
        if self.view is None:
            self.view = framing(self._stage.bounds, screen)
        camera = replace(self.view, target=self.view.target + root).camera(screen)
        return stereo(camera, EYE_DISTANCE) if self.stereo else (camera,)

    def _note(self, milliseconds: Mapping[str, float]) -> None:
        """Smooth the times; a kernel that did not run this time keeps what it took."""
        for name, spent in milliseconds.items():
            before = self.milliseconds.get(name, spent)
            self.milliseconds[name] = before + SMOOTHING * (spent - before)
