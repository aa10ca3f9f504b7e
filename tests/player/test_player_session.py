"""The session of the window: its camera, its frame while paused, and the chosen clip and file."""

import re
from dataclasses import replace
from pathlib import Path
from time import monotonic
from typing import Any

import numpy as np
import pytest
import wgpu
from synthetic_avatar import synthetic_avatar, with_expressions
from vmc_senders import Program, bundle

from mua import rotation
from mua.asset import write
from mua.asset.read import read
from mua.cli.view_options import Asked, look_of
from mua.errors import InputError
from mua.gpu import Device
from mua.live.live_pose import EASING
from mua.live.receiver import Address, Receiver
from mua.player.focus import find_focus
from mua.player.played_files import Source
from mua.player.session import Session
from mua.pose.components import read_components
from mua.pose.descriptor import describe_window


def session(device: Device, source: Source, **options: Any) -> Session:
    return Session(device, source, look_of(Asked(**options), None), color_format="rgba8unorm")


def test_opens_with_the_camera_asked_for(device: Device, avatar_files: tuple[Path, ...]) -> None:
    plain, chosen = (
        session(device, Source(avatar_files), **options)._framed((400, 300))
        for options in ({}, {"azimuth": 30.0, "elevation": 20.0, "zoom": 2.5})
    )
    assert chosen.azimuth - plain.azimuth == pytest.approx(np.radians(30))
    assert chosen.elevation == pytest.approx(np.radians(20))
    assert chosen.framed / chosen.distance == pytest.approx(2.5)
    assert session(device, Source(avatar_files), stereo=True, follow=False).stereo
    assert not session(device, Source(avatar_files), stereo=True, follow=False).follow


def test_goes_round_while_it_plays(device: Device, avatar_files: tuple[Path, ...]) -> None:
    turning = session(device, Source(avatar_files), orbit=90.0)
    turning.view = turning._framed((400, 300))
    before = turning.view.azimuth
    turning.advance(0.5)
    assert turning.view.azimuth - before == pytest.approx(np.radians(45))
    turning.playing = False
    turning.advance(0.5)
    assert turning.view.azimuth - before == pytest.approx(np.radians(45))


def test_rests_at_the_frame_asked_for(device: Device, avatar_files: tuple[Path, ...]) -> None:
    resting = session(device, Source(avatar_files, frame=3))
    assert (resting.index, resting.playing) == (3, False)
    with pytest.raises(InputError, match="--frame is 7; clip 'wave' has frames 0 to 6"):
        session(device, Source(avatar_files, frame=7))


def test_says_how_far_outside_of_training_the_pose_is(device: Device, avatar_files: tuple[Path, ...]) -> None:
    resting, avatar = session(device, Source(avatar_files)), read(avatar_files[0])
    usage = wgpu.TextureUsage.RENDER_ATTACHMENT
    target = device.wgpu.create_texture(size=(32, 32, 1), format="rgba8unorm", usage=usage)
    found = []
    for index in (0, 3, 5):
        resting.step(index - resting.index)
        resting.draw(target)
        found.append(resting.outside)
        assert resting.outside == pytest.approx(avatar.decode(resting.clip, index).outside, abs=1e-6)
    assert len(set(found)) == 3


def test_keeps_what_it_looks_at_in_the_middle_from_outside(device: Device, avatar_files: tuple[Path, ...]) -> None:
    looking = session(device, Source(avatar_files), look_at="tip", zoom=50.0)
    (camera,) = looking._cameras((400, 300))
    low, high = looking._stage.bounds + looking._root()
    assert np.maximum(low - camera.position, camera.position - high).max() > -1e-6
    places = find_focus(looking._stage.rig, "tip").places(
        looking._stage.rig.skeleton, looking.clip.rotations, looking.clip.translations
    )
    for index in (0, 4):
        looking.step(index - looking.index)
        (camera,) = looking._cameras((400, 300))
        x, y, _, w = camera.projection @ camera.view @ np.append(places[index], 1)
        np.testing.assert_allclose([x / w, y / w], 0, atol=1e-9)
    with pytest.raises(InputError, match="--look-at is 'tail'"):
        session(device, Source(avatar_files), look_at="tail")


def test_another_clip_is_seen_from_the_same_side(device: Device, avatar_files: tuple[Path, ...]) -> None:
    watching = session(device, Source(avatar_files), azimuth=20.0)
    clip, root = watching.clip, watching._stage.rig.skeleton.root
    rotations = clip.rotations.copy()
    half_turn = np.array([0.0, 0, 1, 0])  # about the vertical
    rotations[:, root] = rotation.multiply(half_turn, rotations[:, root])
    watching._cameras((400, 300))
    assert watching.view is not None
    before = watching.view
    watching.choose_clip(replace(clip, rotations=rotations))
    turned = watching.view.azimuth - before.azimuth
    assert np.cos(turned) == pytest.approx(-1)
    np.testing.assert_allclose(watching.view.target, before.target * [-1, 1, -1], atol=1e-9)


def test_refuses_a_clip_that_is_not_there(device: Device, avatar_files: tuple[Path, ...]) -> None:
    with pytest.raises(InputError, match="--clip is 'run'"):
        Session(device, Source(avatar_files, clip="run"), look_of(Asked(), None), color_format="rgba8unorm")


def test_shows_the_level_asked_for_and_the_next_one_on_demand(device: Device, avatar_files: tuple[Path, ...]) -> None:
    playing = session(device, Source(avatar_files, frame=2), level="16")
    usage = wgpu.TextureUsage.RENDER_ATTACHMENT | wgpu.TextureUsage.COPY_SRC
    target = device.wgpu.create_texture(size=(64, 64, 1), format="rgba8unorm", usage=usage)
    shown = []
    for _ in range(5):
        playing.draw(target)
        shown.append(playing.level)
        playing.next_level()
    assert shown[0] == shown[4] == "16 texels"
    assert shown[1] == "8 texels"
    assert shown[2].startswith("auto level: ")
    assert shown[3] == "32 texels"


def test_the_detailed_geometry_is_of_the_finest_level(device: Device, avatar_files: tuple[Path, ...]) -> None:
    playing = session(device, Source(avatar_files, frame=2), level="8")
    target = device.wgpu.create_texture(
        size=(64, 64, 1), format="rgba8unorm", usage=wgpu.TextureUsage.RENDER_ATTACHMENT
    )
    playing.draw(target)
    coarse = playing.splats
    playing.toggle("geometry")
    playing.draw(target)
    assert playing.splats > 2 * coarse
    assert playing.level == "32 texels"


def test_a_level_that_is_not_there_is_a_note(device: Device, avatar_files: tuple[Path, ...]) -> None:
    assert "no level of 384 texels but 32, 16, 8" in " ".join(session(device, Source(avatar_files), level="384").notes)


TURNED = (
    ("/VMC/Ext/Bone/Pos", "Head", 0.0, 0.1, 0.0, 0.0, 0.6, 0.0, 0.8),
    ("/VMC/Ext/Blend/Val", "Joy", 0.5),
    ("/VMC/Ext/Blend/Apply",),
)
BONES_OF = {"root": "Hips", "tip": "Head"}


def test_shows_what_another_program_sends_with_its_window(device: Device, avatar_files: tuple[Path, ...]) -> None:
    avatar = read(avatar_files[0])
    with Receiver(Address(0)) as receiver, Program(receiver) as program:
        shown = session(device, Source(avatar_files, receiver=receiver, mapping=BONES_OF))
        usage = wgpu.TextureUsage.RENDER_ATTACHMENT
        target = device.wgpu.create_texture(size=(32, 32, 1), format="rgba8unorm", usage=usage)
        shown.draw(target)
        assert shown.live is not None
        at_ease = shown.outside
        program.send(bundle(*TURNED))
        shown.advance(0.0)
        for later in (EASING / 4, EASING / 2, 2 * EASING):
            shown.live.advance(monotonic() + later)
            shown.draw(target)
            window = describe_window(avatar.rig.skeleton, avatar.encoding, *shown.live.window())
            assert shown.outside == pytest.approx(read_components(avatar.components, window)[1], abs=1e-6)
        assert shown.outside != at_ease
        assert "ms from packet to picture" in receiver.figures
        moment = shown.live.moment
        shown.playing = False
        program.send(bundle(*TURNED))
        shown.advance(0.1)
        assert shown.live.moment == moment  # a pause holds the pose


def test_says_which_avatar_no_bone_moves(device: Device, avatar_files: tuple[Path, ...]) -> None:
    with Receiver(Address(0)) as receiver:
        with pytest.raises(
            InputError, match=f"^{re.escape(str(avatar_files[0]))}: no bone of VMC is known to move its left arm"
        ):
            session(device, Source(avatar_files, receiver=receiver))
        with pytest.raises(InputError, match="source joint 'Tail' does not exist; expected one of Root, Hips"):
            session(device, Source(avatar_files, receiver=receiver, mapping={"root": "Tail"}))


def test_an_avatar_without_clips_shows_what_another_program_sends(
    device: Device, avatar_files: tuple[Path, ...], tmp_path: Path
) -> None:
    bare = tmp_path / "bare.muaavatar"
    write(bare, replace(read(avatar_files[0]), clips=()))
    with Receiver(Address(0)) as receiver:
        shown = session(device, Source((bare, avatar_files[0]), receiver=receiver, mapping=BONES_OF))
        assert [clip.name for clip in shown.clips] == ["live"]
        shown.choose_file(avatar_files[0])
        assert (shown.failure, [clip.name for clip in shown.clips]) == ("", ["live", "wave"])
        assert shown.live is not None


def test_a_face_that_another_program_sends_is_that_of_the_avatar(device: Device, tmp_path: Path) -> None:
    """VRM's A opens a jaw as of ARKit; a slider of the panel goes before it."""
    write(tmp_path / "face.muaavatar", with_expressions(synthetic_avatar()))
    with Receiver(Address(0)) as receiver, Program(receiver) as program:
        shown = session(device, Source((tmp_path / "face.muaavatar",), receiver=receiver, mapping=BONES_OF))
        target = device.wgpu.create_texture(
            size=(32, 32, 1), format="rgba8unorm", usage=wgpu.TextureUsage.RENDER_ATTACHMENT
        )
        shown.draw(target)
        assert shown.live is not None
        program.send(bundle(("/VMC/Ext/Blend/Val", "A", 1.0), ("/VMC/Ext/Blend/Apply",)))
        frame = receiver.newest(monotonic())
        assert frame is not None
        for later in (0.0, 1.5 * EASING):
            shown.live.advance(frame.time + later)
        mesh = shown._stage.frame.avatars[0].mesh
        before = mesh.read().copy()
        shown.draw(target)
        assert shown.expressions["jawOpen"] == pytest.approx(0.7)
        assert shown.expressions["eyeBlinkLeft"] == 0
        assert (mesh.read() != before).any()
        shown.weights["jawOpen"] = 0.25
        assert shown.expressions["jawOpen"] == 0.25
