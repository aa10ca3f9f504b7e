"""decode() against a decoder written from schemas/README.md and the schema alone, on bind poses that are turned."""

import ast
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from oracle import descriptor, drawing, expressions, file, motion, quaternions, sample, splats, surface, texels, texture
from shared_data import SharedData
from silent import Silent
from synthetic_avatar import (
    sparse_avatar,
    synthetic_avatar,
    synthetic_clip,
    with_expressions,
    with_one_sided,
    with_rules,
    with_texels,
)

from mua import rotation
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.asset.tensors import Storage
from mua.asset.write import write
from mua.avatar.camera import orbit
from mua.avatar.coarser import coarsest
from mua.avatar.decode import decode_clip_frame
from mua.avatar.rendering import frame_bounds, render_over, visible
from mua.baking.pipeline import bake
from mua.baking.settings import BakeSettings
from mua.kernels.splat_draw import splat_colors
from mua.pose.components import read_components
from mua.pose.descriptor import describe_window
from mua.pose.encoding import PoseEncoding
from mua.pose.resample import resample
from mua.pose.skeleton import Skeleton
from mua.rig.bounds import playback_bounds
from mua.student.settings import preset
from mua.texture.surfels import vertex_normals

POSITION, COLOUR = 1e-6, 1e-5  # metres; of 1: stored f32 numbers are rounded by 6e-8 of themselves
STORAGES: tuple[Storage, ...] = ("f32", "f16", "i8", "packed")
MODULES = (file, quaternions, motion, expressions, descriptor, texture, texels, splats, drawing, surface, sample)
SOURCES = [Path(str(module.__file__)).read_text() for module in MODULES]
PAGE = file.SCHEMA.with_name("README.md")
INDEPENDENT = {
    "re",
    "sys",
    "oracle",
    "types",
    "flatbuffers",
    "zlib",
    "collections.abc",
    "dataclasses",
    "pathlib",
    "typing",
    "math",
    "numpy",
}


def turned_avatar(*, remove_heading: bool, rate: float = 30.0, wavelet: str = "bior4.4") -> Avatar:
    """Joints that are turned in the bind pose, a root that hangs on another joint, a clip of another rate."""
    rng = np.random.default_rng(5)
    avatar = synthetic_avatar(3, wavelet=wavelet)
    turns, places = rotation.normalize(rng.normal(size=(3, 4))), rng.normal(size=(3, 3))
    parents = avatar.rig.skeleton.parents
    skeleton = Skeleton(("hook", "root", "tip"), parents, turns, places, root=1)
    encoding = PoseEncoding(joints=(0, 2), rate=24.0, remove_heading=remove_heading, translated=(2,))
    assert encoding.width == avatar.encoding.width
    clip = replace(synthetic_clip(skeleton, rng, frames=12), rate=rate)
    rig = replace(avatar.rig, skeleton=skeleton)
    bright = replace(avatar.appearance, ll_mean=200 * avatar.appearance.ll_mean)  # some colours fall below 0
    changed = replace(avatar, rig=rig, encoding=encoding, clips=(clip,), appearance=bright)
    return replace(changed, bounds=playback_bounds(rig, [clip]))


def assert_decodes_alike(path: Path, *, frames: int, level: int = 0) -> None:
    """Some frames of the first clip by both decoders, and what a camera sees of each."""
    avatar, record = read(path).at_level(level), file.load(path)
    clip, poses = resample(avatar.clips[0], avatar.encoding.rate), motion.poses(record, record.clips[0])
    assert len(poses) == len(clip)
    for index in np.linspace(0, len(clip) - 1, min(frames, len(clip))).astype(int):
        ours, theirs = (
            decode_clip_frame(avatar, clip, frame=index, dtype=np.float64),
            splats.decode(record, poses, index, level),
        )
        camera = orbit(frame_bounds(ours), screen=(64, 64), azimuth=0.3 * index)
        colours = splat_colors(ours.centres, ours.texel_dq, ours.sh, camera.position)
        np.testing.assert_allclose(theirs.canonical, ours.canonical, rtol=0, atol=POSITION)
        np.testing.assert_allclose(theirs.centres, ours.centres, rtol=0, atol=POSITION)
        np.testing.assert_allclose(theirs.rotations, ours.rotations, rtol=0, atol=COLOUR)
        np.testing.assert_allclose(theirs.scales, ours.scales, rtol=COLOUR, atol=0)
        np.testing.assert_allclose(theirs.opacities, ours.opacities, rtol=0, atol=COLOUR)
        np.testing.assert_allclose(theirs.colours(camera.position), colours, rtol=0, atol=COLOUR)
        seen_by = drawing.Camera(camera.view, camera.projection, camera.near, camera.screen)
        hidden = drawing.behind(theirs, seen_by)
        shown, (seen, keys, _) = visible(replace(ours, normals=None), camera)[0], visible(ours, camera)
        np.testing.assert_array_equal(seen, shown[~hidden[shown]])
        assert hidden[shown].any() == (avatar.rig.texels.one_sided is not None)
        assert_same_keys(drawing.keys(theirs, seen_by)[seen], keys)


def assert_same_keys(found: Array, expected: Array) -> None:
    """But for what lies within a rounding of two keys."""
    assert len(found) > 0
    assert np.abs(found - expected).max() <= 1
    assert np.mean(found != expected) <= 0.01


@pytest.mark.parametrize("remove_heading", [True, False])
@pytest.mark.parametrize("storage", STORAGES)
def test_a_decoder_written_from_the_page_decodes_alike(tmp_path: Path, storage: Storage, remove_heading: bool) -> None:
    path = tmp_path / "a.muaavatar"
    write(path, turned_avatar(remove_heading=remove_heading), storage=storage)
    assert_decodes_alike(path, frames=4)


@pytest.mark.parametrize("rate", [24.0, 7.5, 60.0])
def test_clips_of_any_rate_are_resampled_as_the_page_says(tmp_path: Path, rate: float) -> None:
    path = tmp_path / "a.muaavatar"
    write(path, turned_avatar(remove_heading=True, rate=rate), storage="f16")
    assert_decodes_alike(path, frames=3)


@pytest.mark.parametrize("wavelet", ["bior1.1", "bior2.2", "bior6.8"])
def test_textures_of_any_wavelet_are_those_of_pywt(tmp_path: Path, wavelet: str) -> None:
    path = tmp_path / "a.muaavatar"
    write(path, turned_avatar(remove_heading=True, wavelet=wavelet), storage="f32")
    assert_decodes_alike(path, frames=2)


@pytest.mark.parametrize("turn", [[0.0, 1, 0, 0], [0.0, 0.6, 0, 0.8]])
def test_a_root_without_twist_has_no_heading(tmp_path: Path, turn: list[float]) -> None:
    """Upside down about a horizontal axis, relative to the bind pose."""
    avatar = turned_avatar(remove_heading=True, rate=24.0)
    clip, skeleton = avatar.clips[0], avatar.rig.skeleton
    bind = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)[0]
    rotations = clip.rotations.copy()
    above = rotations[:, 0]
    rotations[:, 1] = rotation.multiply(rotation.conjugate(above), rotation.multiply(np.array(turn), bind[1]))
    path = tmp_path / "a.muaavatar"
    write(path, replace(avatar, clips=(replace(clip, rotations=rotations),)), storage="f32")
    assert_decodes_alike(path, frames=3)


@pytest.mark.parametrize("reach", [0.0, 0.5, 3.0])
def test_poses_outside_of_training_are_held_alike(tmp_path: Path, reach: float) -> None:
    """Random turns of every joint, at 0 the bind pose; how far outside is the same number."""
    avatar, rng = turned_avatar(remove_heading=True, rate=24.0), np.random.default_rng(7)
    write(tmp_path / "a.muaavatar", avatar, storage="f32")
    record, bind = file.load(tmp_path / "a.muaavatar"), avatar.rig.skeleton.bind_rotations
    turns = rotation.from_axis_angle(rotation.normalize(rng.normal(size=(3, 3, 3))), reach * rng.normal(size=(3, 3)))
    window = [(turn, avatar.rig.skeleton.bind_translations) for turn in rotation.multiply(turns, bind)]
    rotations, translations = (np.stack(part) for part in zip(*window, strict=True))
    described = describe_window(avatar.rig.skeleton, avatar.encoding, rotations, translations)
    x, outside = read_components(avatar.components, described)
    d = descriptor.describe(record, [motion.Pose(*pose) for pose in reversed(window)], len(window) - 1)
    z = descriptor.components(record.encoding, d)
    np.testing.assert_allclose(descriptor.bound(record.encoding, z), x, rtol=0, atol=POSITION)
    assert descriptor.outside(z, descriptor.bound(record.encoding, z)) == pytest.approx(float(outside), abs=POSITION)
    low, high = avatar.components.ranges
    assert ((x >= low - avatar.components.margins) & (x <= high + avatar.components.margins)).all()


@pytest.mark.parametrize("seed", range(4))
def test_surfaces_hold_the_same_triangles(tmp_path: Path, seed: int) -> None:
    avatar = sparse_avatar(seed)
    assert avatar.surface
    write(tmp_path / "a.muaavatar", avatar)
    found = surface.triangles(file.load(tmp_path / "a.muaavatar"))
    np.testing.assert_array_equal(found, avatar.surface.triangles(avatar.rig.texels))
    places = np.random.default_rng(seed).normal(size=(len(avatar.rig.texels.texels), 3))
    normals = vertex_normals(places, found)
    known = (normals != [0, 1, 0]).any(axis=1)  # elsewhere there is no triangle, or they cancel
    np.testing.assert_allclose(surface.normals(places, found)[known], normals[known], rtol=0, atol=POSITION)
    assert known.mean() > 0.5


@pytest.mark.parametrize("storage", ["f16", "packed"])
def test_the_same_texels_are_one_sided(tmp_path: Path, storage: Storage) -> None:
    path = tmp_path / "a.muaavatar"
    write(path, sparse_avatar(5), storage=storage)
    np.testing.assert_array_equal(texels.one_sided(file.load(path).texels), read(path).rig.texels.one_sided)
    write(path, synthetic_avatar(), storage=storage)
    assert not texels.one_sided(file.load(path).texels).any()


@pytest.mark.parametrize("level", [1, 2])
@pytest.mark.parametrize("wavelet", ["bior1.1", "bior4.4"])
def test_coarser_levels_decode_alike(tmp_path: Path, wavelet: str, level: int) -> None:
    path = tmp_path / "a.muaavatar"
    some, one_sided = np.random.default_rng(level).random((2, len(synthetic_avatar().rig.texels.texels))) < [
        [0.7],
        [0.9],
    ]
    avatar = with_one_sided(turned_avatar(remove_heading=True, wavelet=wavelet), one_sided)
    write(path, with_texels(avatar, some), storage="f16")
    assert len(file.load(path).texels.levels) == coarsest(read(path)) == 2
    assert_decodes_alike(path, frames=2, level=level)


@pytest.mark.parametrize("level", [0, 1, 2])
@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize("ruled", [False, True])
def test_expressions_move_a_face_alike(tmp_path: Path, storage: Storage, level: int, ruled: bool) -> None:
    """At every level of detail, with the weights of a clip of another rate."""
    path = tmp_path / "a.muaavatar"
    avatar = turned_avatar(remove_heading=True)
    one_sided = np.random.default_rng(level).random(len(avatar.rig.texels.texels)) < 0.9
    made = with_expressions(with_one_sided(avatar, one_sided))
    write(path, with_rules(made) if ruled else made, storage=storage)
    assert_decodes_alike(path, frames=3, level=level)
    weights = [pose.weights for pose in motion.poses(file.load(path), file.load(path).clips[0])]
    assert all(weight is not None and weight.any() for weight in weights)


@pytest.mark.parametrize("shift", [[0.0, 0.0], [0.1, -0.05]])
@pytest.mark.parametrize("azimuth", [0.3, 2.0])
def test_images_are_those_of_the_page(azimuth: float, shift: list[float]) -> None:
    """Of the sample, whose texels are one-sided in part; some splats are beyond the image's edge."""
    avatar, record = read(sample.SAMPLE), file.load(sample.SAMPLE)
    theirs = splats.decode(record, motion.poses(record, record.clips[0]), sample.FRAME)
    clip = resample(avatar.clips[0], avatar.encoding.rate)
    ours = decode_clip_frame(avatar, clip, frame=sample.FRAME, dtype=np.float64)
    camera = orbit(frame_bounds(ours), screen=(48, 32), azimuth=azimuth, fov=1.2)
    camera.view[2, 3] *= 0.5
    camera.projection[:2, 2] = shift
    expected = render_over(ours, camera, background=(0.2, 0.4, 0.6))
    seen_by = drawing.Camera(camera.view, camera.projection, camera.near, camera.screen)
    found = drawing.draw(theirs, seen_by, np.full((32, 48, 3), [0.2, 0.4, 0.6]))
    np.testing.assert_allclose(found, expected, rtol=0, atol=COLOUR)
    assert np.abs(expected - [0.2, 0.4, 0.6]).max() > 0.1


def test_a_texel_is_as_long_as_the_mean_mesh_says() -> None:
    record = file.load(sample.SAMPLE)
    assert texels.texel_length(record) == pytest.approx(record.texels.length, rel=1e-6)


def test_the_sample_beside_the_page_is_what_its_formulas_give() -> None:
    """Up to the last digit that is printed, which another processor may round otherwise."""
    kept, made = (
        PAGE.with_name("sample.txt").read_text().splitlines(),
        list(sample.lines(file.load(sample.SAMPLE), file.load(sample.SPOKEN))),
    )
    assert [line[:54] for line in kept] == [line[:54] for line in made]
    for ours, theirs in zip(kept, made, strict=True):
        expected, found = ([float(word) for word in line[54:].replace("|", "").split()] for line in (ours, theirs))
        np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-9, err_msg=ours)


def test_the_decoder_shares_no_code_with_mua() -> None:
    nodes = [node for source in SOURCES for node in ast.walk(ast.parse(source))]
    imported = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    imported |= {str(node.module) for node in nodes if isinstance(node, ast.ImportFrom)}
    assert {name for name in imported if name.split(".")[0] not in INDEPENDENT and name not in INDEPENDENT} == set()


def test_every_step_of_the_decoder_is_on_the_page() -> None:
    numbers = set(re.findall(r"^\*\*(\d\.\d|12\.\d)", PAGE.read_text(), re.MULTILINE))
    quoted = set(re.findall(r"(?<![\d.])([1-9]\.[1-9]|12\.[1-9])(?![\de])", "".join(SOURCES)))
    assert quoted <= numbers
    players = {"1.4"}  # where a texel's centre is
    assert numbers - quoted <= players


CHARACTERS = {"White_F_3_Casual": ("motion/cmu/01_01.bvh",), "Fox": (), "lumberjack": ()}


@pytest.mark.long
@pytest.mark.parametrize("name", CHARACTERS)
def test_a_baked_character_decodes_alike(shared_data: SharedData, tmp_path: Path, name: str) -> None:
    """Ten frames in every storage; the student need not be good."""
    tiny = preset("tiny")
    small = replace(tiny, texels=96, frames=40, finetune=replace(tiny.finetune, steps=20))
    settings = BakeSettings(
        tmp_path / "a.muaavatar",
        tmp_path / "work",
        replace(small, regression=replace(tiny.regression, steps=200)),
        "cpu",
        character=shared_data.path(f"characters/{name}.glb"),
        motions=tuple(shared_data.path(motion) for motion in CHARACTERS[name]),
        storage="f32",
    )
    bake(settings, Silent())
    avatar = read(settings.output)
    assert np.abs(avatar.rig.skeleton.bind_rotations - [1, 0, 0, 0]).max() > 0.1
    for storage in STORAGES:
        write(settings.output, avatar, storage=storage)
        assert_decodes_alike(settings.output, frames=10)
