"""mua-pack writes an avatar again in another storage, and says what it saved."""

from pathlib import Path

import numpy as np
import pytest
from commands import Commands

from mua.asset.read import load, read
from mua.asset.summary import storage_of
from mua.asset.write import write


def test_packs_beside_the_file_by_default_and_names_both_sizes(command: Commands, avatar_file: Path) -> None:
    ended = command("pack", avatar_file)
    packed = avatar_file.with_name(f"{avatar_file.stem}_packed.muaavatar")
    assert ended.status == 0
    assert ended.out.startswith(f"{packed}: ")
    assert storage_of(load(packed)) == "packed"
    assert packed.stat().st_size < avatar_file.stat().st_size


def test_a_packed_file_becomes_a_plain_one_with_the_same_numbers(
    command: Commands, avatar_file: Path, tmp_path: Path
) -> None:
    packed, plain = tmp_path / "p.muaavatar", tmp_path / "f.muaavatar"
    assert command("pack", avatar_file, "-o", packed).status == 0
    assert command("pack", packed, "--storage", "f16", "-o", plain).status == 0
    assert (storage_of(load(plain)), load(plain)["version_major"]) == ("f16", 1)
    first, second = read(packed), read(plain)
    for name in ("geometry", "appearance"):
        np.testing.assert_array_equal(getattr(first, name).static, getattr(second, name).static)
        np.testing.assert_array_equal(getattr(first, name).ll_basis, getattr(second, name).ll_basis)


@pytest.mark.parametrize("storage", ["f32", "f16", "i8", "packed"])
def test_writes_the_storage_asked_for(command: Commands, avatar_file: Path, tmp_path: Path, storage: str) -> None:
    given, made = tmp_path / "given.muaavatar", tmp_path / "made.muaavatar"
    write(given, read(avatar_file), storage="i8" if storage == "f32" else "f32")
    assert command("pack", given, "--storage", storage, "-o", made).status == 0
    assert storage_of(load(made)) == storage


def test_what_has_the_storage_already_is_refused(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    packed, again = tmp_path / "p.muaavatar", tmp_path / "again.muaavatar"
    command("pack", avatar_file, "-o", packed)
    assert command("pack", packed, "-o", again).sentence == f"error: {packed}: its storage is packed already"
    assert not again.exists()


def test_the_file_itself_is_not_overwritten(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    own, linked = tmp_path / "own.muaavatar", tmp_path / "linked.muaavatar"
    own.write_bytes(avatar_file.read_bytes())
    linked.symlink_to(own)
    for target in (own, linked):
        sentence = command("pack", own, "-o", target).sentence
        assert sentence == f"error: -o is {target}; that is FILE itself; give another name"
    assert own.read_bytes() == avatar_file.read_bytes()


def test_coarser_rounding_is_a_smaller_file_farther_from_the_original(
    command: Commands, avatar_file: Path, tmp_path: Path
) -> None:
    files = {factor: tmp_path / f"{factor}.muaavatar" for factor in (0.25, 1, 4)}
    for factor, file in files.items():
        assert command("pack", avatar_file, "-o", file, *(("--rounding", factor) if factor != 1 else ())).status == 0
    sizes = [file.stat().st_size for file in files.values()]
    assert sizes == sorted(sizes, reverse=True)
    assert len(set(sizes)) == 3
    original = read(avatar_file).appearance.static
    errors = [np.abs(read(file).appearance.static - original).mean() for file in files.values()]
    assert errors == sorted(errors)


def test_rounding_of_a_storage_that_has_none_is_refused(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    ended = command("pack", avatar_file, "--storage", "i8", "--rounding", 2, "-o", tmp_path / "a.muaavatar")
    assert ended.sentence == "error: --rounding 2: only applies to --storage packed, not to i8"


def test_an_absent_file_is_refused(command: Commands, tmp_path: Path) -> None:
    assert "absent.muaavatar" in command("pack", tmp_path / "absent.muaavatar").sentence
