"""Vertices and texels of expressions against the reference, which tests/avatar holds against scipy."""

from pathlib import Path

import numpy as np
import pytest
from bent_cases import (
    BENT_BOUND,
    MEAN_BOUND,
    MIRROR,
    PER_METRE,
    ROOT_BOUND,
    bent_texels,
    lit_texels,
    random_stars,
    random_targets,
    triangle_words,
    triangles,
    vertex_numbers,
)
from dispatch import run
from frame_bounds import COLOR_BOUND, OPACITY_BOUND, POSITION_BOUND
from frame_errors import PosedFrame
from golden_case import UNTOUCHED, UNWRITTEN
from packed_splats import MANTISSA_BITS
from skinned_cases import ULP
from synthetic_avatar import sparse_avatar, synthetic_avatar, with_expressions, with_rules

from mua.arrays import Array
from mua.asset import write
from mua.asset.tensors import Storage
from mua.gpu import Device
from mua.kernels.expressions import Targets, bend_triangles, bend_vertices, pack_entries
from mua.player.buffers import AvatarBuffers
from mua.player.channels import EXPRESSED
from mua.player.frame import AvatarFrame
from mua.player.splats import SplatFrame

FILE = "expressions.compute"
COUNTS = [1, EXPRESSED - 1, EXPRESSED, EXPRESSED + 1, 1000]
HALF = 2.0**-MANTISSA_BITS  # of a half float, rounded either way


def summed(device: Device, targets: Targets, weights: Array, mesh: Array) -> tuple[Array, Array]:
    """Moves and gains of the vertices, and where they are then, by the kernel; past the last entry stands one more."""
    beyond = np.setdiff1d(np.arange(len(mesh)), targets.vertices)[:1]
    found = run(
        device,
        FILE,
        "SumTargets",
        (-(-len(targets.vertices) // EXPRESSED), 1, 1),
        {
            "vertices": np.append(targets.vertices, beyond).astype(np.uint32),
            "starts": np.append(targets.starts, targets.starts[-1]).astype(np.uint32),
            **dict(zip(("expressions", "changes"), pack_entries(targets), strict=True)),
            "weights": weights,
            "moved": np.full((len(mesh), 4), UNTOUCHED),
            "mesh": mesh,
        },
        vertex_count=len(targets.vertices),
    )
    return found["moved"], found["mesh"]


@pytest.mark.parametrize("count", COUNTS)
def test_vertices_move_by_the_sum_of_what_moves_them(device: Device, count: int) -> None:
    rng, expressions = np.random.default_rng(count), 9
    vertices = np.sort(rng.permutation(2 * count)[:count])
    targets, weights = random_targets(rng, vertices, expressions), rng.random(expressions, dtype=np.float32)
    mesh = rng.uniform(-1, 1, (2 * count, 3)).astype(np.float32)
    moved, found = summed(device, targets, weights, mesh)
    expected = np.zeros((2 * count, 4))
    entries = weights[targets.expressions, None].astype(float) * targets.changes
    np.add.at(expected, np.repeat(targets.vertices, np.diff(targets.starts)), entries)
    bound = 2 * expressions * ULP * np.abs(targets.changes).max() * expressions
    np.testing.assert_allclose(moved[vertices], expected[vertices], rtol=0, atol=bound)
    np.testing.assert_allclose(found, mesh + expected[:, :3], rtol=0, atol=bound + 2 * ULP)
    others = np.setdiff1d(np.arange(2 * count), vertices)
    assert (moved[others] == UNTOUCHED).all()
    np.testing.assert_array_equal(found[others], mesh[others])


def test_weights_of_0_move_nothing_at_all(device: Device) -> None:
    rng = np.random.default_rng(0)
    targets = random_targets(rng, np.arange(50), 4)
    mesh = rng.uniform(-1, 1, (50, 3)).astype(np.float32)
    moved, found = summed(device, targets, np.zeros(4, np.float32), mesh)
    assert not moved.any()
    np.testing.assert_array_equal(found, mesh)


def numbers_of(words: Array) -> Array:
    """The half floats [n, 12] of bent triangles or vertices."""
    return words.view(np.float16).reshape(-1, 12).astype(float)


@pytest.mark.parametrize("count", COUNTS)
def test_triangles_in_reach_bend(device: Device, count: int) -> None:
    """What has no area does not count, and what does not move does not bend."""
    rng = np.random.default_rng(count)
    bent = triangles(rng, count)
    shown = rng.permutation(len(bent.faces))[: count + 2]
    found = run(
        device,
        FILE,
        "BendTriangles",
        (-(-len(shown) // EXPRESSED), 1, 1),
        {
            "corners": bent.faces[shown].astype(np.uint32),
            **{"moved": np.pad(bent.moved, ((0, 0), (0, 1))), "mesh": bent.mesh + bent.moved},
            "triangle_bends": np.full((len(shown) + 3, 3, 2), UNWRITTEN),
        },
        triangle_count=len(shown),
    )["triangle_bends"]
    expected = bend_triangles(bent.mesh.astype(float), bent.moved.astype(float), bent.faces[shown])
    assert (found[len(shown) :] == UNWRITTEN).all()
    own = numbers_of(found[: len(shown)])
    own[:, :4] *= np.where(np.sum(own[:, :4] * expected[:, :4], axis=1) < 0, -1, 1)[:, None]  # of w near 0 either comes
    own[:, 10] /= PER_METRE
    bounds = np.full(12, BENT_BOUND)
    bounds[10:] = ROOT_BOUND, 0
    assert (np.abs(own - expected) <= bounds + HALF * np.abs(expected)).all()
    np.testing.assert_array_equal(own[:, 11], shown < bent.bending + 3)
    assert not own[(shown >= bent.bending) & (shown < bent.bending + 3), 10].any()


@pytest.mark.parametrize("count", COUNTS)
def test_vertices_bend_as_the_triangles_about_them(device: Device, count: int) -> None:
    """Quaternions of either sign; those about which no triangle moves do not bend. Each takes its gain along."""
    rng = np.random.default_rng(count)
    rows, starts, stars = random_stars(rng, count)
    vertices, moved = rng.permutation(2 * count)[: count + 1], rng.normal(size=(2 * count, 4)).astype(np.float32)
    found = run(
        device,
        FILE,
        "BendVertices",
        (-(-count // EXPRESSED), 1, 1),
        {
            **{"starts": np.append(starts, starts[-1]), "stars": np.append(stars, 0).astype(np.uint32)},
            **{"vertices": vertices.astype(np.uint32), "moved": moved, "triangle_bends": triangle_words(rows)},
            "vertex_bends": np.full((2 * count, 3, 2), UNWRITTEN),
        },
        vertex_count=count,
    )["vertex_bends"]
    means = bend_vertices(rows.astype(float), starts.astype(int), stars.astype(int))
    expected, own = vertex_numbers(means, moved[vertices[:count], 3]), numbers_of(found[vertices[:count]])
    assert (np.abs(own - expected) <= MEAN_BOUND + HALF * np.abs(expected)).all()
    np.testing.assert_array_equal(own[:, 11], expected[:, 11])
    assert (np.delete(found, vertices[:count], axis=0) == UNWRITTEN).all()


@pytest.mark.parametrize("count", COUNTS)
def test_texels_bend_as_their_corners_and_keep_their_gain(device: Device, count: int) -> None:
    """Those in reach; all others have the channels without a face. Of appearance the first row says how light turns."""
    bent = bent_texels(np.random.default_rng(count), count)
    given = {**bent.buffers, "texel_channels": np.full((6, count, 2), UNWRITTEN)}
    found = run(device, FILE, "BendTexels", bent.groups, given, **bent.constants)["texel_channels"]
    assert (found[4:] == UNWRITTEN).all()
    assert (found[3, ~bent.reached] == UNWRITTEN).all()
    mirrors = found[3].view(np.float16).reshape(-1, 4).astype(float)
    assert (np.abs(mirrors - bent.mirrors)[bent.reached] <= MIRROR * bent.bound + HALF).all()
    own = found[:3].view(np.float16).swapaxes(0, 1).reshape(-1, 12).astype(float)
    expected = bent.expected.copy()
    expected[:, 3:7] *= np.where(np.sum(expected[:, 3:7] * own[:, 3:7], axis=1) < 0, -1, 1)[:, None]
    assert (np.abs(own - expected) <= bent.bound + HALF * (1 + np.abs(expected))).all()
    unbent = ~bent.bends
    assert (np.abs(own - bent.plain)[unbent, :11] <= bent.bound + HALF * (1 + np.abs(bent.plain[unbent, :11]))).all()
    assert count < 9 or (np.abs(bent.expected - bent.plain)[bent.bends, :10].max(axis=1) > 0.01).any()


@pytest.mark.parametrize("count", COUNTS)
def test_light_turns_and_brightens_as_it_is_left(device: Device, count: int) -> None:
    """That of texels in reach; geometry stays bit for bit."""
    lit = lit_texels(np.random.default_rng(count), count)
    before = lit.buffers["texel_channels"]
    found = run(device, FILE, "LightTexels", lit.groups, lit.buffers, **lit.constants)["texel_channels"]
    np.testing.assert_array_equal(found[:3], before[:3])
    own = np.ascontiguousarray(found[3:]).view(np.float16).swapaxes(0, 1).reshape(-1, 12).astype(float)
    assert (np.abs(own - lit.expected) <= lit.bounds + HALF * (1 + np.abs(lit.expected))).all()


@pytest.mark.parametrize("storage", ["f32", "i8"])
@pytest.mark.parametrize("level", [0, 1, 2])
def test_frames_with_a_face_agree_with_the_reference(
    device: Device, tmp_path: Path, storage: Storage, level: int
) -> None:
    path = tmp_path / "a.muaavatar"
    write(path, with_expressions(sparse_avatar(2)), storage=storage)
    frame = SplatFrame(device, [AvatarFrame(device, AvatarBuffers(device, path))])
    for index in (0, 3):
        clip = frame.avatars[0].avatar.avatar.clips[0]
        errors = PosedFrame(device, frame, clip, index, eyes=1, screen=128, level=level).errors()
        assert errors.position < POSITION_BOUND
        assert errors.color < COLOR_BOUND
        assert errors.opacity < OPACITY_BOUND
        assert errors.key <= errors.key_bound


def channels_of(device: Device, frame: AvatarFrame, weights: Array | None) -> tuple[bytes, bytes]:
    """Mesh and channels of a decode."""
    clip, commands = frame.avatar.avatar.clips[0], device.commands()
    frame.decode(commands, clip.rotations[[3, 2, 1]], clip.translations[[3, 2, 1]], expressions=weights)
    commands.submit()
    return frame.mesh.read(np.uint8).tobytes(), frame.texel_channels.read(np.uint8).tobytes()


def test_weights_of_0_give_the_bytes_of_the_avatar_without(device: Device, tmp_path: Path) -> None:
    """Also after a decode that moved the face."""
    plain, face = tmp_path / "plain.muaavatar", tmp_path / "face.muaavatar"
    write(plain, synthetic_avatar(), storage="f16")
    write(face, with_expressions(synthetic_avatar()), storage="f16")
    without, own = (AvatarFrame(device, AvatarBuffers(device, path)) for path in (plain, face))
    expected = channels_of(device, without, None)
    assert channels_of(device, own, np.array([0.7, 0, 0, 0])) != expected
    for weights in (None, np.zeros(4), np.array([0, 0, 1.0, 0])):
        assert channels_of(device, own, weights) == expected


def test_rules_of_a_file_hold_back_what_a_player_is_given(device: Device, tmp_path: Path) -> None:
    """To the bytes of an avatar without rules that is given what they leave; a face held back wholly is at rest."""
    made = with_expressions(synthetic_avatar())
    plain, ruled = tmp_path / "plain.muaavatar", tmp_path / "ruled.muaavatar"
    write(plain, made, storage="f16")
    write(ruled, with_rules(made), storage="f16")
    without, own = (AvatarFrame(device, AvatarBuffers(device, path)) for path in (plain, ruled))
    for weights, left in (([0.25, 1, 0.5, 0.75], [0.125, 0, 0.5, 1]), ([1, 0, 1, 0.5], [0, 0, 1, 0])):
        assert channels_of(device, own, np.array(weights)) != channels_of(device, without, np.array(weights))
        assert channels_of(device, own, np.array(weights)) == channels_of(device, without, np.array(left))


def test_a_decode_in_parts_moves_the_face_as_one_at_once(device: Device, tmp_path: Path) -> None:
    path = tmp_path / "a.muaavatar"
    write(path, with_expressions(synthetic_avatar()))
    frame = AvatarFrame(device, AvatarBuffers(device, path))
    clip, weights = frame.avatar.avatar.clips[0], np.array([0.3, 1.0, 0.5, 0.0])
    expected = channels_of(device, frame, weights)
    frame.begin(clip.rotations[[3, 2, 1]], clip.translations[[3, 2, 1]], weights)
    while frame.parts_left:
        commands = device.commands()
        frame.advance(commands)
        commands.submit()
    frame.show()
    assert (frame.mesh.read(np.uint8).tobytes(), frame.texel_channels.read(np.uint8).tobytes()) == expected
