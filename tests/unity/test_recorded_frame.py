"""The package's own frames, run by mono over stand-ins that record them and replayed on Vulkan, against decode()."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from csharp import ROOT, CSharp
from frame_bounds import (
    COLOR_BOUND,
    FEWER_THAN,
    FRAME_ORDER,
    LEAST_PSNR,
    OPACITY_BOUND,
    POSITION_BOUND,
    psnr,
)
from frame_errors import exact_colors, exact_depths
from golden_sorting import BLOCK
from joined_splats import joined, moved
from packed_splats import colors_of, opacities_of, unpacked
from recorded_frames import eye_lines, place_of
from replay import Replayed, replay
from splat_rounding import exact_keys
from synthetic_avatar import synthetic_avatar, with_random_poses, with_texels
from training import outside_of_training

from mua import rotation
from mua.arrays import Array
from mua.asset import read, write
from mua.asset.avatar import Avatar
from mua.asset.tensors import Storage
from mua.avatar.camera import EYE_DISTANCE, Camera, orbit, stereo
from mua.avatar.decode import Splats, decode_clip_frame
from mua.avatar.level_choice import splat_corners
from mua.avatar.rendering import render_premultiplied
from mua.gpu import Device
from mua.kernels.splat_project import HIDDEN, LAST_KEY
from mua.player.draw import SortedSplats, SplatRenderer, draw_image, image_format
from mua.rig.bounds import root_positions

POSES = 12
VISIBLE_WORD = 4  # its place in `arguments`
PLACES = (  # Unity's position, then rotation (x, y, z, w), then size
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0),
    (0.35, 0.1, -0.2, 0.1, 0.5, -0.1, 0.85446, 1.7),
    (-0.4, 0.0, 0.3, 0.0, -0.9, 0.2, 0.38730, 0.4),
)


@dataclass(frozen=True)
class Shot:
    """One frame of a scenario: what each avatar shows, and where."""

    label: str
    seconds: tuple[float, ...]
    frames: tuple[int, ...]  # the frames of the clip that these seconds mean
    eyes: int
    levels: tuple[int, ...] = (0, 0, 0)  # levels of detail


FIRST = Shot("first", (0.0, 0.0, 0.0), (0, 0, 0), 1)
LATER = Shot("later", (3.2 / 24, 6.2 / 24, 2.2 / 24), (3, 6, 2), 2)
COARSER = Shot("coarser", (1.2 / 24, 4.2 / 24, 6.2 / 24), (1, 4, 6), 2, (1, 0, 2))
COARSEST = Shot("coarsest", (2.2 / 24, 5.2 / 24, 3.2 / 24), (2, 5, 3), 1, (2, 1, 1))
WRAPPED = Shot("wrapped", (7.2 / 24, 12.2 / 24, 70.2 / 24), (0, 5, 0), 1)  # clips of 7 frames at 24 Hz
SHOTS = (FIRST, LATER, COARSER, COARSEST, WRAPPED)


def standing(splats: Splats, numbers: tuple[float, ...]) -> Splats:
    """A posed avatar in a place of PLACES, as large as it says: the reference of a scaled avatar."""
    size = float(np.float32(numbers[-1]))
    larger = replace(splats, mesh=size * splats.mesh, centres=size * splats.centres, bounds=size * splats.bounds)
    return moved(replace(larger, scales=size * splats.scales), place_of(numbers))


class Recorded:
    """A scenario, played by the package and replayed; and its reference."""

    def __init__(
        self, csharp: CSharp, frame_program: Path, device: Device, folder: Path, avatars: list[Avatar], storage: Storage
    ) -> None:
        files = [folder / f"{index}.muaavatar" for index in range(len(avatars))]
        for file, avatar in zip(files, avatars, strict=True):
            write(file, avatar, storage=storage)
        self.avatars = [read(file) for file in files]
        self.exact = {shot.label: self._exact(shot) for shot in SHOTS}
        self.cameras = {shot.label: self._cameras(shot) for shot in SHOTS}
        scenario = folder / "scenario.txt"
        scenario.write_text("".join(self._lines(shot) for shot in SHOTS) + "again 200\n")
        printed = csharp.run(frame_program, ROOT / "ComputeShaders", folder / "recording", scenario, *files)
        self.printed = [line.split() for line in printed.splitlines()]
        self.replayed: Replayed = replay(device, folder / "recording")

    def _exact(self, shot: Shot) -> Splats:
        return joined(
            [
                standing(decode_clip_frame(avatar, avatar.clips[0], frame=frame, dtype=np.float64), place)
                for avatar, frame, place in zip(self.shown(shot), shot.frames, PLACES, strict=False)
            ]
        )

    def shown(self, shot: Shot) -> list[Avatar]:
        """The avatars at the levels of a shot."""
        return [avatar.at_level(level) for avatar, level in zip(self.avatars, shot.levels, strict=False)]

    def slots(self, shot: Shot) -> Array:
        """Where the splats of all avatars lie [N]; each begins at an even place."""
        counts = [len(avatar.rig.texels.texels) for avatar in self.shown(shot)]
        firsts = np.cumsum([0, *(count + count % 2 for count in counts)])
        return np.concatenate([first + np.arange(count) for first, count in zip(firsts, counts, strict=False)])

    def _cameras(self, shot: Shot) -> tuple[Camera, ...]:
        centres = self.exact[shot.label].centres
        camera = orbit(
            np.stack([centres.min(axis=0), centres.max(axis=0)]), screen=(256, 192), azimuth=0.7, elevation=0.3
        )
        return (camera,) if shot.eyes == 1 else stereo(camera, EYE_DISTANCE)

    def _lines(self, shot: Shot) -> str:
        lines = eye_lines(self.cameras[shot.label])
        for index, (seconds, place, level) in enumerate(zip(shot.seconds, PLACES, shot.levels, strict=True)):
            if index < len(self.avatars):
                lines.append(f"decode {index} {seconds!r} " + " ".join(map(repr, (*place, level))))
        return "\n".join([*lines, f"sort {shot.label}\n"])

    def bounds(self, shot: Shot) -> Array:
        """The box [2, 3] around the boxes of all avatars, each turned and moved with its avatar, metres."""
        corners = []
        for avatar, frame, place in zip(self.avatars, shot.frames, PLACES, strict=False):
            box = place[-1] * (avatar.bounds + root_positions(avatar.rig, avatar.clips[0])[frame])
            corners.append(rotation.dual_transform(place_of(place), np.stack(np.meshgrid(*box.T)).reshape(3, -1).T))
        return np.stack([np.min(corners, axis=(0, 1)), np.max(corners, axis=(0, 1))])

    def kept(self, shot: Shot, name: str) -> Array:
        return self.replayed.kept[f"{shot.label} {name}"]


@pytest.fixture(scope="module", params=[(1, "f32"), (1, "f16"), (1, "i8"), (3, "f32")], ids=str)
def recorded(
    request: pytest.FixtureRequest,
    csharp: CSharp,
    frame_program: Path,
    device: Device,
    tmp_path_factory: pytest.TempPathFactory,
) -> Recorded:
    count, storage = request.param
    avatars = [
        synthetic_avatar(1),
        with_texels(synthetic_avatar(2, wavelet="bior3.1"), slice(0, 301)),  # whose filter of 4 taps has an odd delay
        with_texels(synthetic_avatar(3, levels=5), slice(100, 457)),  # whose lowest plane is a single sample
    ]
    return Recorded(csharp, frame_program, device, tmp_path_factory.mktemp("recorded"), avatars[:count], storage)


@pytest.mark.parametrize("shot", SHOTS, ids=lambda shot: shot.label)
def test_splats_are_those_of_the_reference(recorded: Recorded, shot: Shot) -> None:
    exact, splats = recorded.exact[shot.label], unpacked(recorded.kept(shot, "splats"))[recorded.slots(shot)]
    assert np.abs(splats["centre"] - exact.centres).max() < POSITION_BOUND
    assert np.abs(opacities_of(splats) - exact.opacities).max() < OPACITY_BOUND
    assert np.abs(colors_of(splats) - exact_colors(exact, recorded.cameras[shot.label])).max() < COLOR_BOUND


@pytest.mark.parametrize("shot", SHOTS, ids=lambda shot: shot.label)
def test_the_order_is_from_back_to_front_through_all_avatars(recorded: Recorded, shot: Shot) -> None:
    """That of the keys over the box around all; splats of equal keys stay in the order of avatars and texels."""
    exact, views = recorded.exact[shot.label], np.stack([camera.view for camera in recorded.cameras[shot.label]])
    count = int(recorded.kept(shot, "arguments")[VISIBLE_WORD])
    slots = recorded.kept(shot, "order")[:count]
    keys = recorded.kept(shot, "keys").view(np.uint16)[slots].astype(int)
    lie = recorded.slots(shot)
    order = np.searchsorted(lie, slots)
    np.testing.assert_array_equal(lie[order], slots)
    bounds = recorded.bounds(shot)
    expected, rounding = exact_keys(exact.centres[order], views, bounds)
    span = np.ptp(exact_depths(bounds, recorded.cameras[shot.label]))
    np.testing.assert_array_equal(np.sort(order), np.arange(len(exact.centres)))
    assert np.abs(keys - expected).max() <= 0.5 + rounding + LAST_KEY * POSITION_BOUND * np.sqrt(3) / span
    assert np.all(np.diff(keys) >= 0)
    assert np.all(np.diff(order.astype(int))[np.diff(keys) == 0] > 0)


def test_a_crowd_of_more_splats_than_a_group_sorts_is_in_order_too(
    csharp: CSharp, frame_program: Path, device: Device, tmp_path: Path
) -> None:
    avatar, lines = synthetic_avatar(1), []
    texels = len(avatar.rig.texels.texels)
    count = 2 * BLOCK // texels + 1
    files = [tmp_path / f"{index}.muaavatar" for index in range(count)]
    for index, file in enumerate(files):
        write(file, avatar, storage="f16")
        place = (0.1 * (index % 3), 0.0, 0.15 * index, 0.0, 0.0, 0.0, 1.0, 1.0)
        lines.append(f"decode {index} {0.1 * index!r} " + " ".join(map(repr, (*place, 0))))
    camera = orbit(np.array([[-1, -1, -3], [1, 2, 1]]), screen=(64, 48), azimuth=0.7, elevation=0.3)
    scenario = tmp_path / "scenario.txt"
    scenario.write_text("\n".join([*eye_lines([camera]), *lines, "sort crowd\n"]))
    csharp.run(frame_program, ROOT / "ComputeShaders", tmp_path / "recording", scenario, *files)
    kept = replay(device, tmp_path / "recording").kept
    keys = kept["crowd keys"].view(np.uint16)
    visible = np.flatnonzero(keys != HIDDEN)
    assert 2 * BLOCK < len(visible) == kept["crowd arguments"][VISIBLE_WORD]
    np.testing.assert_array_equal(
        kept["crowd order"][: len(visible)], visible[np.argsort(keys[visible], kind="stable")]
    )


def test_splats_are_triangles_from_where_the_desktop_player_draws_them_so(
    csharp: CSharp, frame_program: Path, device: Device, tmp_path: Path
) -> None:
    """On both sides of the distance from which on they are."""
    file = tmp_path / "a.muaavatar"
    write(file, synthetic_avatar(1), storage="f16")
    avatar = read(file)
    box = avatar.bounds + root_positions(avatar.rig, avatar.clips[0])[0]
    near = orbit(box, screen=(64, 48))

    def away(factor: float) -> Camera:
        view = near.view.copy()
        view[:3, 3] += (factor - 1) * (view[:3, :3] @ box.mean(axis=0) + view[:3, 3])
        return replace(near, view=view)

    count = len(avatar.rig.texels.texels)
    low, high = 0.01, 100.0
    while high / low > 1.001:
        middle = (low * high) ** 0.5
        low, high = (low, middle) if splat_corners([box], count + count % 2, [away(middle)]) == 3 else (middle, high)
    lines = [f"decode 0 0.0 {' '.join(map(repr, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0)))} 0"]
    for label, factor in (("near", 0.99 * low), ("far", 1.01 * high)):
        lines += [*eye_lines([away(factor)]), f"sort {label}"]
    scenario = tmp_path / "scenario.txt"
    scenario.write_text("\n".join([*lines, ""]))
    csharp.run(frame_program, ROOT / "ComputeShaders", tmp_path / "recording", scenario, file)
    kept = replay(device, tmp_path / "recording").kept
    for label, corners in (("near", 6), ("far", 3)):
        words = kept[f"{label} arguments"]
        assert words[0] == corners * words[VISIBLE_WORD] > 0


def test_poses_of_all_kinds_are_those_of_the_reference(
    csharp: CSharp, frame_program: Path, device: Device, tmp_path: Path
) -> None:
    """Random angles of all joints, of an avatar that was trained on hardly any motion: far outside of it."""
    file = tmp_path / "wild.muaavatar"
    write(file, with_random_poses(synthetic_avatar(1), POSES), storage="f32")
    avatar = read(file)
    assert min(outside_of_training(file, frame) for frame in range(POSES)) > 0.5
    exact = [decode_clip_frame(avatar, avatar.clips[0], frame=frame, dtype=np.float64) for frame in range(POSES)]
    spans = [np.stack([splats.centres.min(axis=0), splats.centres.max(axis=0)]) for splats in exact]
    camera = orbit(np.stack([np.min(spans, axis=(0, 1)), np.max(spans, axis=(0, 1))]), screen=(64, 48))
    lines = eye_lines([camera])
    for frame in range(POSES):
        place = " ".join(map(repr, (*PLACES[0], 0)))
        lines += [f"decode 0 {(frame + 0.2) / 24!r} {place}", f"sort {frame}"]
    scenario = tmp_path / "scenario.txt"
    scenario.write_text("\n".join([*lines, ""]))
    csharp.run(frame_program, ROOT / "ComputeShaders", tmp_path / "recording", scenario, file)
    kept = replay(device, tmp_path / "recording").kept
    for frame, splats in enumerate(exact):
        found = unpacked(kept[f"{frame} splats"])[: len(splats)]
        assert np.abs(found["centre"] - splats.centres).max() < POSITION_BOUND
        seen = (found["deviations"] if "deviations" in (found.dtype.names or ()) else found["minors"]).max(axis=1) > 0
        assert np.abs(opacities_of(found) - splats.opacities)[seen].max() < OPACITY_BOUND


@pytest.mark.parametrize("shot", SHOTS, ids=lambda shot: shot.label)
def test_the_picture_agrees_with_the_cpu_rasteriser(recorded: Recorded, device: Device, shot: Shot) -> None:
    """By the desktop player's draw of what the package's frame left: splat_draw.hlsl is the same file."""
    kept, order = (device.buffer(recorded.kept(shot, name), name=name) for name in ("splats", "order"))
    words = recorded.kept(shot, "arguments")
    arguments = device.buffer(words, name="arguments", indirect=True)
    splats, cameras = SortedSplats(kept, order, arguments, int(words[0] // words[4])), recorded.cameras
    image = draw_image(device, SplatRenderer(device, image_format(device)), splats, cameras[shot.label])
    for found, camera in zip(np.split(image, shot.eyes, axis=1), cameras[shot.label], strict=True):
        assert psnr(found, render_premultiplied(recorded.exact[shot.label], camera)) > LEAST_PSNR


def test_the_dispatches_are_those_of_the_desktop_player(recorded: Recorded) -> None:
    decoded = FRAME_ORDER[: FRAME_ORDER.index("SplatProject")]
    count = len(recorded.avatars)
    frame = [*decoded * count, *["SplatProject"] * count, *FRAME_ORDER[len(decoded) + 1 :]]
    assert recorded.replayed.kernels == frame * len(SHOTS)
    assert len(FRAME_ORDER) < FEWER_THAN


def test_frames_allocate_nothing_and_leave_nothing_behind(recorded: Recorded) -> None:
    printed = {words[0]: words[1:] for words in recorded.printed}
    assert printed["made"] == ["0"]
    assert printed["alive"] == ["0"]
    assert printed["allocated"] == ["0"]
