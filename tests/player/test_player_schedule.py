"""Decodes spread over displayed frames: what each frame shows, and how many parts it decodes."""

from pathlib import Path

import numpy as np
import pytest
import wgpu
from synthetic_avatar import synthetic_avatar, with_expressions

from mua.arrays import Array
from mua.asset import write
from mua.avatar.decode_turns import ALONE, PARTS
from mua.cli.view_options import Asked, look_of
from mua.gpu import Commands, Device
from mua.player.buffers import AvatarBuffers
from mua.player.channels import TEXEL_CHANNELS
from mua.player.frame import AvatarFrame
from mua.player.played_files import Source
from mua.player.schedule import DecodeSchedule, Moment, Window
from mua.player.session import Session

FRAMES = 7  # frames of the clip
HEADSET = 25 / 72  # frames of the avatar in a displayed one
ENDS = ("BlendLl", "UpsampleTexels")  # kernels of which each part of a decode has one


class Display:
    """Shows an avatar by a schedule, one displayed frame after the other."""

    def __init__(self, device: Device, file: Path) -> None:
        self.device = device
        self.frame = AvatarFrame(device, AvatarBuffers(device, file))
        self.schedule = DecodeSchedule(self.frame)
        self.asked: list[int] = []  # frames whose windows were decoded

    def window(self, moment: Moment) -> tuple[Array, Array, Array | None]:
        self.asked.append(moment[1])
        clip, frames = self.frame.avatar.avatar.clips[0], self.frame.avatar.avatar.encoding.frames(moment[1])
        return clip.rotations[frames], clip.translations[frames], None

    def show(self, due: int, following: int | None = None, *, level: int = 0, shown_at: int | None = None) -> int:
        """Display a frame, holding it to what is due; how many parts of decodes it made."""
        commands, ahead = self.device.commands(), due if following is None else following
        self.schedule.record(commands, ("", due, ()), ("", ahead, ()), self.window, level=level)
        commands.submit()
        self.require(due, level if shown_at is None else shown_at)
        return sum(each.kernel in ENDS for each in commands.bound)

    def require(self, index: int, level: int) -> None:
        """Mesh and channels are, bit for bit, those of a frame that is decoded at once."""
        alone, commands = AvatarFrame(self.device, self.frame.avatar), self.device.commands()
        clip, frames = self.frame.avatar.avatar.clips[0], self.frame.avatar.avatar.encoding.frames(index)
        alone.decode_channels(commands, clip.rotations[frames], clip.translations[frames], level=level)
        commands.submit()
        words = TEXEL_CHANNELS // 4 * alone.splat_count
        assert self.frame.level.number == level
        np.testing.assert_array_equal(self.frame.mesh.read(), alone.mesh.read())
        np.testing.assert_array_equal(self.frame.texel_channels.read()[:words], alone.texel_channels.read()[:words])

    def play(self, step: float, count: int) -> list[int]:
        """Decoded parts in each displayed frame, while the clip advances by `step` of its frames per display."""
        due = [int(shown * step) % FRAMES for shown in range(count)]
        return [self.show(index, (index + 1) % FRAMES) for index in due]


@pytest.fixture
def display(device: Device, avatar_file: Path) -> Display:
    return Display(device, avatar_file)


@pytest.mark.parametrize("step", [HEADSET, 1 / 2, 30 / 90])
def test_a_clip_is_on_time_and_no_displayed_frame_decodes_all(display: Display, step: float) -> None:
    """Round and round, past the end of the clip."""
    first, *later = display.play(step, 30)
    assert first == PARTS
    assert max(later) == ALONE
    assert display.asked == [index % FRAMES for index in range(len(display.asked))]  # each once, in order


def test_a_display_less_than_twice_as_fast_is_on_time_too(display: Display) -> None:
    assert max(display.play(0.8, 20)) == PARTS


def test_an_unforeseen_pose_is_decoded_at_once(display: Display) -> None:
    assert display.show(0, 1) == PARTS
    assert display.show(0, 1) == ALONE
    assert display.show(4) == PARTS
    assert display.show(4) == 0
    assert display.show(1) == PARTS  # its first part is of no use any more: other poses may have come between


def test_what_was_begun_and_is_due_too_early_is_completed(display: Display) -> None:
    display.show(0, 1)
    assert display.show(0, 1) == ALONE
    assert display.show(1, 2) == PARTS - ALONE  # the parts that are left; the frame after it waits
    assert display.show(2, 3) == PARTS
    assert display.asked == [0, 1, 2]


def test_another_future_replaces_the_one_that_was_begun(display: Display) -> None:
    display.show(3, 4)
    assert display.show(3, 4) == ALONE
    assert [display.show(3, 2), display.show(3, 2), display.show(3, 2)] == [ALONE, ALONE, 0]
    assert display.show(2) == 0


def test_the_second_set_is_made_when_it_is_first_needed(display: Display) -> None:
    display.show(0)
    assert display.frame._hidden is None
    display.show(0, 1)
    assert display.frame._hidden is not None


def test_another_level_of_detail_comes_with_the_next_frame_and_at_rest_at_once(display: Display) -> None:
    display.show(0, 1)
    assert display.show(0, 1, level=1, shown_at=0) == ALONE
    assert display.show(0, 1, level=2, shown_at=0) == ALONE
    assert display.show(1, 2, level=2, shown_at=1) == ALONE  # whole; the next is begun at the level of now
    assert display.show(1, 1, level=2) == PARTS
    assert display.show(1, 1, level=2) == 0


def test_a_decode_at_once_gives_up_the_one_that_was_begun(display: Display) -> None:
    frame, commands = display.frame, display.device.commands()
    frame.begin(*display.window(("", 5, ())))
    frame.advance(commands)
    frame.decode_channels(commands, *display.window(("", 2, ())))
    commands.submit()
    assert frame.parts_left == 0
    display.require(2, 0)


class Watched:
    """A session that is drawn, and what its schedule was asked."""

    def __init__(self, device: Device, file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.session = Session(device, Source((file,)), look_of(Asked(), None), color_format="rgba8unorm")
        usage = wgpu.TextureUsage.RENDER_ATTACHMENT
        self._target = device.wgpu.create_texture(size=(32, 24, 1), format="rgba8unorm", usage=usage)
        self.moments: list[tuple[int, int]] = []
        record = DecodeSchedule.record

        def noting(
            schedule: DecodeSchedule, commands: Commands, due: Moment, following: Moment, window: Window, *, level: int
        ) -> bool:
            self.moments.append((due[1], following[1]))
            return record(schedule, commands, due, following, window, level=level)

        monkeypatch.setattr(DecodeSchedule, "record", noting)

    def draw(self) -> tuple[int, int]:
        """The frame that is due in an image and the one that is decoded ahead."""
        self.session.draw(self._target)
        return self.moments[-1]


@pytest.fixture
def watched(device: Device, avatar_file: Path, monkeypatch: pytest.MonkeyPatch) -> Watched:
    return Watched(device, avatar_file, monkeypatch)


def test_a_window_that_plays_looks_ahead(watched: Watched) -> None:
    session = watched.session
    for index in (0, 3, FRAMES - 1):
        session.time = index + 0.5
        session.advance(0.25 / session.clip.rate)
        assert watched.draw() == (index, (index + 1) % FRAMES)


def test_a_window_that_rests_or_skips_or_times_frames_decodes_none_ahead(watched: Watched) -> None:
    session = watched.session
    assert watched.draw() == (0, 0)  # before it plays
    session.advance(2 / session.clip.rate)
    assert watched.draw() == (2, 2)
    session.timed = True
    session.advance(0.25 / session.clip.rate)
    assert watched.draw() == (2, 2)
    session.timed = False
    assert watched.draw() == (2, 3)
    session.playing = False
    session.advance(0.25 / session.clip.rate)
    assert watched.draw() == (2, 2)
    session.playing = True
    session.advance(0.25 / session.clip.rate)
    session.step(1)
    assert watched.draw() == (3, 3)


def test_a_face_that_alone_changed_is_decoded(device: Device, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Paused: a weight that is set shows in the next image; the same again decodes nothing."""
    write(tmp_path / "face.muaavatar", with_expressions(synthetic_avatar()))
    watched = Watched(device, tmp_path / "face.muaavatar", monkeypatch)
    session = watched.session
    session.step(3)
    own, weights = session.expressions, session.clip.pose(3).expressions
    assert weights is not None
    assert own == pytest.approx(dict(zip(own, weights, strict=True)))
    watched.draw()
    shown = session._stage.frame.avatars[0].mesh.read().copy()
    for weight, changes in ((0.25, True), (0.25, False), (1.0, True)):
        session.weights["jawOpen"] = weight
        watched.draw()
        now = session._stage.frame.avatars[0].mesh.read().copy()
        assert session.expressions == own | {"jawOpen": weight}
        assert (now != shown).any() == changes
        shown = now
    session.weights.clear()
    watched.draw()
    assert session.expressions == own
