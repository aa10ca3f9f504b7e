"""The state of an interactive player, independent of any window."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from time import monotonic

import numpy as np
import wgpu

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.avatar.camera import EYE_DISTANCE, Camera
from mua.errors import InputError
from mua.gpu import Commands, Device
from mua.live.live_pose import Live
from mua.live.receiver import Receiver
from mua.motion.facing import front_of
from mua.player.buffers import AvatarBuffers
from mua.player.focus import find_focus
from mua.player.frame import AvatarFrame
from mua.player.levels import AUTO, Levels, Wanted
from mua.player.motion import (
    live_of,
    named_clip,
    player_clips,
    require_expressions,
    require_frame,
    stance,
    with_weights,
)
from mua.player.overlays import ground_height
from mua.player.played_files import Source
from mua.player.scene import CLEAR, Scene
from mua.player.schedule import DecodeSchedule, Moment
from mua.player.shot import GROUND, Look, eyes_of
from mua.player.splats import SplatFrame
from mua.player.viewpoint import Viewpoint, directions, framing
from mua.pose.clip import Clip
from mua.pose.skeleton import Pose
from mua.rig.bounds import way_out

SMOOTHING = 0.1  # share of the newest frame in the times on screen
ROUND = np.linspace(0, 2 * np.pi, 16, endpoint=False)  # radians at which a figure is framed, so that all its sides fit


class Stage:
    """One loaded avatar."""

    def __init__(self, device: Device, source: Source, file: Path, look: Look, *, color_format: str) -> None:
        """Raise InputError where the file is broken or too large, the motion does not fit or a joint is missing."""
        avatar = AvatarBuffers(device, file)
        receiver = source.receiver
        self.live = None if receiver is None else live_of(avatar.avatar, file, receiver, source.mapping)
        self.clips, self.notes = _clips(source, avatar.avatar, file, self.live)
        self.frame = SplatFrame(device, [AvatarFrame(device, avatar)])
        self.schedule = DecodeSchedule(self.frame.avatars[0])
        background = CLEAR if look.background is None else (*look.background, 1.0)
        self.scene = Scene(device, self.frame, color_format=color_format, background=background)
        self.rig, self.encoding, self.bounds = avatar.avatar.rig, avatar.avatar.encoding, avatar.avatar.bounds
        self.expressions = avatar.avatar.expressions
        self.levels = Levels(avatar.avatar, look.level)
        self.notes += (self.levels.note,) if self.levels.note else ()
        self.focus = None if look.shot.look_at is None else find_focus(self.rig, look.shot.look_at)
        self._grounds: dict[str, float] = {}

    def ground(self, clip: Clip) -> float:
        """Height in metres of the ground on which a clip stands."""
        if clip.name not in self._grounds:
            self._grounds[clip.name] = ground_height(self.rig, clip)
        return self._grounds[clip.name]

    def front(self, clip: Clip) -> float:
        """Azimuth of the figure's front at the start of a clip, radians."""
        return front_of(self.rig.skeleton, clip.rotations[0], clip.translations[0])


def _clips(source: Source, avatar: Avatar, file: Path, live: Live | None) -> tuple[list[Clip], tuple[str, ...]]:
    """The clips to choose from, first the one that stands for a live pose, and notes."""
    if live is None:
        return player_clips(avatar, file, motion=source.motion, mapping=source.mapping, face=source.face)
    clips, notes = player_clips(avatar, file, motion=None, mapping=None, face=source.face) if avatar.clips else ([], ())
    return [stance(live, avatar.encoding.rate), *clips], notes


class Session:
    """The state behind the window; every change shows in the next `draw`."""

    def __init__(self, device: Device, source: Source, look: Look, *, color_format: str) -> None:
        """Load the first avatar.

        Errors: InputError where Stage raises it, or where no clip has that name or the frame.
        """
        self._device, self._source, self._color_format = device, source, color_format
        self._stages: dict[Path, Stage] = {}
        self._look, self.toggles = look, look.toggles
        self.stereo, self.follow = look.shot.eyes is not None, look.shot.follow
        self.turning = look.shot.turning
        self.playing, self.speed, self.time = True, 1.0, 0.0  # time in frames of the clip
        self.weights = dict(look.weights)  # of expressions, in place of the clip's; those of other avatars are kept
        self.search = ""  # what the panel narrows its list of expressions to
        self.failure = ""  # why the avatar last chosen is not shown
        self.milliseconds: dict[str, float] = {}  # by kernel, smoothed
        self.timed = False  # whether to measure them
        self.file = source.files[0]
        self._stage = self._load(self.file)
        require_expressions(self._stage.expressions, look.weights, file=self.file)
        self._clip = named_clip(self._stage.clips, source.clip, source=source.motion or self.file)
        if source.frame is not None:
            self.step(require_frame(self._clip, source.frame))
        self._step = 0.0  # frames of the clip from one image to the next, as it plays
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
    def live(self) -> Live | None:
        """What another program sends, where that is shown; None where a clip is."""
        return self._stage.live if self._clip is self._stage.clips[0] else None

    @property
    def receiver(self) -> Receiver | None:
        """The port that is listened on; None where nothing is."""
        return self._source.receiver

    @property
    def expressions(self) -> dict[str, float]:
        """The avatar's expressions with the weights that are shown."""
        names = self._stage.expressions
        shown = with_weights(names, self._pose_shown.expressions, self.weights)
        return dict.fromkeys(names, 0.0) if shown is None else dict(zip(names, shown.tolist(), strict=True))

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes of retargeting and of the level of detail."""
        return self._stage.notes

    @property
    def splats(self) -> int:
        """How many splats this avatar has."""
        return self._stage.frame.splat_count

    @property
    def level(self) -> str:
        """The setting of the level of detail, and how many texels along a side are shown."""
        levels, shown = self._stage.levels, self._stage.frame.avatars[0].level.size
        return f"{levels.wanted} level: {shown} texels" if isinstance(levels.wanted, str) else f"{shown} texels"

    @property
    def outside(self) -> float:
        """Share of the pose shown that training did not show, 0 to 1."""
        return self._stage.frame.avatars[0].outside

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
        """Play another clip from its start, seen from the same side of the figure."""
        if self.view is not None:
            self.view = self.view.gone_round(self._stage.front(clip) - self._stage.front(self._clip))
        self._clip, self.time = clip, 0.0

    def step(self, frames: int) -> None:
        """Pause and move on by this number of frames."""
        self.playing, self.time = False, float((self.index + frames) % len(self._clip))

    def advance(self, seconds: float) -> None:
        """Play on for this time, in a loop."""
        self._step = seconds * self.speed * self._clip.rate
        if self.playing:
            if self.live is not None:
                self.live.advance(monotonic())
            self.time = (self.time + self._step) % len(self._clip)
            if self.view is not None:
                self.view = replace(self.view, azimuth=self.view.azimuth + self.turning * seconds)

    def choose_level(self, wanted: Wanted) -> None:
        """Choose the level of detail: AUTO, FULL or one of the avatar's sizes."""
        self._stage.levels.wanted = wanted

    def next_level(self) -> None:
        """Choose the next coarser level of detail; after the coarsest, AUTO."""
        wanted: tuple[Wanted, ...] = (AUTO, *self._stage.levels.sizes)
        now = self._stage.levels.wanted
        self.choose_level(wanted[((wanted.index(now) if now in wanted else 1) + 1) % len(wanted)])

    def toggle(self, name: str) -> None:
        """Show or hide one of Toggles."""
        self.toggles = replace(self.toggles, **{name: not getattr(self.toggles, name)})

    def draw(self, target: wgpu.GPUTexture) -> None:
        """Submit the image of the present state; a stereo pair shares the width of the target."""
        width, height, _ = target.size
        cameras = self._cameras((max(width // 2, 1) if self.stereo else width, height))
        commands = self._device.commands(timed=self.timed and self.can_time)
        self._pose(commands, cameras)
        self._stage.frame.sort(commands, cameras)
        commands.submit()
        self._stage.scene.draw(target, cameras, self.toggles)
        if self.live is not None and self.receiver is not None:
            self.receiver.latency.drawn(self.live.arrived, monotonic())
        if self.timed and self.can_time:
            self._note(commands.milliseconds())

    def _pose(self, commands: Commands, cameras: Sequence[Camera]) -> None:
        """Append the dispatches for the frame that is due, and a part of decoding the one after it."""
        stage, clip, live, pose = self._stage, self._clip, self.live, self._pose_shown
        rotations, translations = pose.rotations, pose.translations
        level = 0 if self.toggles.geometry else stage.levels.choose(rotations, translations, cameras)
        named = tuple(self.weights.items())
        frames = (self.index, self._following()) if live is None else (live.moment, live.moment)
        due, following = ((clip.name, frame, named) for frame in frames)
        if stage.schedule.record(commands, due, following, self._window, level=level):
            stage.frame.avatars[0].repose(commands, rotations, translations)
            stage.scene.pose(rotations, translations, ground=stage.ground(clip))

    @property
    def _pose_shown(self) -> Pose:
        return self._clip.pose(self.index) if self.live is None else self.live.now.pose

    def _following(self) -> int:
        """The frame to decode ahead; this one where the clip rests or skips frames, or what is shown must be exact."""
        exact = self.timed or self.toggles.geometry
        if exact or not self.playing or not 0 < self._step < 1:
            return self.index
        return (self.index + 1) % len(self._clip)

    def _window(self, moment: Moment) -> tuple[Array, Array, Array | None]:
        _, index, named = moment
        if self.live is not None:
            (rotations, translations), pose = self.live.window(), self.live.now.pose
        else:
            window, pose = self._stage.encoding.frames(index), self._clip.pose(index)
            rotations, translations = self._clip.rotations[window], self._clip.translations[window]
        return rotations, translations, with_weights(self._stage.expressions, pose.expressions, dict(named))

    def _load(self, file: Path) -> Stage:
        if file not in self._stages:
            self._stages[file] = Stage(self._device, self._source, file, self._look, color_format=self._color_format)
        return self._stages[file]

    def _followed(self) -> Array:
        """The point that the view follows, [3] metres: the root at its first height, or the focus."""
        skeleton, focus = self._stage.rig.skeleton, self._stage.focus
        shown, first = self._pose_shown, self._clip.pose(0)
        rotations = np.stack([shown.rotations, first.rotations])
        translations = np.stack([shown.translations, first.translations])
        if focus is not None:
            now, start = focus.places(skeleton, rotations, translations)
            return np.asarray(now if self.follow else start)
        now, start = skeleton.world(rotations, translations)[1][:, skeleton.root]
        return np.asarray(start + (now - start) * GROUND * self.follow)

    def _cameras(self, screen: tuple[int, int]) -> tuple[Camera, ...]:
        if self.view is None:
            self.view = self._framed(screen)
        view = replace(self.view, target=self.view.target + self._followed())
        return eyes_of(view, screen, (self._look.shot.eyes or EYE_DISTANCE) if self.stereo else None)

    def _framed(self, screen: tuple[int, int]) -> Viewpoint:
        """The initial view, before any mouse has moved it."""
        shot = self._look.shot
        sides = ROUND if self.turning else np.zeros(1)
        azimuths = self._stage.front(self._clip) + shot.azimuth + sides
        view = framing(self._stage.bounds, screen, azimuths=azimuths, elevation=shot.elevation).nearer(shot.zoom)
        middle = view.target
        if self._stage.focus is not None:
            view, middle = replace(view, target=np.zeros(3)), self._followed() - self._root()
        return view.outside(way_out(self._stage.bounds, middle, directions(azimuths, shot.elevation)).max())

    def _root(self) -> Array:
        """Where the root joint is, [3] metres."""
        skeleton, shown = self._stage.rig.skeleton, self._pose_shown
        return np.asarray(skeleton.world(shown.rotations, shown.translations)[1][skeleton.root])

    def _note(self, milliseconds: Mapping[str, float]) -> None:
        """Smooth the times; a kernel that did not run keeps its last time."""
        for name, spent in milliseconds.items():
            before = self.milliseconds.get(name, spent)
            self.milliseconds[name] = before + SMOOTHING * (spent - before)
