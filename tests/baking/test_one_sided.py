"""Which texels are one-sided: those that others hide from behind, in every pose and from everywhere."""

import threading
from dataclasses import replace

import numpy as np
import pytest
import torch
from synthetic_avatar import synthetic_avatar, with_one_sided

from mua import rotation
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.avatar.camera import Camera
from mua.avatar.decode import Splats, decode_clip_frame
from mua.avatar.rendering import projected, render_over
from mua.baking import one_sided
from mua.bench.random_avatar import random_avatar
from mua.pose.clip import Clip
from mua.splatting.projection import TorchSplats
from mua.student.settings import preset


@pytest.fixture(autouse=True)
def few_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(one_sided, "POSES", 2)
    monkeypatch.setattr(one_sided, "VIEWS", 10)


def closed() -> Avatar:
    """A body of random splats without openings, of 96 texels along a side."""
    avatar = random_avatar(replace(preset("tiny"), texels=96))
    return with_one_sided(avatar, None)


def opened(avatar: Avatar) -> Avatar:
    """The same without its upper half."""
    below = avatar.rig.mesh.vertices[avatar.rig.mesh.faces[avatar.rig.texels.triangles, 0], 1] < 0.85
    logit = np.where(below, avatar.geometry.static[10], -20)
    static = np.concatenate([avatar.geometry.static[:10], logit[None]]).astype(np.float32)
    return replace(avatar, geometry=replace(avatar.geometry, static=static))


def measured(avatar: Avatar) -> Array:
    found = one_sided.with_one_sided(avatar, avatar.clips).rig.texels.one_sided
    assert found is not None
    return found


def test_the_bodies_that_benches_draw_are_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    """All of them are marked; a bake, which asks for half as much, marks most."""
    monkeypatch.setattr(one_sided, "LARGEST_SHARE", 1 / 16)
    avatar = random_avatar(replace(preset("tiny"), texels=96))
    assert avatar.rig.texels.one_sided is not None
    assert avatar.rig.texels.one_sided.all()
    assert measured(closed()).mean() > 0.97  # but for some about the ends, where triangles are narrow


def test_what_is_seen_through_an_opening_is_not_one_sided() -> None:
    avatar = opened(closed())
    height = avatar.rig.mesh.vertices[avatar.rig.mesh.faces[avatar.rig.texels.triangles, 0], 1]
    found = measured(avatar)
    assert found[height < 0.2].mean() > 0.4  # where the depth of the body hides them
    assert found[(height > 0.7) & (height < 0.84)].mean() < 0.1


def test_one_sided_texels_are_missed_in_no_picture_that_was_measured() -> None:
    avatar = opened(closed())
    clip, frame = one_sided.distinct_poses(avatar.clips, avatar.encoding.rate, root=0)[0]
    culled = with_one_sided(avatar, measured(avatar))
    whole, kept = (decode_clip_frame(each, clip, frame=frame) for each in (avatar, culled))
    shown = []
    for camera in one_sided.around(whole, 0.03, first=0)[::3]:
        assert np.abs(render_over(whole, camera) - render_over(kept, camera)).max() < 0.25
        shown.append(len(projected(kept, camera).order) / len(projected(whole, camera).order))
    assert min(shown) < 0.9


def test_distinct_poses_are_those_that_lie_farthest_apart() -> None:
    avatar = synthetic_avatar()
    clip = avatar.clips[0]
    still = replace(clip, rotations=np.repeat(clip.rotations[:1], len(clip), axis=0))
    chosen = one_sided.distinct_poses([still, clip], clip.rate, root=0)
    assert chosen[0] == (still, 0)
    assert chosen[1][0] is clip
    assert one_sided.distinct_poses([still], clip.rate, root=0) == [(still, 0)]
    assert one_sided.distinct_poses([], clip.rate, root=0) == []


def test_poses_of_a_clip_at_another_rate_are_within_the_decoded_frames() -> None:
    avatar = synthetic_avatar()
    clip = replace(avatar.clips[0], rate=2 * avatar.encoding.rate)
    poses = list(one_sided.distinct_poses([clip], avatar.encoding.rate, root=0))
    assert len(poses) > 1
    for own, frame in poses:
        decode_clip_frame(avatar, own, frame=frame)


def raised(clip: Clip, first: int) -> Clip:
    """A clip of one pose and, from a frame on, another."""
    rotations = np.repeat(clip.rotations[:1], 8, axis=0)
    rotations[first:, 1] = rotation.multiply(rotations[first:, 1], np.array([0.8, 0.6, 0, 0]))
    return replace(clip, rotations=rotations, translations=np.repeat(clip.translations[:1], 8, axis=0))


def test_poses_of_a_clip_at_another_rate_are_compared_as_they_are_decoded() -> None:
    clip = raised(synthetic_avatar().clips[0], 6)
    fast = replace(clip, rate=2 * clip.rate)
    assert one_sided.distinct_poses([fast], clip.rate, root=0) == [(fast, 0), (fast, 3)]


def test_poses_to_choose_from_are_spread_over_all_of_a_clip(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(one_sided, "LOOKED_AT", 4)
    clip = raised(synthetic_avatar().clips[0], 5)
    assert one_sided.distinct_poses([clip], clip.rate, root=0) == [(clip, 0), (clip, 6)]


def test_without_clips_nothing_is_measured() -> None:
    avatar = synthetic_avatar()
    assert one_sided.with_one_sided(avatar, []) is avatar


def test_what_was_marked_before_is_measured_anew() -> None:
    avatar = opened(closed())
    unmarked = with_one_sided(avatar, np.zeros(len(avatar.rig.texels.texels), bool))
    np.testing.assert_array_equal(measured(unmarked), measured(avatar))


def test_every_pose_is_seen_from_elsewhere() -> None:
    splats = decode_clip_frame(closed(), closed().clips[0], frame=0)
    first, second = ([camera.position for camera in one_sided.around(splats, 0.03, first=n)] for n in (0, 10))
    assert np.linalg.norm(np.array(first) - second, axis=1).min() > 0.1
    middle = np.stack([splats.centres.min(axis=0), splats.centres.max(axis=0)]).mean(axis=0)
    assert np.abs(np.mean(first, axis=0) - middle).max() < 0.3 * np.linalg.norm(first[0] - middle)


def test_poses_that_differ_in_where_the_body_faces_alone_are_one() -> None:
    clip = synthetic_avatar().clips[0]
    still = np.repeat(clip.rotations[:1], len(clip), axis=0)
    turned = still.copy()
    turned[:, 0] = clip.rotations[:, 0]
    assert len(one_sided.distinct_poses([replace(clip, rotations=turned)], clip.rate, root=0)) == 1


def test_no_texel_near_an_open_edge_is_one_sided(monkeypatch: pytest.MonkeyPatch) -> None:
    """The body of random numbers has a small hole at either end, and a seam, which is no opening."""
    monkeypatch.setattr(one_sided, "OPEN", 0.08)
    avatar = closed()
    vertices, texels = avatar.rig.mesh.vertices, avatar.rig.texels
    size = np.ptp(vertices, axis=0).max()
    places = np.einsum("nk,nkx->nx", texels.barycentrics, vertices[avatar.rig.mesh.faces[texels.triangles]])
    ends = [vertices[vertices[:, 1] == height] for height in (vertices[:, 1].min(), vertices[:, 1].max())]
    away = np.min([np.linalg.norm(places[:, None] - end, axis=2).min(axis=1) for end in ends], axis=0)
    near = one_sided.near_open_edges(avatar.rig)
    certain = np.abs(away - one_sided.OPEN * size) > 0.001
    np.testing.assert_array_equal(near[certain], (away < one_sided.OPEN * size)[certain])
    assert near.any()
    assert not measured(avatar)[near].any()


def test_vertices_at_one_place_make_no_opening(monkeypatch: pytest.MonkeyPatch) -> None:
    """As along the seams of a texture: here each triangle has corners of its own."""
    monkeypatch.setattr(one_sided, "OPEN", 0.08)
    rig = closed().rig
    faces = np.arange(rig.mesh.faces.size, dtype=np.int32).reshape(-1, 3)
    split = replace(rig.mesh, vertices=rig.mesh.vertices[rig.mesh.faces.ravel()], faces=faces)
    near = one_sided.near_open_edges(rig)
    assert 0 < near.sum() < len(near) / 2
    np.testing.assert_array_equal(one_sided.near_open_edges(replace(rig, mesh=split)), near)


def test_an_edge_of_many_triangles_is_no_opening() -> None:
    rig = closed().rig
    many = replace(rig.mesh, faces=np.concatenate([rig.mesh.faces] * 3))
    assert not one_sided.near_open_edges(replace(rig, mesh=many)).any()


def test_each_pose_has_views_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    firsts: list[int] = []

    def around(splats: Splats, texel: float, *, first: int) -> list[Camera]:
        firsts.append(first)
        return []

    monkeypatch.setattr(one_sided, "around", around)
    one_sided.shares_behind(closed(), closed().clips)
    assert firsts == [0, 10]


@pytest.mark.parametrize("threads", [1, 3])
def test_views_are_drawn_by_all_threads_with_the_same_result(threads: int, monkeypatch: pytest.MonkeyPatch) -> None:
    meet = threading.Barrier(threads, timeout=60)
    drawn = one_sided._shares_behind

    def together(splats: TorchSplats, bounds: torch.Tensor, normals: Array, camera: Camera) -> Array:
        meet.wait()
        return drawn(splats, bounds, normals, camera)

    avatar = closed()
    monkeypatch.setattr(one_sided, "VIEWS", 9)
    alone = one_sided.shares_behind(avatar, avatar.clips)
    monkeypatch.setattr(one_sided, "_shares_behind", together)
    monkeypatch.setattr(torch, "get_num_threads", lambda: threads)
    monkeypatch.setattr(torch, "set_num_threads", lambda number: None)  # the real number stays for tests that follow
    assert np.array_equal(one_sided.shares_behind(avatar, avatar.clips), alone)


def test_pictures_are_of_a_size_that_can_be_drawn() -> None:
    splats = decode_clip_frame(closed(), closed().clips[0], frame=0)
    for texel, side in ((1e-9, one_sided.LARGEST_SIDE), (0.0, one_sided.LARGEST_SIDE), (1e9, 1)):
        assert {camera.screen for camera in one_sided.around(splats, texel, first=0)} == {(side, side)}
