"""The shaders for browsers are made from the text of this checkout, and the tool lists stale ones."""

import shutil
from dataclasses import replace
from pathlib import Path

import gen_wgsl
import pytest
import shader_compilers
from check_shaders import entry_points
from compiled_folder import INDEX
from wgsl_compile import translate
from wgsl_source import with_atomics

from mua.errors import InputError

MODULE = "splat.js"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of what is committed."""
    return Path(shutil.copytree(gen_wgsl.FOLDER, tmp_path / "wgsl"))


def test_every_entry_point_is_there() -> None:
    assert set(gen_wgsl.read()) == {(path.stem, entry) for path, entry, _ in entry_points()}


@pytest.mark.parametrize("name", ["SplatFrag", "BendTexels"])  # the latter takes lines from another
def test_reading_gives_what_was_written(name: str) -> None:
    path, entry, stage = next(one for one in entry_points() if one[1] == name)
    found, made = gen_wgsl.read()[path.stem, entry], translate(path, entry, stage)
    assert set(found.code.split("\n")) ^ set(made.code.split("\n")) == set()
    assert replace(found, code="") == replace(made, code="")


def _flip(folder: Path) -> None:
    path = folder / MODULE
    path.write_text(path.read_text().replace("@fragment", "@fragment "))


def _of_another_text(folder: Path) -> None:
    index, made_from = folder / INDEX, replace(gen_wgsl.WGSL, path=folder).index()["made from"]
    index.write_text(index.read_text().replace(made_from[MODULE], 64 * "0"))


@pytest.mark.parametrize(
    ("damage", "fault"),
    [
        (_flip, f"{MODULE} is not what the compiler makes"),
        (_of_another_text, f"{MODULE} was made from another text"),
        (lambda folder: (folder / MODULE).unlink(), f"{MODULE} is missing"),
        (lambda folder: (folder / "old.js").touch(), "old.js belongs to no shader"),
    ],
    ids=["code", "text", "missing", "left over"],
)
def test_the_check_names_what_is_out_of_date(folder: Path, damage, fault: str) -> None:  # type: ignore[no-untyped-def]
    damage(folder)
    made = {path.name: path.read_bytes() for path in gen_wgsl.FOLDER.glob("*.js")}  # as `make check` has found them
    assert replace(gen_wgsl.WGSL, path=folder, contents=lambda: made).faults() == [fault]


def test_without_slangc_it_is_named(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    monkeypatch.setattr(shader_compilers, "_slangc", lambda: None)
    shader_compilers.find.cache_clear()
    path, entry, stage = entry_points()[0]
    with pytest.raises(InputError, match="slangc is not on this machine; slangc: PyPI package slangtorch"):
        translate(path, entry, stage)
    _flip(folder)
    assert replace(gen_wgsl.WGSL, path=folder).faults() == [], "the texts are still compared"
    monkeypatch.undo()
    shader_compilers.find.cache_clear()


def test_what_is_counted_in_becomes_atomic_in_every_use() -> None:
    text = """groupshared uint bins[4];
bins[i & (4 - 1)] = 0;
InterlockedAdd(bins[place(i, 2)], 1);
InterlockedMax(bins[0], f(a, b), before);
uint sum = bins[i] + other[bins[1]];
"""
    assert (
        with_atomics(text)
        == """groupshared Atomic<uint> bins[4];
bins[i & (4 - 1)].store(0);
bins[place(i, 2)].add(1);
before = bins[0].max(f(a, b));
uint sum = bins[i].load() + other[bins[1].load()];
"""
    )


def test_counters_in_device_memory_too() -> None:
    text = "RWStructuredBuffer<uint> counts; // [2]\nInterlockedAdd(counts[0], 1);\nuint count = counts[1];\n"
    assert with_atomics(text) == (
        "RWStructuredBuffer<Atomic<uint>> counts; // [2]\ncounts[0].add(1);\nuint count = counts[1].load();\n"
    )


def test_a_file_without_counters_stays() -> None:
    text = "uint bins[4];\nbins[0] = 1;\n"
    assert with_atomics(text) == text
