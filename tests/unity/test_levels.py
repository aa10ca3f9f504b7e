"""Levels of detail in C# are those of Python, and chosen alike."""

import json
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from csharp import PROGRAMS, ROOT, CSharp
from synthetic_avatar import empty_avatar, sparse_avatar, synthetic_avatar, with_expressions

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.asset.tensors import Storage
from mua.asset.write import write
from mua.avatar.coarser import coarsest, texel_length
from mua.kernels.expressions import by_vertex, pack_entries, reach_of
from mua.kernels.inverse_dwt import texel_tiles, upsampling_taps
from mua.kernels.splat_project import pack_texels
from mua.player.buffers import NO_EXPRESSIONS

CASES = json.loads((ROOT / "tests" / "golden" / "level_choice.json").read_text())
TYPES = {"texels": "<i4", "triangles": "<i4", "barycentrics": "<f4", "geometry": "<f4", "appearance": "<f4"}
TYPES["one_sided"] = "?"


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> Path:
    return csharp.runtime(PROGRAMS / "LevelProgram.cs")


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


def test_what_expressions_reach_is_that_of_python(csharp: CSharp, program: Path, tmp_path: Path) -> None:
    for avatar in (sparse_avatar(3), empty_avatar()):
        assert_levels_alike(csharp, program, tmp_path / "a.muaavatar", with_expressions(avatar), "f32")


def test_levels_without_texels_are_those_of_python(csharp: CSharp, program: Path, tmp_path: Path) -> None:
    assert_levels_alike(csharp, program, tmp_path / "a.muaavatar", empty_avatar(), "f32")


@pytest.mark.parametrize("taps", [32, 34])
def test_a_wavelet_of_many_taps_has_no_levels(csharp: CSharp, program: Path, tmp_path: Path, taps: int) -> None:
    avatar = synthetic_avatar()
    filters: dict[str, Any] = {
        name: np.pad(getattr(avatar.wavelet, name), (taps - 10) // 2) for name in ("rec_lo", "rec_hi")
    }
    long = replace(avatar, wavelet=replace(avatar.wavelet, **filters))
    assert_levels_alike(csharp, program, tmp_path / "a.muaavatar", long, "f32")


def assert_levels_alike(csharp: CSharp, program: Path, path: Path, avatar: Avatar, storage: Storage) -> None:
    write(path, avatar, storage=storage)
    avatar = read(path)
    printed = iter(csharp.run(program, path).splitlines())
    assert float(next(printed).split()[1]) == pytest.approx(texel_length(avatar), rel=1e-12)
    held = avatar.rig.expressions or NO_EXPRESSIONS
    targets = by_vertex(held.starts, held.vertices, held.changes)
    for values in (targets.vertices, targets.starts, *pack_entries(targets)):
        assert_uploaded(printed, values)
    reach = partial(reach_of, targets.vertices, avatar.rig.mesh.faces)
    about = reach(avatar.rig.texels.triangles)
    for values in (about.corners, about.vertices, about.starts, about.stars):
        assert_uploaded(printed, values)
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
        assert next(printed).split() == ["level", str(number), str(texels.size), str(len(texels.texels))]
        for name, values in expected.items():
            word, _, found = next(printed).partition(" ")
            assert word == name
            numbers = np.frombuffer(bytes.fromhex(found), TYPES[name]).reshape(values.shape)
            np.testing.assert_array_equal(numbers, values, err_msg=f"{number} {name}")
        tiles, packed = (np.frombuffer(bytes.fromhex(next(printed).split(" ")[1]), "<u4") for _ in range(2))
        reached = reach(texels.triangles).texels
        np.testing.assert_array_equal(tiles, texel_tiles(texels.texels, texels.size, reached).ravel())
        places = pack_texels(texels.triangles, texels.barycentrics, texels.one_sided).ravel().astype(np.int64)
        apart = np.abs(packed - places)  # means of barycentrics may round to another step
        assert number or not apart.any()
        assert ((apart == 0) | (np.arange(len(apart)) % 2 == 1) & np.isin(apart, [1, 1 << 16, (1 << 16) + 1])).all()
    assert list(printed) == []


def assert_uploaded(printed: Iterator[str], expected: Array) -> None:
    word, _, digits = next(printed).partition(" ")
    assert word == "uploaded"
    np.testing.assert_array_equal(np.frombuffer(bytes.fromhex(digits), expected.dtype), expected.ravel())


@pytest.mark.parametrize("coarser", [0, 1, 2])
@pytest.mark.parametrize("before", [0, 1, 3, 8])
def test_levels_without_details_are_the_filter_of_python(
    csharp: CSharp, program: Path, before: int, coarser: int
) -> None:
    """Also where zeros begin or end the taps of a level."""
    taps = np.concatenate([np.zeros(before), np.arange(1.0, 5) / 7, np.zeros(2 - before % 2)])
    printed = csharp.run(program, "upsampling", "2", str(coarser), ",".join(map(repr, taps.tolist()))).splitlines()
    expected, delay = upsampling_taps(taps, 2, coarser)
    assert printed[0].split()[1:] == [str(delay), *map(str, expected.shape)]
    found = np.frombuffer(bytes.fromhex(printed[1].split()[1]), "<f4")
    np.testing.assert_allclose(found, expected.ravel(), rtol=1e-6)


def test_the_table_that_both_players_choose_by(csharp: CSharp, program: Path, tmp_path: Path) -> None:
    lines = tmp_path / "cases.txt"
    lines.write_text("".join(line_of(case) + "\n" for case in CASES))
    printed = [[int(level) for level in line.split()[1:]] for line in csharp.run(program, "choose", lines).splitlines()]
    assert dict(zip([case["name"] for case in CASES], printed, strict=True)) == {c["name"]: c["levels"] for c in CASES}


def line_of(case: dict) -> str:
    """As LevelProgram reads it."""
    numbers = [-1 if case["budget"] is None else case["budget"]]
    for avatar in case["avatars"]:
        counts = avatar["counts"]
        numbers += [avatar["distance"], avatar["texel"], avatar["shown"], len(counts), *counts]
    return " ".join(map(str, numbers))
