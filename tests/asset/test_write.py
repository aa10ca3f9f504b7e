"""The writer: exact round trips, storage types, same bytes for the same avatar, nothing lost on failure."""

import dataclasses
import json
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from synthetic_avatar import (
    sparse_avatar,
    synthetic_avatar,
    with_expressions,
    with_one_sided,
    with_rules,
    with_surface,
    with_texels,
)

from mua.arrays import Array
from mua.asset.flatbuffer import parse
from mua.asset.read import decode_tree, load, parse_checked, read
from mua.asset.tensors import Storage, stored
from mua.asset.write import encode, write
from mua.avatar.coarser import with_levels
from mua.errors import InputError
from mua.rig.expressions import Expressions

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = ROOT / "tests" / "golden" / "synthetic.muaavatar"
F16_RELATIVE = 2.0**-11  # half a unit in the last place of 11 significant bits
F16_SMALLEST = 2.0**-25  # half the spacing of subnormals


def tensors(avatar: object) -> dict[str, Array]:
    """Every array of a nested dataclass by its path."""
    found: dict[str, Array] = {}

    def walk(value: object, path: str) -> None:
        if isinstance(value, np.ndarray):
            found[path] = value
        elif isinstance(value, tuple):
            for i, item in enumerate(value):
                walk(item, f"{path}[{i}]")
        elif dataclasses.is_dataclass(value):
            for field in dataclasses.fields(value):
                walk(getattr(value, field.name), f"{path}.{field.name}")

    walk(avatar, "")
    return found


def test_f32_file_returns_every_array_as_float32() -> None:
    avatar = with_levels(with_expressions(synthetic_avatar()))
    back = tensors(decode_tree(parse_checked(encode(avatar, storage="f32"))))
    assert set(back) == set(tensors(avatar))
    assert back
    for path, expected in tensors(avatar).items():
        unit = path.endswith(("rotations", "barycentrics"))  # renormalised by the reader
        bound = 4 * float(np.finfo(np.float32).eps) if unit else 0.0
        np.testing.assert_allclose(back[path], np.asarray(expected, back[path].dtype), rtol=0, atol=bound, err_msg=path)


def test_an_unknown_storage_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="f64"):
        write(tmp_path / "a.muaavatar", synthetic_avatar(), storage="f64")  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


def test_influences_are_written_with_the_largest_weight_first() -> None:
    avatar = synthetic_avatar()
    turned = replace(
        avatar.rig, skin_indices=avatar.rig.skin_indices[:, ::-1], skin_weights=avatar.rig.skin_weights[:, ::-1]
    )
    back = decode_tree(parse_checked(encode(replace(avatar, rig=turned)))).rig
    np.testing.assert_array_equal(back.skin_weights, avatar.rig.skin_weights)
    own, other = (
        [dict(zip(i[w > 0], w[w > 0], strict=True)) for i, w in zip(rig.skin_indices, rig.skin_weights, strict=True)]
        for rig in (avatar.rig, back)
    )
    assert own == other


@pytest.mark.parametrize("path", [".geometry.ll_basis", ".appearance.details[1].h", ".geometry.mlp[2].weight"])
def test_f16_rounds_to_half_precision(path: str) -> None:
    avatar = synthetic_avatar()
    expected = tensors(avatar)[path]
    error = np.abs(tensors(decode_tree(parse_checked(encode(avatar, storage="f16"))))[path] - expected)
    assert np.all(error <= F16_RELATIVE * np.abs(expected) + F16_SMALLEST)
    assert error.max() > 0


def test_i8_rounds_each_row_to_its_own_largest_value() -> None:
    avatar = synthetic_avatar()
    basis = avatar.geometry.ll_basis
    back = decode_tree(parse_checked(encode(avatar, storage="i8"))).geometry.ll_basis
    step = np.abs(basis).max(axis=(2, 3), keepdims=True) / 127
    assert np.all(np.abs(back - basis) <= step * (0.5 + 1e-5))
    assert np.abs(back - basis).max() > 0


def test_i8_is_for_what_loses_nothing_by_it() -> None:
    tree = parse_checked(encode(synthetic_avatar(), storage="i8"))
    for part in (tree["coarse"], tree["geometry"], tree["appearance"]):
        assert [layer["weight"]["type"] for layer in part["mlp"]] == ["F16", "F16", "I8"]
    assert tree["geometry"]["static_offset"]["type"] == "F16"
    assert tree["appearance"]["static_offset"]["type"] == "I8"
    assert tree["coarse"]["basis"]["type"] == tree["geometry"]["ll_basis"]["type"] == "I8"
    means = [tree["coarse"]["mean"], *(tree[name]["ll_mean"] for name in ("geometry", "appearance"))]
    assert [mean["type"] for mean in means] == ["F32"] * 3


@pytest.mark.parametrize("storage", ["f32", "f16", "i8"])
def test_same_avatar_gives_same_bytes(storage: Storage) -> None:
    assert encode(synthetic_avatar(), storage=storage) == encode(synthetic_avatar(), storage=storage)


def test_tensor_bytes_start_at_multiples_of_16() -> None:
    content = encode(synthetic_avatar())
    tree = parse_checked(content)
    base = np.frombuffer(content, np.uint8).__array_interface__["data"][0]
    for branch in (tree["geometry"], tree["appearance"]):
        assert (branch["ll_basis"]["data"].__array_interface__["data"][0] - base) % 16 == 0
        assert (branch["static_offset"]["data"].__array_interface__["data"][0] - base) % 16 == 0


def test_golden_file_reads_and_writes_back_to_the_same_bytes() -> None:
    content = GOLDEN.read_bytes()
    assert encode(read(GOLDEN), storage="f32") == content


def test_a_surface_comes_back() -> None:
    avatar = with_surface(synthetic_avatar())
    content = encode(avatar)
    found = decode_tree(parse_checked(content))
    assert avatar.surface
    assert found.surface
    np.testing.assert_array_equal(found.surface.runs, avatar.surface.runs)
    np.testing.assert_array_equal(found.surface.strips, avatar.surface.strips)
    assert encode(found) == content
    assert decode_tree(parse_checked(encode(replace(avatar, surface=None)))).surface is None


@pytest.mark.parametrize("storage", ["f16", "packed"])
@pytest.mark.parametrize("count", [676, 673, 8, 1, 0])
def test_which_texels_are_one_sided_comes_back(count: int, storage: Storage) -> None:
    one_sided = np.random.default_rng(count).random(676) < 0.5
    avatar = with_texels(with_one_sided(synthetic_avatar(), one_sided), np.arange(676) < count)
    content = encode(avatar, storage=storage)
    found = decode_tree(parse_checked(content))
    np.testing.assert_array_equal(found.rig.texels.one_sided, one_sided[:count])
    assert len(parse(content)["texels"]["one_sided"]) == -(-count // 8)
    assert decode_tree(parse_checked(encode(synthetic_avatar(), storage=storage))).rig.texels.one_sided is None


@pytest.mark.parametrize("storage", ["f32", "f16", "i8", "packed"])
def test_every_file_says_the_one_version(storage: Storage) -> None:
    for avatar in (synthetic_avatar(), sparse_avatar(0)):
        tree = parse(encode(avatar, storage=storage))
        assert (tree["version_major"], tree["version_minor"]) == (1, 2)


@pytest.mark.parametrize(("storage", "kind"), [("f32", "F32"), ("f16", "F16"), ("i8", "F16"), ("packed", "F16")])
def test_components_are_stored_as_finely_as_hidden_layers(storage: Storage, kind: str) -> None:
    encoding = parse(encode(synthetic_avatar(), storage=storage))["encoding"]
    assert [encoding[name]["type"] for name in ("components", "ranges", "margins")] == [kind, "F32", "F32"]


def test_translations_of_joints_come_back(tmp_path: Path) -> None:
    avatar = synthetic_avatar()
    write(tmp_path / "a.muaavatar", avatar)
    found = read(tmp_path / "a.muaavatar")
    assert found.encoding == avatar.encoding
    for clip, expected in zip(found.clips, avatar.clips, strict=True):
        np.testing.assert_array_equal(clip.translations, expected.translations.astype(np.float32))


def test_a_joint_that_one_clip_translates_is_stored_for_all(tmp_path: Path) -> None:
    """Whether or not the descriptor tells it."""
    avatar = synthetic_avatar()
    (clip,) = avatar.clips
    moved, still = clip.translations.copy(), clip.translations.copy()
    moved[3, 1, 2] += 1e-3
    clips = tuple(dataclasses.replace(clip, translations=each) for each in (still, moved))
    write(tmp_path / "a.muaavatar", dataclasses.replace(avatar, clips=clips))
    assert stored(load(tmp_path / "a.muaavatar")["skeleton"]["translated"], "").tolist() == [1, 2]
    for found, expected in zip(read(tmp_path / "a.muaavatar").clips, clips, strict=True):
        np.testing.assert_array_equal(found.translations, expected.translations.astype(np.float32))


@pytest.mark.parametrize("storage", ["f32", "f16", "i8", "packed"])
def test_expressions_come_back_up_to_storage(storage: Storage) -> None:
    avatar = with_rules(with_expressions(synthetic_avatar()))
    found = decode_tree(parse_checked(encode(avatar, storage=storage)))
    step = 2.0**-14 if storage == "packed" else 0  # metres, of the offsets; those of the fixture are f16 already
    assert found.expressions == avatar.expressions
    ours, theirs = avatar.rig.expressions, found.rig.expressions
    assert ours
    assert theirs
    np.testing.assert_array_equal(theirs.starts, ours.starts)
    np.testing.assert_array_equal(theirs.vertices, ours.vertices)
    np.testing.assert_array_equal(theirs.rules, ours.rules)
    np.testing.assert_allclose(theirs.offsets, ours.offsets, rtol=0, atol=step)
    assert ours.gains is not None
    assert theirs.gains is not None
    np.testing.assert_allclose(theirs.gains, ours.gains, rtol=0, atol=2.0**-8 if step else 0)
    np.testing.assert_array_equal(found.clips[0].expressions, avatar.clips[0].expressions)


@pytest.mark.parametrize("none", [None, np.zeros(7, np.float32)])
def test_expressions_without_light_and_rules_store_none(none: Array | None) -> None:
    avatar = with_expressions(synthetic_avatar())
    held = avatar.rig.expressions
    assert held
    rules = None if none is None else none[:4].astype(np.int32)
    plain = dataclasses.replace(avatar.rig, expressions=dataclasses.replace(held, gains=none, rules=rules))
    tree = parse_checked(encode(dataclasses.replace(avatar, rig=plain)))
    assert not {"gains", "rules"} & tree["expressions"].keys()
    found = decode_tree(tree).rig.expressions
    assert found
    assert found.gains is None
    assert found.rules is None


def test_what_has_no_expressions_stores_none() -> None:
    still = dataclasses.replace(synthetic_avatar().clips[0], expressions=np.zeros((7, 4)))
    tree = parse(encode(dataclasses.replace(with_expressions(synthetic_avatar()), clips=(still,))))
    assert "expressions" not in tree["clips"][0]
    tree = parse(encode(synthetic_avatar()))
    assert "expressions" not in tree


def test_a_joint_that_the_descriptor_alone_tells_of_is_stored_as_translated() -> None:
    """As where the clips that moved it were left out."""
    avatar = synthetic_avatar()
    clip = avatar.clips[0]
    still = np.broadcast_to(avatar.rig.skeleton.bind_translations, clip.translations.shape)
    for clips in ((), (dataclasses.replace(clip, translations=still),)):
        found = decode_tree(parse_checked(encode(dataclasses.replace(avatar, clips=clips))))
        assert found.encoding.translated == (2,)


def test_refused_avatar_leaves_the_earlier_file(tmp_path: Path) -> None:
    path = tmp_path / "a.muaavatar"
    write(path, synthetic_avatar())
    before = path.read_bytes()
    avatar = synthetic_avatar()
    broken = dataclasses.replace(avatar.geometry, ll_mean=np.full_like(avatar.geometry.ll_mean, np.nan))
    with pytest.raises(InputError, match=r"geometry\.ll_mean: the value nan cannot be stored"):
        write(path, dataclasses.replace(avatar, geometry=broken))
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_refuses_names_that_no_reader_takes(tmp_path: Path) -> None:
    avatar = synthetic_avatar()
    clip = dataclasses.replace(avatar.clips[0], name="wa\x1blk")
    nothing = np.zeros(0, np.int32)
    rig = replace(avatar.rig, expressions=Expressions(("jaw\n",), np.zeros(2, np.int32), nothing, np.zeros((0, 3))))
    for broken, named in (
        ({"name": "he\x07ro"}, "its name 'he"),
        ({"clips": (clip,)}, "the clip 'wa"),
        ({"rig": rig}, "the expression 'jaw"),
    ):
        with pytest.raises(InputError, match=f"{named}.*has the control character U"):
            write(tmp_path / "a.muaavatar", dataclasses.replace(avatar, **broken))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("storage", ["f32", "f16", "i8"])
def test_a_number_that_no_player_could_read_is_named_with_file_field_and_remedy(
    tmp_path: Path, storage: Storage
) -> None:
    avatar = synthetic_avatar()
    *hidden, last = avatar.appearance.mlp
    weight = last.weight.copy()
    weight[1, 2] = -71426.0625
    grown = dataclasses.replace(avatar.appearance, mlp=(*hidden, dataclasses.replace(last, weight=weight)))
    with pytest.raises(InputError) as refused:
        write(tmp_path / "a.muaavatar", dataclasses.replace(avatar, appearance=grown), storage=storage)
    told = str(refused.value)
    assert told.startswith(f"{tmp_path / 'a.muaavatar'}: appearance.mlp[{len(hidden)}].weight: the value -71426.1 ")
    assert "up to 65504" in told
    assert "mua-train --check" in told
    assert list(tmp_path.iterdir()) == []


def test_flatc_reads_the_same_values(tmp_path: Path) -> None:
    """The schema compiler is the independent reader: it knows the schema, not our layout."""
    flatc = shutil.which("flatc")
    if flatc is None:
        pytest.skip("needs flatc (Debian package flatbuffers-compiler)")
    path = tmp_path / "a.muaavatar"
    write(path, synthetic_avatar(), storage="i8")
    schema = ROOT / "schemas" / "muaavatar.fbs"
    command = [flatc, "--json", "--strict-json", "--raw-binary", "-o", str(tmp_path), str(schema), "--", str(path)]
    subprocess.run(command, check=True)
    told = json.loads((tmp_path / "a.json").read_text())
    ours = load(path)
    assert told["skeleton"]["names"] == ours["skeleton"]["names"]
    assert told["crc32"] == ours["crc32"]
    assert told["wavelet"]["rec_hi"] == pytest.approx(ours["wavelet"]["rec_hi"].tolist(), abs=1e-9)
    for name in ("ll_basis", "ll_mean", "static_offset"):
        ours_tensor, told_tensor = ours["geometry"][name], told["geometry"][name]
        assert told_tensor["data"] == ours_tensor["data"].tolist()
        assert told_tensor["shape"] == ours_tensor["shape"].tolist()
        assert told_tensor.get("type", "F32") == ours_tensor["type"]
