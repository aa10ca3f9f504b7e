"""A file for the network: what stands where in it, what is left out of it, and who reads it."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from synthetic_avatar import (
    empty_avatar,
    expressive_avatar,
    sample_avatar,
    synthetic_avatar,
    with_expressions,
    with_surface,
)

from mua.asset.avatar import Avatar
from mua.asset.flatbuffer import parse
from mua.asset.packing import packed, tensors, unpack
from mua.asset.read import decode_tree, parse_checked
from mua.asset.tensors import pack, pack_indices, stored
from mua.asset.write import encode
from mua.avatar.decode import decode_clip_frame

GOLDEN = Path(__file__).parents[1] / "golden"
BARYCENTRIC = 1e-4  # of a triangle: as near as the writer lets a reader compute it
ORDER = ("skeleton", "ll_mean", "ll_basis", "static_offset", "clips[1]")  # one part of each stage


def two_clips() -> Avatar:
    avatar = with_surface(with_expressions(synthetic_avatar()))
    return replace(
        avatar, clips=(avatar.clips[0], replace(avatar.clips[0], name="again")), thumbnail=b"\x89PNG\r\n\x1a\n"
    )


@pytest.fixture(scope="module")
def content() -> bytes:
    return encode(two_clips(), storage="packed")


def places(content: bytes) -> dict[str, tuple[int, int]]:
    """First byte and the one after the last of every tensor's data, by path."""
    base = np.frombuffer(content, np.uint8).__array_interface__["data"][0]
    starts = {
        path: (t["data"].__array_interface__["data"][0] - base, t["data"].nbytes) for path, t in tensors(parse(content))
    }
    return {path: (start, start + size) for path, (start, size) in starts.items()}


def test_stages_end_where_their_last_tensor_does(content: bytes) -> None:
    ends = parse(content)["stages"].tolist()
    found = places(content)
    assert len(ends) == len(ORDER)
    for number, name in enumerate(ORDER):
        of_stage = [place for path, place in found.items() if name in path]
        assert of_stage
        assert all(end <= ends[number] for _, end in of_stage)
        assert all(start >= (ends[number - 1] if number else 0) for start, _ in of_stage)
    assert ends[-1] <= len(content) <= ends[-1] + 16


def test_tables_and_the_mean_mesh_stand_before_the_first_stage_ends(content: bytes) -> None:
    first = parse(content)["stages"][0]
    found = places(content)
    mesh = [path for path in found if path.startswith(("skeleton", "encoding", "template", "coarse.mean", "clips[0]"))]
    assert mesh
    assert all(found[path][1] <= first for path in [*mesh, "bounds"])


def test_coarse_details_of_both_branches_stand_before_fine_ones(content: bytes) -> None:
    found = places(content)
    coarse, fine = ([end for path, end in found.items() if f"details[{i}]" in path] for i in (0, 1))
    assert max(end for _, end in coarse) <= min(start for start, _ in fine)


def test_the_same_avatar_gives_the_same_bytes(content: bytes) -> None:
    assert encode(two_clips(), storage="packed") == content


def test_barycentrics_of_centres_within_their_triangles_are_computed(content: bytes) -> None:
    texels = two_clips().rig.texels
    tree = parse_checked(content)
    assert not tree["texels"]["listed"]["data"].size
    found = decode_tree(tree).rig.texels.barycentrics
    np.testing.assert_allclose(found, texels.barycentrics, rtol=0, atol=BARYCENTRIC)


def test_barycentrics_of_other_texels_are_stored() -> None:
    """Texels along the rims of charts show a point of a triangle beside which they lie."""
    avatar = two_clips()
    moved = avatar.rig.texels.barycentrics.copy()
    moved[[3, 70]] = [[0.25, 0.5, 0.25], [1, 0, 0]]
    rig = replace(avatar.rig, texels=replace(avatar.rig.texels, barycentrics=moved))
    found = decode_tree(parse_checked(encode(replace(avatar, rig=rig), storage="packed"))).rig.texels.barycentrics
    np.testing.assert_array_equal(found[[3, 70]], moved[[3, 70]])


def test_texels_of_a_triangle_without_area_are_stored() -> None:
    avatar = two_clips()
    uv = avatar.rig.mesh.uv.copy()
    uv[avatar.rig.mesh.uv_faces[avatar.rig.texels.triangles[0]]] = 0.5
    flat = replace(avatar, rig=replace(avatar.rig, mesh=replace(avatar.rig.mesh, uv=uv)), surface=None)
    found = decode_tree(parse_checked(encode(flat, storage="packed"))).rig.texels.barycentrics
    np.testing.assert_allclose(found, avatar.rig.texels.barycentrics, rtol=0, atol=BARYCENTRIC)


def test_an_avatar_without_texels_is_written_and_read() -> None:
    back = decode_tree(parse_checked(encode(empty_avatar(), storage="packed")))
    assert len(back.rig.texels.texels) == 0


def test_frames_are_those_of_the_rounded_avatar(content: bytes) -> None:
    avatar, back = two_clips(), decode_tree(parse_checked(content))
    ours, theirs = (decode_clip_frame(one, one.clips[0], frame=3) for one in (avatar, back))
    assert np.abs(ours.texture - theirs.texture).max() < 0.2  # random numbers, some of which are rounded coarsely
    assert np.isfinite(theirs.centres).all()


@pytest.mark.parametrize(("values", "saves"), [(160, True), (210, False)])
def test_a_tensor_that_a_stream_hardly_makes_smaller_stays_as_it_is(values: int, saves: bool) -> None:
    """Bytes of so many equally frequent values take at least log2(values) / 8 of their size: 92 % and 96 %."""
    tensor = pack_indices(np.zeros(5000, np.int32))
    tensor["data"] = np.random.default_rng(0).integers(0, values, 20_000, np.uint8)
    assert (packed(tensor) is not tensor) == saves


def test_a_stage_decodes_before_the_rest_is_there(content: bytes) -> None:
    """What has not come is zeros of its shape: then the splats are those of the mean LL."""
    end = int(parse(content)["stages"][1])
    tree = parse(content[:end] + bytes(len(content) - end))
    late = ("coarse", "geometry", "appearance", "clips[1]", "surface", "expressions")
    for path, tensor in tensors(tree):
        if path.startswith(late) and not path.endswith(("ll_mean", "coarse.mean")):
            tensor |= {**pack(np.zeros(tensor["shape"]), "f16"), "packing": "Plain"}
            tensor.pop("scale", None)
    tree["clips"] = tree["clips"][:1]
    del tree["surface"], tree["expressions"], tree["clips"][0]["expressions"]
    unpack(tree, len(content))
    early, whole = decode_tree(tree), decode_tree(parse_checked(content))
    np.testing.assert_array_equal(early.coarse.mean, whole.coarse.mean)
    assert not early.coarse.basis.any()
    np.testing.assert_array_equal(early.geometry.ll_mean, whole.geometry.ll_mean)
    assert not early.geometry.ll_basis.any()
    assert np.isfinite(decode_clip_frame(early, early.clips[0], frame=2).centres).all()


@pytest.mark.parametrize(("name", "made_by"), [("packed", sample_avatar), ("expressions", expressive_avatar)])
def test_a_kept_packed_file_reads_as_when_it_was_written(name: str, made_by: Callable[[], Avatar]) -> None:
    """Its streams are those of the zlib that wrote them; the numbers are those of any."""
    kept = dict(tensors(parse_checked((GOLDEN / f"{name}.muaavatar").read_bytes())))
    made = dict(tensors(parse_checked(encode(made_by(), storage="packed"))))
    assert kept.keys() == made.keys()
    for path, tensor in made.items():
        np.testing.assert_array_equal(stored(kept[path], path), stored(tensor, path), err_msg=path)
