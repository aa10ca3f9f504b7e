"""Levels of detail in C# are those of Python, and chosen alike."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from csharp import PROGRAMS, ROOT, RUNTIME, CSharp
from synthetic_avatar import empty_avatar, sparse_avatar, synthetic_avatar

from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.asset.tensors import Storage
from mua.asset.write import write
from mua.coarser import coarsest, texel_length

CASES = json.loads((ROOT / "tests" / "golden" / "level_choice.json").read_text())
TYPES = {"texels": "<i4", "triangles": "<i4", "barycentrics": "<f4", "geometry": "<f4", "appearance": "<f4"}
TYPES["one_sided"] = "?"
ROUNDING = 4 * np.finfo(np.float32).eps  # of means, in double precision, of numbers up to ten


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> Path:
    file = csharp.build([RUNTIME / "Format"], library=True)
    sources = [RUNTIME / "DetailLevel.cs", RUNTIME / "LevelChoice.cs", PROGRAMS / "LevelProgram.cs"]
    return csharp.build(sources, references=[file])


@pytest.mark.parametrize("storage", ["f32", "f16", "i8"])
@pytest.mark.parametrize("seed", [0, 1])
def test_levels_are_those_of_python(csharp: CSharp, program: Path, tmp_path: Path, seed: int, storage: Storage) -> None:
    assert_levels_alike(csharp, program, tmp_path / "a.muaavatar", sparse_avatar(seed), storage)


def test_rotations_of_either_sign_are_kept_apart_as_in_python(csharp: CSharp, program: Path, tmp_path: Path) -> None:
    avatar = sparse_avatar(0)
    static = avatar.geometry.static.copy()
    signs = np.random.default_rng(2).choice([-1, 1], static.shape[1])
    static[3:7] = 0.9 * signs + 0.1 * static[3:7]
    turned = replace(avatar, geometry=replace(avatar.geometry, static=static))
    assert_levels_alike(csharp, program, tmp_path / "a.muaavatar", turned, "f32")


def test_levels_without_texels_are_those_of_python(csharp: CSharp, program: Path, tmp_path: Path) -> None:
    assert_levels_alike(csharp, program, tmp_path / "a.muaavatar", empty_avatar(), "f32")


@pytest.mark.parametrize("taps", [32, 34])
def test_a_wavelet_of_many_taps_has_no_levels(csharp: CSharp, program: Path, tmp_path: Path, taps: int) -> None:
    avatar = synthetic_avatar()
    filters = {name: np.pad(getattr(avatar.wavelet, name), (taps - 10) // 2) for name in ("rec_lo", "rec_hi")}
    long = replace(avatar, wavelet=replace(avatar.wavelet, **filters))
    assert_levels_alike(csharp, program, tmp_path / "a.muaavatar", long, "f32")


def assert_levels_alike(csharp: CSharp, program: Path, path: Path, avatar: Avatar, storage: Storage) -> None:
    write(path, avatar, storage=storage)
    avatar = read(path)
    said = iter(csharp.run(program, path).splitlines())
    assert float(next(said).split()[1]) == pytest.approx(texel_length(avatar), rel=1e-12)
    for number in range(coarsest(avatar) + 1):
        level = avatar.at_level(number)
        texels = level.rig.texels
        expected = {
            "texels": texels.texels,
            "triangles": texels.triangles,
            "barycentrics": texels.barycentrics[:, :2],
            "geometry": level.geometry.static,
            "appearance": level.appearance.static,
            "one_sided": np.zeros(len(texels.texels), bool) if texels.one_sided is None else texels.one_sided,
        }
        assert next(said).split() == ["level", str(number), str(texels.size), str(len(texels.texels))]
        for name, values in expected.items():
            word, _, found = next(said).partition(" ")
            assert word == name
            numbers = np.frombuffer(bytes.fromhex(found), TYPES[name]).reshape(values.shape)
            np.testing.assert_allclose(numbers, values, rtol=ROUNDING, atol=ROUNDING, err_msg=f"{number} {name}")
    assert list(said) == []


def test_the_table_that_both_players_choose_by(csharp: CSharp, program: Path, tmp_path: Path) -> None:
    lines = tmp_path / "cases.txt"
    lines.write_text("".join(line_of(case) + "\n" for case in CASES))
    said = [[int(level) for level in line.split()[1:]] for line in csharp.run(program, "choose", lines).splitlines()]
    assert dict(zip([case["name"] for case in CASES], said, strict=True)) == {c["name"]: c["levels"] for c in CASES}


def line_of(case: dict) -> str:  # type: ignore[type-arg]
    """As LevelProgram reads it."""
    numbers = [-1 if case["budget"] is None else case["budget"]]
    for avatar in case["avatars"]:
        counts = avatar["counts"]
        numbers += [avatar["distance"], avatar["texel"], avatar["shown"], len(counts), *counts]
    return " ".join(map(str, numbers))
