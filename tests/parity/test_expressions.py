"""Vertices and texels of expressions against the reference, which tests/avatar holds against scipy."""

from pathlib import Path

import numpy as np
import pytest
from bent_cases import (
    LIT_BOUND,
    MEAN_BOUND,
    MIRRORED_BOUND,
    TURNED_BOUND,
    WEIGHED_BOUND,
    random_bends,
    random_light,
    random_places,
    random_stars,
    random_targets,
    random_texture,
    triangles,
)
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
from mua.kernels.expressions import Targets, bend_texels, bend_triangles, bend_vertices, brighten_texels
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
            "expressions": targets.expressions.astype(np.uint32),
            "changes": targets.changes,
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


@pytest.mark.parametrize("count", COUNTS)
def test_triangles_in_reach_bend(device: Device, count: int) -> None:
    """What has no area does not count, and what does not move does not bend."""
    rng = np.random.default_rng(count)
    bent = triangles(rng, count)
    shown, vertices = rng.permutation(len(bent.faces))[: count + 2], rng.permutation(len(bent.mesh))
    places = np.argsort(vertices)[bent.faces]
    found = run(
        device,
        FILE,
        "BendTriangles",
        (-(-len(shown) // EXPRESSED), 1, 1),
        {
            **{"vertices": vertices.astype(np.uint32), "corners": places[shown].astype(np.uint32)},
            **{"moved": np.pad(bent.moved, ((0, 0), (0, 1))), "mesh": bent.mesh + bent.moved},
            "triangle_bends": np.full((len(shown) + 3, 3, 4), UNTOUCHED),
        },
        triangle_count=len(shown),
    )["triangle_bends"].reshape(-1, 12)
    expected = bend_triangles(bent.mesh.astype(float), bent.moved.astype(float), bent.faces[shown])
    assert (found[len(shown) :] == UNTOUCHED).all()
    own = found[: len(shown)]
    own[:, :4] *= np.where(np.sum(own[:, :4] * expected[:, :4], axis=1) < 0, -1, 1)[:, None]  # of w near 0 either comes
    np.testing.assert_allclose(own, expected, rtol=0, atol=WEIGHED_BOUND)
    np.testing.assert_array_equal(own[:, 11], shown < bent.bending + 3)
    assert not own[(shown >= bent.bending) & (shown < bent.bending + 3), :11].any()


@pytest.mark.parametrize("count", COUNTS)
def test_vertices_bend_as_the_triangles_about_them(device: Device, count: int) -> None:
    """Quaternions of either sign; those about which no triangle moves do not bend."""
    rows, starts, stars = random_stars(np.random.default_rng(count), count)
    found = run(
        device,
        FILE,
        "BendVertices",
        (-(-count // EXPRESSED), 1, 1),
        {
            **{"starts": np.append(starts, starts[-1]), "stars": np.append(stars, 0).astype(np.uint32)},
            **{"triangle_bends": rows, "vertex_bends": np.full((count + 1, 12), UNTOUCHED)},
        },
        vertex_count=count,
    )["vertex_bends"].reshape(-1, 12)
    expected = bend_vertices(rows.astype(float), starts.astype(int), stars.astype(int))
    np.testing.assert_allclose(found[:count], expected, rtol=0, atol=MEAN_BOUND)
    np.testing.assert_array_equal(found[:count, 10:], expected[:, 10:])
    assert (found[count] == UNTOUCHED).all()


@pytest.mark.parametrize("count", COUNTS)
def test_texels_bend_and_brighten_as_their_corners(device: Device, count: int) -> None:
    """Those in reach; what does not bend, or is not lit, stays bit for bit."""
    rng = np.random.default_rng(count)
    bends, corners = random_bends(rng, 2 * count + 3, still=count + 2), rng.integers(0, 2 * count + 3, (count + 4, 3))
    corners[0], corners[1] = 0, 2 * count + 2
    bends[0, 4:10] *= 100  # beyond MOST_STRETCH
    bends[1, :11] = 0  # it does not count
    place = rng.integers(0, len(corners), count + 7)
    texture, at = random_texture(rng, len(place)), np.sort(rng.permutation(len(place))[:count])
    words, barycentrics = random_places(rng, len(place))
    vertices, light = random_light(rng, len(bends), dark=count)
    halves = texture.astype(np.float16).reshape(-1, 6, 4).swapaxes(0, 1)
    found = run(
        device,
        FILE,
        "BendTexels",
        (-(-len(at) // EXPRESSED), 1, 1),
        {
            "reached": np.stack([at, place[at]], axis=1).astype(np.uint32),
            **{"texels": words, "corners": corners.astype(np.uint32), "vertex_bends": bends},
            **{"vertices": vertices, "moved": light},
            "texel_channels": np.ascontiguousarray(halves).view(np.uint32),
        },
        texel_count=len(at),
        splat_count=len(place),
    )["texel_channels"].view(np.float16)
    own = found.reshape(6, -1, 4).swapaxes(0, 1).reshape(-1, 24).astype(float)
    np.testing.assert_array_equal(own[:, 11], texture[:, 11])
    own, texture = np.delete(own, 11, axis=1), np.delete(texture, 11, axis=1).astype(float)
    exact = bend_texels(bends.astype(float), corners[place], barycentrics, texture)
    changed = np.zeros(len(place), bool)
    changed[at] = bends[corners[place[at]], 11].any(axis=1) & bends[corners[place[at]], 10].any(axis=1)
    np.testing.assert_array_equal(own[~changed, :10], texture[~changed, :10])
    np.testing.assert_array_equal(own[:, 10], texture[:, 10])
    np.testing.assert_array_equal(own[~changed, 14:], texture[~changed, 14:])
    mirrored = exact[changed, 14:]
    assert (np.abs(own[changed, 14:] - mirrored) <= MIRRORED_BOUND + HALF * (1 + np.abs(mirrored))).all()
    gains = light[vertices, 3].astype(float)
    lit = brighten_texels(gains, corners[place], barycentrics, texture)[:, 11:14]
    assert (np.abs(own[at, 11:14] - lit[at]) <= LIT_BOUND + HALF * (1 + np.abs(lit[at]))).all()
    unlit = np.ones(len(place), bool)
    unlit[at] = ~gains[corners[place[at]]].any(axis=1)
    np.testing.assert_array_equal(own[unlit, 11:14], texture[unlit, 11:14])
    expected = exact[changed, :10]
    expected[:, 3:7] *= np.where(np.sum(expected[:, 3:7] * own[changed, 3:7], axis=1) < 0, -1, 1)[:, None]
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
