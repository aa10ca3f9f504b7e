"""Exported glTF: the skeleton, its motion, the mesh, the detailed geometry and the splats that others read from it."""

import io
import json
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from commands import Commands
from glb_reader import ReadGlb
from PIL import Image
from synthetic_avatar import with_surface

import mua
from mua import rotation
from mua.characters.read import read_character
from mua.export.character_glb import character_glb
from mua.export.frames import ExportFrames
from mua.export.glb import Glb, to_linear
from mua.export.splats import mean_colors, world_splats
from mua.export.surface import painted, skinned_mesh
from mua.motion.read import read_motion
from mua.player.surface import surface_mesh

EPSILON = 2.0**-23
PLACE_BOUND = 32 * EPSILON  # metres: forward kinematics of three joints of half a metre from float32 keys
FRAMES = 7
WHATS = ("mesh", "skeleton", "geometry", "splats")
SPLAT_ATTRIBUTES = [
    f"KHR_gaussian_splatting:{name}"
    for name in ("ROTATION", "SCALE", "OPACITY", "SH_DEGREE_0_COEF_0", *(f"SH_DEGREE_1_COEF_{k}" for k in range(3)))
]
VALIDATOR = Path(__file__).parents[1] / "web" / "node_modules" / "gltf-validator"
VALIDATE = """
const [, validator, path] = process.argv
require(validator).validateBytes(new Uint8Array(require("fs").readFileSync(path)))
  .then(report => console.log(JSON.stringify(report.issues.messages)))
"""


@pytest.fixture
def stored(avatar_file: Path) -> mua.Avatar:
    """The avatar as its file holds it."""
    mua.save(avatar_file, with_surface(mua.load(avatar_file)))
    return mua.load(avatar_file)


def exported(command: Commands, avatar_file: Path, tmp_path: Path, what: str, *more: object) -> Path:
    path = tmp_path / f"{what}.glb"
    ended = command("export", avatar_file, "-o", path, "--what", what, *more)
    assert (ended.status, ended.err) == (0, "")
    return path


def test_a_glb_is_a_skinned_mesh_unless_asked_for_more(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    ended = command("export", avatar_file, "-o", tmp_path / "a.glb")
    assert ended.out.startswith(f"{tmp_path / 'a.glb'}: mesh of {len(stored.rig.mesh.faces)} triangles, 3 joints, 7 fr")
    found = ReadGlb(tmp_path / "a.glb")
    names = [*stored.rig.skeleton.names, stored.name]
    assert [node["name"] for node in found.json["nodes"]] == names
    assert found.json["animations"][0]["name"] == "wave"
    assert names[found.json["skins"][0]["skeleton"]] == stored.rig.skeleton.names[stored.rig.skeleton.root]
    assert [material["doubleSided"] for material in found.json["materials"]] == [True]  # sleeves show their inside


def test_only_joints_that_move_in_their_parents_have_keys_of_places(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    found = ReadGlb(exported(command, avatar_file, tmp_path, "skeleton"))
    targets = [channel["target"] for channel in found.json["animations"][0]["channels"]]
    still = (stored.clips[0].translations == stored.rig.skeleton.bind_translations).all(axis=(0, 2))
    placed = {target["node"] for target in targets if target["path"] == "translation"}
    assert placed == set(np.flatnonzero(~still).tolist())
    assert 0 < len(placed) < len(still)


@pytest.mark.parametrize("frames", [range(FRAMES), range(1, 6, 2)])
def test_joints_move_as_in_the_clip(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path, frames: range
) -> None:
    asked = f"{frames.start}:{frames.stop}:{frames.step}"
    found = ReadGlb(exported(command, avatar_file, tmp_path, "skeleton", "--frames", asked))
    clip, skeleton = stored.clips[0], stored.rig.skeleton
    turned, placed = skeleton.world(clip.rotations, clip.translations)
    times = found.array(found.json["animations"][0]["samplers"][0]["input"])[:, 0]
    np.testing.assert_allclose(times, np.arange(len(frames)) * frames.step / 24, rtol=EPSILON)
    for key, frame in enumerate(frames):
        worlds = found.joint_worlds(key)
        np.testing.assert_allclose(worlds[:, :3, 3], placed[frame], atol=PLACE_BOUND)
        np.testing.assert_allclose(worlds[:, :3, :3], rotation.to_matrix(turned[frame]), atol=PLACE_BOUND)


def test_quaternions_do_not_jump_from_key_to_key(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    clip = stored.clips[0]
    signs = np.where(np.arange(FRAMES) % 2, -1, 1)[:, None, None]
    flipped = mua.Clip(clip.name, clip.rate, clip.rotations * signs, clip.translations)
    mua.save(avatar_file, replace(stored, clips=(flipped,)))
    found = ReadGlb(exported(command, avatar_file, tmp_path, "skeleton"))
    keys = [found.array(sampler["output"]) for sampler in found.json["animations"][0]["samplers"]]
    turns = [own for own in keys if own.shape[1] == 4]
    assert [len(own) for own in turns] == [FRAMES] * len(clip.rotations[0])
    assert min(np.sum(own[1:] * own[:-1], axis=1).min() for own in turns) > 0.9


def test_the_mesh_at_rest_is_the_template_and_then_follows_its_joints(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    found = ReadGlb(exported(command, avatar_file, tmp_path, "mesh"))
    rig, clip = stored.rig, stored.clips[0]
    corners = found.attributes()["POSITION"][found.faces()]
    np.testing.assert_array_equal(corners, rig.mesh.vertices[rig.mesh.faces])
    np.testing.assert_allclose(found.skinned(None)[found.faces()], corners, atol=PLACE_BOUND)
    uv = found.attributes()["TEXCOORD_0"][found.faces()]
    np.testing.assert_array_equal(uv, rig.mesh.uv[rig.mesh.uv_faces].astype(np.float32))
    for frame in (0, 4):
        dual = rig.skeleton.skinning(clip.rotations[frame], clip.translations[frame])
        moved = np.stack([rotation.dual_transform(one, rig.mesh.vertices) for one in dual], axis=1)
        weights = np.zeros((len(moved), len(dual)))
        np.put_along_axis(weights, rig.skin_indices[:, :3], rig.skin_weights[:, :3], axis=1)
        linear = np.einsum("vj,vjc->vc", weights, moved)
        np.testing.assert_allclose(found.skinned(frame)[found.faces()], linear[rig.mesh.faces], atol=PLACE_BOUND)


def test_of_eight_joints_the_four_largest_count(stored: mua.Avatar, tmp_path: Path) -> None:
    mesh = skinned_mesh(stored, stored.decode("wave", 0))
    eight = np.tile(np.array([0.3, 0.2, 0.2, 0.1, 0.05, 0.05, 0.05, 0.05], np.float32), (len(mesh.vertices), 1))
    eight[0] = [1, 0, 0, 0, 0, 0, 0, 0]
    many = replace(mesh, weights=eight, joints=np.tile([2, 1, 1, 1, 1, 1, 1, 1], (len(eight), 1)))
    (tmp_path / "a.glb").write_bytes(character_glb(ExportFrames(stored, stored.clips[0], range(1)), many))
    found = ReadGlb(tmp_path / "a.glb").attributes()
    np.testing.assert_allclose(found["WEIGHTS_0"][1:], [[0.375, 0.25, 0.25, 0.125]] * (len(eight) - 1), atol=EPSILON)
    assert found["JOINTS_0"][:2].tolist() == [[2, 0, 0, 0], [2, 1, 1, 1]]


def test_the_texture_has_the_colours_of_the_splats(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    found = ReadGlb(exported(command, avatar_file, tmp_path, "mesh", "--frames", "3:"))
    image = np.asarray(Image.open(io.BytesIO(found.view(found.json["images"][0]["bufferView"]))))
    texels = stored.rig.texels
    assert image.shape == (texels.size, texels.size, 3)
    colors = np.clip(mean_colors(stored.decode("wave", 3).sh), 0, 1) * 255
    assert np.abs(image.reshape(-1, 3)[texels.texels] - colors).max() <= 0.5 + 1e-4
    assert image.reshape(-1, 3)[0].any(), "texels outside of the charts have colours too"


def test_colours_beyond_white_and_black_are_painted_white_and_black(stored: mua.Avatar) -> None:
    texels = stored.rig.texels
    colors = np.where(np.arange(len(texels.texels))[:, None] % 2, 1.2, -0.2) * np.ones(3)
    image = painted(texels, colors).reshape(-1, 3)[texels.texels]
    np.testing.assert_array_equal(image, np.where(colors > 1, 255, 0))


def test_colours_are_made_linear_by_the_standards_table() -> None:
    """Values of sRGB's transfer function, on both sides of where its straight part ends."""
    srgb = np.array([0, 0.02, 0.04, 0.05, 0.2, 0.5, 0.9, 1])
    linear = [0, 0.001548, 0.003096, 0.003936, 0.033105, 0.214041, 0.787412, 1]
    np.testing.assert_allclose(to_linear(srgb), linear, atol=5e-7)


def test_every_part_of_the_buffer_begins_at_a_word() -> None:
    glb = Glb()
    glb.view(b"abc")
    number = glb.view(b"defg")
    assert [glb.document.bufferViews[n].byteOffset for n in range(number + 1)] == [0, 4]
    assert glb.content().endswith(b"abc\0defg")


def test_a_joint_that_stands_elsewhere_than_at_rest_is_there(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    clip = stored.clips[0]
    moved = clip.translations.copy()
    moved[:, 2] += [0.1, 0, 0.05]
    mua.save(avatar_file, replace(stored, clips=(mua.Clip(clip.name, clip.rate, clip.rotations, moved),)))
    found = ReadGlb(exported(command, avatar_file, tmp_path, "skeleton"))
    _, placed = stored.rig.skeleton.world(clip.rotations, moved)
    np.testing.assert_allclose(found.joint_worlds(3)[:, :3, 3], placed[3], atol=PLACE_BOUND)


def test_trimesh_reads_the_detailed_geometry_with_its_colours(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    path = exported(command, avatar_file, tmp_path, "geometry", "--frames", "4")
    (mesh,) = trimesh.load_scene(path, process=False).geometry.values()
    splats = stored.decode("wave", 4)
    np.testing.assert_array_equal(mesh.vertices, splats.centres)
    np.testing.assert_array_equal(mesh.faces, surface_mesh(stored).triangles)
    srgb = np.clip(mean_colors(splats.sh), 0, 1)
    linear = ReadGlb(path).attributes()["COLOR_0"][:, :3]
    back = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    np.testing.assert_allclose(back, srgb, atol=12.92 / 65535)
    normals = ReadGlb(path).attributes()["NORMAL"]
    assert np.sum(normals * mesh.vertex_normals, axis=1).min() > 0


def test_splats_by_the_extension_are_those_of_the_frame(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    path = exported(command, avatar_file, tmp_path, "splats", "--frames", "4")
    found, posed = ReadGlb(path), stored.decode("wave", 4)
    splats, arrays, own = world_splats(posed), found.attributes(), "KHR_gaussian_splatting"
    np.testing.assert_array_equal(arrays["POSITION"], posed.centres)
    np.testing.assert_array_equal(arrays[f"{own}:ROTATION"], posed.rotations[:, [1, 2, 3, 0]])
    np.testing.assert_allclose(arrays[f"{own}:SCALE"], posed.scales, rtol=4 * EPSILON)
    np.testing.assert_allclose(arrays[f"{own}:OPACITY"][:, 0], posed.opacities, atol=4 * EPSILON)
    linear = arrays["COLOR_0"][:, :3]
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    np.testing.assert_allclose(srgb, np.clip(mean_colors(posed.sh), 0, 1), atol=12.92 / 65535)
    np.testing.assert_allclose(arrays["COLOR_0"][:, 3], posed.opacities, atol=1 / 65535)
    np.testing.assert_array_equal(arrays[f"{own}:SH_DEGREE_0_COEF_0"], splats.sh[:, :3])
    for k in range(3):
        np.testing.assert_array_equal(arrays[f"{own}:SH_DEGREE_1_COEF_{k}"], splats.sh[:, 3 + 3 * k : 6 + 3 * k])
    primitive = found.json["meshes"][0]["primitives"][0]
    assert primitive["mode"] == 0
    assert primitive["extensions"][own]["kernel"] == "ellipse"
    assert primitive["extensions"][own]["colorSpace"] == "srgb_rec709_display"
    assert own in found.json["extensionsUsed"]
    (points,) = trimesh.load_scene(path).geometry.values()
    np.testing.assert_array_equal(points.vertices, posed.centres)


@pytest.mark.parametrize("what", ["mesh", "skeleton"])
def test_our_own_reader_finds_the_same_motion(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path, what: str
) -> None:
    (motion,) = read_motion(exported(command, avatar_file, tmp_path, what))
    clip, skeleton = stored.clips[0], stored.rig.skeleton
    _, placed = skeleton.world(clip.rotations, clip.translations)
    _, found = motion.skeleton.world(motion.clip.rotations, motion.clip.translations)
    order = [motion.skeleton.names.index(name) for name in skeleton.names]
    assert motion.clip.rate == 30, "a .glb states times alone; they are read at 30 a second"
    np.testing.assert_allclose(found[[0, 5]][:, order], placed[[0, 4]], atol=PLACE_BOUND)


def test_our_own_reader_finds_the_same_character(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    character = read_character(exported(command, avatar_file, tmp_path, "mesh"))
    rig = stored.rig
    assert len(character.mesh.vertices) == len(rig.mesh.vertices), "UV seams are welded again"
    corners = character.mesh.vertices[character.mesh.faces]
    np.testing.assert_allclose(corners, rig.mesh.vertices[rig.mesh.faces], atol=PLACE_BOUND)


def test_files_of_all_frames_have_plain_names(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    message = command("export", avatar_file, "-o", "a_%d.glb").sentence
    assert message == "error: -o is a_%d.glb; a .glb file of mesh holds all frames, expected a plain name"
    command("export", avatar_file, "-o", tmp_path / "g_%d.glb", "--what", "geometry", "--frames", ":2")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["g_0.glb", "g_1.glb"]


@pytest.mark.parametrize("what", WHATS)
def test_the_validator_of_khronos_finds_no_error(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path, what: str
) -> None:
    if shutil.which("node") is None or not VALIDATOR.is_dir():
        pytest.skip("needs Node and npm's gltf-validator: npm ci --prefix tests/web")
    path = exported(command, avatar_file, tmp_path, what)
    line = ["node", "-e", VALIDATE, str(VALIDATOR), str(path)]
    messages = json.loads(subprocess.run(line, capture_output=True, text=True, check=True).stdout)
    errors = {m["pointer"].rpartition("/")[2]: m["code"] for m in messages if m["severity"] < 2}
    unknown = SPLAT_ATTRIBUTES if what == "splats" else ()  # the validator knows no attributes of extensions
    assert errors == dict.fromkeys(unknown, "MESH_PRIMITIVE_INVALID_ATTRIBUTE")
