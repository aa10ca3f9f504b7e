"""The golden files hold every entry point, are what the reference makes, and are met by the shaders on a device."""

import gen_golden
import pytest
from check_shaders import kernel_shaders
from golden import Golden, read_golden, replay, words_of
from golden_bounds import assert_met

from mua.gpu import Device

ALL = read_golden()
MOST_BYTES = 1 << 20  # all files together, so that a headset can hold them
WRONG = 0x42F6E979  # 123.456 as a float, 3.48 and -2802 as halves


@pytest.mark.parametrize("golden", ALL, ids=str)
def test_shader_meets_the_golden_case(device: Device, golden: Golden) -> None:
    assert_met(golden, replay(device, golden))


def test_every_entry_point_has_a_case() -> None:
    entries = {(shader.path.name, entry) for shader in kernel_shaders() for entry in shader.kernels}
    assert {(golden.kernel, golden.case["entry"]) for golden in ALL} == entries


def test_every_word_that_a_kernel_writes_is_expected() -> None:
    shaders = {shader.path.name: shader for shader in kernel_shaders()}
    assert ALL
    for golden in ALL:
        words = dict.fromkeys((buffer["name"] for buffer in golden.case["buffers"]), 0)
        for described in golden.case["expected"]:
            words[described["buffer"]] += described["count"] // (2 if described["kind"] == "half" else 1)
        for buffer in golden.case["buffers"]:
            written = shaders[golden.kernel].accesses(golden.case["entry"], buffer["name"])[1]
            whole = buffer["count"] * words_of(buffer["element"])
            assert words[buffer["name"]] == (whole if written else 0), f"{golden}: {buffer['name']}"


def test_the_reference_still_makes_the_files() -> None:
    made = gen_golden.generate()
    assert {path for path in gen_golden.GOLDEN.iterdir() if path.name != "README.md"} == set(made)
    for path, content in made.items():
        assert path.read_bytes() == content, f"{path.name}: run tools/gen_golden.py"


def test_a_wrong_value_is_noticed(device: Device) -> None:
    for golden in ALL:
        found = replay(device, golden)
        described = golden.case["expected"][0]
        found[described["buffer"]] = found[described["buffer"]].copy()
        found[described["buffer"]][described["first"]] = WRONG
        with pytest.raises(AssertionError, match="beyond the bound"):
            assert_met(golden, found)


def test_files_are_small() -> None:
    assert sum(path.stat().st_size for path in gen_golden.GOLDEN.iterdir()) < MOST_BYTES
