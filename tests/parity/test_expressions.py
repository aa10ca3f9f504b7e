"""Vertices and texels of expressions against the reference, which tests/avatar holds against scipy."""

from pathlib import Path

import numpy as np
import pytest
from bent_cases import BENT_BOUND, TURNED_BOUND, random_targets, random_texture, triangles
from dispatch import run
from frame_bounds import COLOR_BOUND, OPACITY_BOUND, POSITION_BOUND
from frame_errors import PosedFrame
from golden_case import UNTOUCHED
from packed_splats import MANTISSA_BITS
from skinned_cases import ULP
from synthetic_avatar import sparse_avatar, synthetic_avatar, with_expressions

from mua.arrays import Array
from mua.asset import write
from mua.asset.tensors import Storage
from mua.gpu import Device
from mua.kernels.expressions import Targets, bend_texels, bend_triangles
from mua.player.buffers import AvatarBuffers
from mua.player.channels import EXPRESSED
from mua.player.frame import AvatarFrame
from mua.player.splats import SplatFrame

FILE = "expressions.compute"
COUNTS = [1, EXPRESSED - 1, EXPRESSED, EXPRESSED + 1, 1000]
HALF = 2.0**-MANTISSA_BITS  # of a half float, rounded either way


def summed(device: Device, targets: Targets, weights: Array, mesh: Array) -> tuple[Array, Array]:
    """How far the vertices moved and where they are then, by the kernel; beyond the last entry stands a vertex more."""
    beyond = np.setdiff1d(np.arange(len(mesh)), targets.vertices)[:1]
    found = run(
        device,
        FILE,
        "SumTargets",
        (-(-len(targets.vertices) // EXPRESSED), 1, 1),
        {
            "vertices": np.append(targets.vertices, beyond).astype(np.uint32),
            "starts": np.append(targets.starts, targets.starts[-1]).astype(np.uint32),
            "expressions": targets.expressions.astype(np.uint32),
            "offsets": targets.offsets,
            "weights": weights,
            "moved": np.full_like(mesh, UNTOUCHED),
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
    expected = np.zeros((2 * count, 3))
    entries = weights[targets.expressions, None].astype(float) * targets.offsets
    np.add.at(expected, np.repeat(targets.vertices, np.diff(targets.starts)), entries)
    bound = 2 * expressions * ULP * np.abs(targets.offsets).max() * expressions
    np.testing.assert_allclose(moved[vertices], expected[vertices], rtol=0, atol=bound)
    np.testing.assert_allclose(found, mesh + expected, rtol=0, atol=bound + 2 * ULP)
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


@pytest.mark.parametrize("count", COUNTS)
def test_triangles_in_reach_bend(device: Device, count: int) -> None:
    """What has no area or does not move has no turn."""
    rng = np.random.default_rng(count)
    bent = triangles(rng, count)
    at = rng.permutation(len(bent.faces))[: count + 2]
    found = run(
        device,
        FILE,
        "BendTriangles",
        (-(-len(at) // EXPRESSED), 1, 1),
        {
            **{"triangles": at.astype(np.uint32), "faces": bent.faces},
            **{"moved": bent.moved, "mesh": bent.mesh + bent.moved, "bends": np.full((len(at) + 3, 4, 4), UNTOUCHED)},
        },
        triangle_count=len(at),
    )["bends"]
    turns, maps = bend_triangles(bent.mesh.astype(float), bent.moved.astype(float), bent.faces[at])
    bends = at < bent.bending
    assert not found[: len(at)][~bends, 0].any()
    assert (found[len(at) :] == UNTOUCHED).all()
    own = found[: len(at)][bends]
    own[:, 0] *= np.sign(np.sum(own[:, 0] * turns[bends], axis=1))[:, None]  # of w near 0 either sign may come
    np.testing.assert_allclose(own[:, 0], turns[bends], rtol=0, atol=BENT_BOUND)
    np.testing.assert_allclose(own[:, 1:, :3].swapaxes(1, 2), maps[bends], rtol=0, atol=BENT_BOUND)


@pytest.mark.parametrize("count", COUNTS)
def test_texels_bend_with_their_triangles(device: Device, count: int) -> None:
    """Those in reach; what does not bend stays bit for bit."""
    rng = np.random.default_rng(count)
    bent = triangles(rng, count)
    turns, maps = bend_triangles(bent.mesh, bent.moved, bent.faces)
    maps[0] *= 100  # beyond MOST_STRETCH
    place = rng.integers(0, len(bent.faces), count + 7)
    texture, at = random_texture(rng, len(place)), np.sort(rng.permutation(len(place))[:count])
    bends = np.concatenate([turns[:, None], np.pad(maps.swapaxes(1, 2), ((0, 0), (0, 0), (0, 1)))], axis=1)
    halves = texture.astype(np.float16).reshape(-1, 6, 4).swapaxes(0, 1)
    found = run(
        device,
        FILE,
        "BendTexels",
        (-(-len(at) // EXPRESSED), 1, 1),
        {
            "reached": np.stack([at, place[at]], axis=1).astype(np.uint32),
            **{"bends": bends, "texel_channels": np.ascontiguousarray(halves).view(np.uint32)},
        },
        texel_count=len(at),
        splat_count=len(place),
    )["texel_channels"].view(np.float16)
    own = found.reshape(6, -1, 4).swapaxes(0, 1).reshape(-1, 24).astype(float)
    exact = bend_texels(turns.astype(float), maps.astype(float), place, texture.astype(float))
    changed = np.zeros(len(place), bool)
    changed[at] = (turns[place[at]] != 0).any(axis=1)
    np.testing.assert_array_equal(own[~changed], texture[~changed])
    np.testing.assert_array_equal(own[:, 10:], texture[:, 10:])
    expected = exact[changed, :10]
    assert (np.abs(own[changed, :10] - expected) <= TURNED_BOUND + HALF * (1 + np.abs(expected))).all()


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
