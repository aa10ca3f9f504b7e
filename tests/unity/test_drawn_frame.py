"""The package's draw of a frame, recorded by mono and replayed on Vulkan by the program of splat.shader itself.

Against the desktop player's draw of the same buffers, which is held to the CPU rasteriser by test_recorded_frame.py.
"""

import base64
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
import wgpu
from csharp import ROOT, CSharp
from drawn import DEPTH_FORMAT, GAMMA, Target, UnityPainter
from engine_shaders import Engine
from packed_splats import colors_of, opacities_of, unpacked
from recorded_frames import eye_lines
from replay import Drawn, replay, value
from synthetic_avatar import synthetic_avatar

from mua.arrays import Array
from mua.asset import write
from mua.avatar.camera import EYE_DISTANCE, Camera, orbit, stereo
from mua.avatar.decode import decode_clip_frame
from mua.gpu import Device
from mua.gpu.reflect import Constant
from mua.kernels.splat_project import pack_colors
from mua.player.draw import SortedSplats, SplatRenderer

if TYPE_CHECKING:
    from layers import LayeredDevice

SCREEN = (160, 200)
LEAST_PSNR = 80.0  # dB where splats are; matrices are rounded to float32 on another way
FRAME_AT = 3 / 24  # seconds into a clip of 24 Hz
MODES = ("indirect", "direct")
STEREO = ("multiview", "instanced")
LARGEST_PSNR_OF_OTHER = 40.0  # dB, of an eye against the other's image


@dataclass(frozen=True)
class Scene:
    """What mono recorded of one frame, for some eyes."""

    cameras: tuple[Camera, ...]
    drawn: dict[str, Drawn]  # by mode
    depths: Array  # [E, 2] nearest and farthest splat of each eye, metres


def eyes(bounds: Array, count: int) -> tuple[Camera, ...]:
    """The right one of two looks outwards, as where a headset's displays are canted."""
    camera = orbit(bounds, screen=SCREEN, azimuth=0.7, elevation=0.3)
    if count == 1:
        return (camera,)
    left, right = stereo(camera, EYE_DISTANCE)
    turn = np.eye(4)
    turn[:3, :3] = [[np.cos(0.05), 0, np.sin(0.05)], [0, 1, 0], [-np.sin(0.05), 0, np.cos(0.05)]]
    return left, replace(right, view=turn @ right.view)


def record(csharp: CSharp, program: Path, device: Device, folder: Path, *, count: int, instances: int) -> Scene:
    """The upper part of one avatar, seen close by `count` eyes after a frame in which all of it was seen."""
    avatar = synthetic_avatar(1)
    file, scenario = folder / "a.muaavatar", folder / "scenario.txt"
    write(file, avatar, storage="f32")
    centres = decode_clip_frame(avatar, avatar.clips[0], frame=round(FRAME_AT * 24), dtype=np.float64).centres
    box = np.stack([centres.min(axis=0), centres.max(axis=0)])
    upper = np.stack([box.mean(axis=0), (box[0] + 3 * box[1]) / 4])
    cameras = eyes(upper, count)
    lines = [f"decode 0 {FRAME_AT + 1e-3!r} 0 0 0 0 0 0 1 1"]
    lines += [*eye_lines(eyes(box, count), instances=instances), "sort all"]
    lines += [*eye_lines(cameras, instances=instances), "sort upper", *(f"draw {mode}" for mode in MODES), ""]
    scenario.write_text("\n".join(lines))
    csharp.run(program, ROOT / "ComputeShaders", folder / "recording", scenario, file)
    drawn = dict(zip(MODES, replay(device, folder / "recording").draws, strict=True))
    depths = [-(centres @ camera.view[2, :3] + camera.view[2, 3]) for camera in cameras]
    return Scene(cameras, drawn, np.array([[depth.min(), depth.max()] for depth in depths]))


@pytest.fixture(scope="module")
def mono(csharp: CSharp, frame_program: Path, device: Device, tmp_path_factory: pytest.TempPathFactory) -> Scene:
    return record(csharp, frame_program, device, tmp_path_factory.mktemp("mono"), count=1, instances=1)


@pytest.fixture(scope="module")
def both(csharp: CSharp, frame_program: Path, device: Device, tmp_path_factory: pytest.TempPathFactory) -> Scene:
    return record(csharp, frame_program, device, tmp_path_factory.mktemp("both"), count=2, instances=1)


@pytest.fixture(scope="module")
def instanced(csharp: CSharp, frame_program: Path, device: Device, tmp_path_factory: pytest.TempPathFactory) -> Scene:
    return record(csharp, frame_program, device, tmp_path_factory.mktemp("instanced"), count=2, instances=2)


@pytest.fixture(scope="module")
def two_eyes(both: Scene, instanced: Scene) -> dict[str, Scene]:
    return {"multiview": both, "instanced": instanced}


@pytest.fixture(scope="module")
def layered() -> "Iterator[LayeredDevice]":
    pytest.importorskip("vulkan", reason="needs PyPI's vulkan, which the development requirements bring")
    from layers import LayeredDevice

    with LayeredDevice() as device:
        yield device


@pytest.fixture
def painter(device: Device, tmp_path: Path) -> "Painter":
    return Painter(device, tmp_path, "splat.shader", SCREEN)


class Painter(UnityPainter):
    """Draws scenes as the desktop player does, too."""

    def player(
        self, scene: Scene, *, splats: Array | None = None, plane: tuple[int, float] | None = None
    ) -> list[Array]:
        """[H, W, 4] of each eye; `plane`: an eye and the depth on the device over the left half of its image."""
        held = dict(scene.drawn["indirect"].buffers)
        held |= {} if splats is None else {"splats": splats}
        kept, order = (self.device.buffer(held[name], name=name) for name in ("splats", "order"))
        words = np.array([scene.drawn["indirect"].arguments[0], 1, 0, 0], np.uint32)
        arguments = self.device.buffer(words, name="arguments", indirect=True)
        sorted_splats = SortedSplats(kept, order, arguments, scene.drawn["indirect"].corners)
        renderer = SplatRenderer(self.device, self.format, depth_format=DEPTH_FORMAT)
        target = Target(self.device, self.format, (len(scene.cameras) * SCREEN[0], SCREEN[1]), 1.0, self.folder)
        half = None if plane is None else (plane[1], (plane[0] * SCREEN[0], 0, SCREEN[0] // 2, SCREEN[1]))

        def draw(render_pass: wgpu.GPURenderPassEncoder) -> None:
            renderer.draw(render_pass, sorted_splats, scene.cameras)

        return np.split(target.image(draw, half), len(scene.cameras), axis=1)


def psnr(found: Array, expected: Array) -> float:
    """Over the pixels that either covers, dB."""
    covered = (found[..., 3] > 0) | (expected[..., 3] > 0)
    return float(-10 * np.log10(max(np.mean(np.square(found - expected)[covered]), 1e-12)))


def agree(found: Array, expected: Array) -> None:
    assert psnr(found, expected) > LEAST_PSNR


def seen(image: Array) -> bool:
    """Whether an image would tell an upside-down one, or one shifted as between the eyes."""
    return bool(np.mean(image[..., 3] > 0.5) > 0.05)


@pytest.mark.parametrize("turned", [False, True], ids=["back buffer", "texture"])
@pytest.mark.parametrize("mode", MODES)
def test_one_eye_is_as_the_player_draws_it(painter: Painter, mono: Scene, mode: str, turned: bool) -> None:
    """Rows of a target that the engine turns upside down run from the lowest."""
    (expected,) = painter.player(mono)
    found = painter.unity(mono.drawn[mode], turned=turned)
    assert seen(expected)
    agree(found[::-1] if turned else found, expected)


def test_counts_of_draws(mono: Scene, instanced: Scene) -> None:
    """A direct draw covers all splats, also those out of sight; the engine doubles it for both eyes by instances."""
    for scene, instances in ((mono, 1), (instanced, 2)):
        indirect, direct = scene.drawn["indirect"], scene.drawn["direct"]
        assert (indirect.indirect, direct.indirect) == (True, False)
        assert indirect.arguments[1] == instances
        assert direct.arguments == (direct.corners * len(direct.buffers["splats"]) // 8, 1)
        assert 0 < indirect.arguments[0] < direct.arguments[0]


def both_layers(
    painter: Painter, device: "LayeredDevice", scene: Scene, stereo: str, engine: Engine | None, mode: str = "indirect"
) -> Array:
    """[2, H, W, 4] of one pass, compiled with stand-ins or as Unity does it."""
    import both_eyes

    drawn = both_eyes.led(scene.drawn[mode])
    program = painter.passes[drawn.pass_index]
    if engine is None:
        compiled = both_eyes.by_stand_in(program, stereo, drawn, painter.folder)
    else:
        compiled = both_eyes.by_engine(engine, program, stereo, drawn, painter.folder)
    return both_eyes.picture(device, compiled, drawn, stereo, SCREEN)


def agree_in_both(layers: Array, expected: list[Array]) -> None:
    """Each layer with its eye, and neither with the other's; `pytest -s` shows by how much."""
    found = [[psnr(layer, eye) for eye in expected] for layer in layers]
    print("\nlayers against eyes, dB:", *(f"{error:.1f}" for errors in found for error in errors))
    for layer in (0, 1):
        assert found[layer][layer] > LEAST_PSNR
        assert found[layer][1 - layer] < LARGEST_PSNR_OF_OTHER


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("stereo", STEREO)
def test_one_pass_draws_each_eye_into_its_layer(
    painter: Painter, layered: "LayeredDevice", two_eyes: dict[str, Scene], mode: str, stereo: str
) -> None:
    scene = two_eyes[stereo]
    agree_in_both(both_layers(painter, layered, scene, stereo, None, mode), painter.player(scene))


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("stereo", STEREO)
def test_one_pass_draws_each_eye_as_unity_compiles_it(
    painter: Painter, layered: "LayeredDevice", two_eyes: dict[str, Scene], engine: Engine, mode: str, stereo: str
) -> None:
    scene = two_eyes[stereo]
    agree_in_both(both_layers(painter, layered, scene, stereo, engine, mode), painter.player(scene))


def test_a_single_eye_is_drawn_into_both_layers(painter: Painter, layered: "LayeredDevice", mono: Scene) -> None:
    """Where a pipeline draws a camera without stereo by a pass with it."""
    (expected,) = painter.player(mono)
    for layer in both_layers(painter, layered, mono, "multiview", None):
        agree(layer, expected)


@pytest.mark.parametrize("eye", [0, 1])
def test_each_view_draws_its_eye_with_halves(painter: Painter, both: Scene, eye: int) -> None:
    found = painter.unity(both.drawn["indirect"], variant="mobile", replayed_view=eye)
    agree(found, painter.player(both)[eye])


@pytest.mark.parametrize("eye", [0, 1])
def test_each_pass_of_its_own_draws_its_eye(painter: Painter, both: Scene, eye: int) -> None:
    found = painter.unity(both.drawn["indirect"], unity_StereoEyeIndex=eye)
    agree(found, painter.player(both)[eye])


def test_matrices_point_up_with_the_depth_of_the_device(both: Scene) -> None:
    """Only target.hlsl turns rows: the surfaces are drawn by the same matrices."""
    matrices = Constant("view_projection", 0, "float", (2, 4, 4), (64, 4, 16), used=True)
    found = value("draw", matrices, *both.drawn["indirect"].constants["view_projection"])
    reversed_depth = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -0.5, 0.5], [0, 0, 0, 1]])
    for matrix, camera in zip(found, both.cameras, strict=True):
        np.testing.assert_allclose(matrix, reversed_depth @ camera.projection @ camera.view, rtol=1e-5, atol=1e-6)


def test_the_eyes_differ(painter: Painter, both: Scene) -> None:
    left, right = painter.player(both)
    with pytest.raises(AssertionError):
        agree(left, right)


@pytest.mark.parametrize("shift", [-2.0, 2.0], ids=["lower", "upper"])
def test_splats_beyond_either_end_of_the_depth_are_drawn_at_it(painter: Painter, mono: Scene, shift: float) -> None:
    """An avatar may reach beyond the planes of a camera."""
    drawn = mono.drawn["indirect"]
    found = painter.unity(shifted(drawn, shift))
    agree(found, painter.player(mono)[0])


def test_the_depth_of_opengl_reaches_lower(painter: Painter, mono: Scene) -> None:
    """To -1, which this device clips where it is left as it is."""
    drawn = shifted(mono.drawn["indirect"], -0.9)
    assert seen(painter.unity(drawn))
    assert not np.any(painter.unity(drawn, space=(*GAMMA, "SHADER_API_GLCORE")))


def shifted(drawn: Drawn, shift: float) -> Drawn:
    """The same draw with another depth of every splat, as shares of the device's."""
    kind, content = drawn.constants["view_projection"]
    matrices = np.frombuffer(base64.b64decode(content), np.float32).reshape(-1, 4, 4).transpose(0, 2, 1).copy()
    matrices[:, 2] += shift * matrices[:, 3]
    encoded = base64.b64encode(np.ascontiguousarray(matrices.transpose(0, 2, 1)).tobytes()).decode()
    return replace(drawn, constants={**drawn.constants, "view_projection": (kind, encoded)})


def places(scene: Scene, eye: int) -> Iterator[tuple[str, float]]:
    nearest, farthest = scene.depths[eye]
    yield "before", nearest - 0.1
    yield "within", (nearest + farthest) / 2
    yield "behind", farthest + 0.1


@pytest.mark.parametrize("eye", [0, 1])
def test_what_is_drawn_before_hides_the_splats_behind_it(painter: Painter, both: Scene, eye: int) -> None:
    """A plane across the left half; the player's depth is not reversed, so the two share no mistake of it."""
    free = painter.player(both)[eye]
    middle = SCREEN[0] // 2
    for place, depth in places(both, eye):
        row = both.cameras[eye].projection[2]
        device_depth = (row[3] - row[2] * depth) / depth  # -1 to 1, away from the eye
        expected = painter.player(both, plane=(eye, (1 + device_depth) / 2))[eye]
        for turned in (False, True):
            found = painter.unity(
                both.drawn["indirect"], plane=(1 - device_depth) / 2, turned=turned, unity_StereoEyeIndex=eye
            )
            agree(found[::-1] if turned else found, expected)
        assert np.array_equal(expected[:, middle:], free[:, middle:])
        assert np.array_equal(expected, free) == (place == "behind")
        assert np.any(expected[:, :middle]) == (place != "before")


def painted(words: Array, colors: Array) -> Array:
    """The same splats in other colours [N, 3]."""
    splats = unpacked(words).copy()
    splats["colors"] = pack_colors(colors[None], opacities_of(splats))
    return np.asarray(splats.view(np.uint32))


@pytest.mark.parametrize("brightness", [1.0, 0.12, 0.07])
def test_a_linear_project_is_given_light(painter: Painter, mono: Scene, brightness: float) -> None:
    """sRGB of each splat turned to light before it is blended, of dark ones too, which it is proportional to."""
    drawn = mono.drawn["indirect"]
    srgb = brightness * colors_of(unpacked(drawn.buffers["splats"]))[0]
    dark = painted(drawn.buffers["splats"], srgb)
    drawn = replace(drawn, buffers={**drawn.buffers, "splats": dark})
    srgb = colors_of(unpacked(dark))[0]
    light = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    (expected,) = painter.player(mono, splats=painted(dark, light / light.max()))
    expected[..., :3] *= light.max()
    found = painter.unity(drawn, space=())
    covered, channels = expected[..., 3] > 0, slice(3) if brightness < 1 else slice(4)
    # Half a step of the half floats that the expected colours are stored in.
    bound = 2.0**-9 * expected[covered][..., channels].max()
    assert np.abs(found - expected)[covered][..., channels].max() < bound
    with pytest.raises(AssertionError):
        agree(found, painter.player(mono)[0])
