"""The shaders for browsers do what the desktop's do, on the golden cases and in images of all that is shown."""

from dataclasses import replace
from pathlib import Path

import pytest
import translated
from check_shaders import entry_points
from frame_bounds import psnr
from golden import Golden, read_golden, replay
from golden_bounds import assert_met
from synthetic_avatar import synthetic_avatar, with_surface
from wgsl_compile import Shader

from mua.arrays import Array
from mua.asset import write
from mua.avatar.camera import Camera, orbit
from mua.gpu import Device
from mua.gpu.compile import spirv
from mua.gpu.reflect import Constant, reflect
from mua.player.buffers import AvatarBuffers
from mua.player.offscreen import Offscreen
from mua.player.toggles import Toggles

ALL = read_golden()
ENTRIES = entry_points()
MOST_BUFFERS = 10  # that one stage may bind in the least browser
LEAST_PSNR = 60.0  # dB; splats of nearly one depth may change places
SHOWN = {
    "splats": Toggles(),
    "all": Toggles(geometry=True, template=True, skeleton=True, shadow=True),
}


def kernel_shader(golden: Golden) -> Shader:
    return translated.SHADERS[Path(golden.kernel).stem, golden.case["entry"]]


@pytest.mark.parametrize("golden", ALL, ids=str)
def test_wgsl_meets_the_golden_case(device: Device, golden: Golden) -> None:
    assert_met(golden, replay(device, golden, translated.kernel_of(device, kernel_shader(golden))))


@pytest.mark.parametrize(("path", "entry", "stage"), ENTRIES, ids=[entry for _, entry, _ in ENTRIES])
def test_wgsl_binds_what_spirv_binds(path: Path, entry: str, stage: str) -> None:
    ours, theirs = translated.SHADERS[path.stem, entry].interface, reflect(spirv(path, entry, stage=stage))
    assert ours.threads == theirs.threads
    assert {(b.name, b.scalar, b.stride) for b in ours.buffers} == {
        (b.name, b.scalar, b.stride) for b in theirs.buffers
    }
    assert len(ours.buffers) <= MOST_BUFFERS
    assert {constant.name: constant for constant in ours.constants if constant.used} == {
        constant.name: constant for constant in theirs.constants if constant.used
    }


@pytest.mark.parametrize("shown", SHOWN)
def test_pictures_by_wgsl_are_those_by_spirv(device: Device, tmp_path: Path, shown: str) -> None:
    avatar = with_surface(synthetic_avatar())
    write(tmp_path / "a.muaavatar", avatar)
    camera = orbit(avatar.bounds, screen=(96, 128), azimuth=0.3)
    pictures = [picture(device, tmp_path / "a.muaavatar", camera, SHOWN[shown])]
    with pytest.MonkeyPatch.context() as patch:
        translated.use(patch)
        pictures.append(picture(device, tmp_path / "a.muaavatar", camera, SHOWN[shown]))
    assert pictures[0][..., 3].max() > 0.5
    assert psnr(*pictures) > LEAST_PSNR


def picture(device: Device, file: Path, camera: Camera, toggles: Toggles) -> Array:
    buffers = AvatarBuffers(device, file)
    return Offscreen(device, buffers, buffers.avatar.clips[0], toggles).picture(1, [camera])


def transposed(constant: Constant) -> Constant:
    return replace(constant, strides=(*constant.strides[:-2], *constant.strides[:-3:-1]))


def moved(constant: Constant) -> Constant:
    """Where it would lie if a vector of three took the room of three numbers and no more."""
    return replace(constant, offset=constant.offset - 4) if constant.offset else constant


# A fault of the translation each: stem and entry of the kernel in which it is put, what becomes of its code or names
FAULTS = {
    "matrices row by row": ("splat_project", "SplatProject", transposed),
    "constants packed tightly": ("mlp_matmul", "MlpMatmul", moved),
    "half floats read as whole numbers": ("mlp_matmul", "MlpMatmul", ("unpack2x16float", "unpack2x16snorm")),
    "half floats not packed": ("inverse_dwt", "UpsampleTexels", ("pack2x16float", "pack2x16snorm")),
    "bytes without their sign": ("blend_subbands", "BlendLl", ("i32(a<<", "i32(a>>")),
    "a counter that adds nothing": ("splat_sort", "CountDigits", (",1u);", ",0u);")),
    "a counter that is not cleared": ("splat_sort", "CountDigits", ("atomicStore(", "atomicAdd(")),
    "another size of group": ("splat_sort", "ScanDigits", ("@workgroup_size(256,", "@workgroup_size(128,")),
}  # fmt: skip


def spoiled(shader: Shader, change: object) -> Shader:
    if isinstance(change, tuple):
        assert change[0] in shader.code, f"stale: {change[0]}"
        return replace(shader, code=shader.code.replace(*change))
    constants = tuple(change(constant) for constant in shader.interface.constants)  # type: ignore[operator]
    return replace(shader, interface=replace(shader.interface, constants=constants))


@pytest.mark.filterwarnings("ignore:invalid value")  # where a fault leaves what is no number
@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_of_the_translation_is_caught(device: Device, fault: str) -> None:
    stem, entry, change = FAULTS[fault]
    shader = spoiled(translated.SHADERS[stem, entry], change)
    cases = [golden for golden in ALL if golden.case["entry"] == entry]
    caught = 0
    for golden in cases:
        try:
            assert_met(golden, replay(device, golden, translated.kernel_of(device, shader)))
        except AssertionError:
            caught += 1
    assert caught
