"""The browser player's modules, run by Node, against the Python that they follow."""

import json
import subprocess
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from malformed import crowded
from recent_node import NEEDS_NODE
from rule_cases import cases
from synthetic_avatar import (
    sparse_avatar,
    synthetic_avatar,
    with_expressions,
    with_random_poses,
    with_rules,
    with_surface,
)
from tree_edits import edited
from turn_scenarios import decided, run, timed, wander, written
from wrong_files import write_all, wrong_files

from mua.arrays import Array
from mua.asset import write
from mua.asset.avatar import Avatar
from mua.asset.flatbuffer import FormatError
from mua.asset.read import decode_tree, parse_checked, read
from mua.asset.write import encode
from mua.avatar.camera import EYE_DISTANCE, orbit, perspective, sees, stereo
from mua.avatar.coarser import REACH, at_level, coarsest, texel_length
from mua.avatar.level_choice import splat_corners, texel_pixels
from mua.kernels.expressions import by_vertex, pack_entries, reach_of
from mua.kernels.inverse_dwt import texel_tiles, upsampling_taps
from mua.kernels.splat_project import pack_texels
from mua.player.draw import view_projection
from mua.player.overlays import ground_height, shadow_area
from mua.player.surface import surface_mesh
from mua.pose.components import read_components
from mua.pose.descriptor import describe_window
from mua.pose.expression_rules import held_back
from mua.pose.resample import resample
from mua.rig.bounds import frame_boxes

HERE = Path(__file__).parent
GOLDEN = HERE.parent / "golden"
EXACT = 1e-12  # of float64 sums of some dozen terms below 10
ROUNDED = 2.0**-23 * 8  # of a float32 below 8
FRAMES = [0, 1, 3, 5]
SECONDS = 600  # a reader that hangs; so many files take some seconds
CUT = 97  # so many bytes apart a file is cut off

TSC = HERE / "node_modules" / ".bin" / "tsc"

pytestmark = NEEDS_NODE


def node(what: str, *given: object) -> list[Any]:
    """The lines that modules.mjs prints."""
    command = ["node", "--no-warnings", str(HERE / "modules.mjs"), what, *map(str, given)]
    ran = subprocess.run(command, capture_output=True, text=True, check=False, timeout=SECONDS)
    assert ran.returncode == 0, ran.stderr
    return [json.loads(line) for line in ran.stdout.splitlines()]


def python_answer(content: bytes) -> list[str]:
    try:
        decode_tree(parse_checked(content))
    except FormatError as error:
        return [error.code, error.field, str(error)]
    return ["ok"]


def answers(folder: Path, contents: Sequence[bytes]) -> list[list[str]]:
    return node("answers", *write_all(folder, contents))


@pytest.fixture(scope="module")
def content() -> bytes:
    return encode(with_surface(synthetic_avatar()), storage="i8")


@pytest.mark.parametrize("storage", ["f32", "f16", "i8", "packed"])
def test_sound_files_are_read(tmp_path: Path, storage: Any) -> None:
    avatars = [synthetic_avatar(), with_surface(synthetic_avatar()), sparse_avatar(3)]
    avatars.append(with_expressions(synthetic_avatar()))
    assert answers(tmp_path, [encode(avatar, storage=storage) for avatar in avatars]) == [["ok"]] * 4


def test_malformed_files_get_the_same_sentence(tmp_path: Path, content: bytes) -> None:
    files, expected = wrong_files(content)
    found = answers(tmp_path, files)
    assert [tuple(answer[:2]) for answer in found] == expected
    reported = [(answer, file) for answer, file in zip(found, files, strict=True) if answer[0] != "packed"]
    sentences = [
        (answer[2], python_answer(file)[2]) for answer, file in reported
    ]  # a browser says of no stream how far it is sound
    assert [pair for pair in sentences if pair[0] != pair[1] and "one is negative" not in pair[0]] == []


@pytest.mark.parametrize("storage", ["i8", "packed"])
def test_truncated_files_are_refused_alike(tmp_path: Path, storage: Any) -> None:
    path, content = tmp_path / "a.muaavatar", encode(with_surface(synthetic_avatar()), storage=storage)
    path.write_bytes(content)
    expected = [python_answer(content[:length]) for length in range(0, len(content), CUT)]
    assert node("truncated", path, CUT) == expected


def faster(avatar: Avatar) -> Avatar:
    """With a clip that is not at the rate of the encoding, whose descriptors keep the heading."""
    encoding = replace(avatar.encoding, remove_heading=not avatar.encoding.remove_heading)
    return replace(avatar, clips=(replace(avatar.clips[0], rate=17.0),), encoding=encoding)


@pytest.mark.parametrize("storage", ["i8", "packed"])
@pytest.mark.parametrize(
    "change",
    [with_surface, faster, lambda avatar: sparse_avatar(2), lambda avatar: with_random_poses(avatar, 6)],
    ids=["own", "rate", "sparse", "far outside of training"],
)
def test_values_are_those_of_python(tmp_path: Path, change: Any, storage: Any) -> None:
    path = tmp_path / "a.muaavatar"
    write(path, change(synthetic_avatar()), storage=storage)
    avatar, [found] = read(path), node("values", path, *FRAMES)
    clip, skeleton, texels = resample(avatar.clips[0], avatar.encoding.rate), avatar.rig.skeleton, avatar.rig.texels
    poses = clip.rotations[FRAMES], clip.translations[FRAMES]
    close: dict[str, Any] = {
        "rotations": poses[0].reshape(len(FRAMES), -1),
        "translations": poses[1].reshape(len(FRAMES), -1),
        "joints": skeleton.skinning(*poses).reshape(len(FRAMES), -1),
        "boxes": frame_boxes(avatar.rig, clip)[FRAMES].reshape(len(FRAMES), -1),
        "length": texel_length(avatar),
        "ground": ground_height(avatar.rig, clip),
        "shadow": shadow_area(avatar.bounds, -0.25),
        "staticOffset": avatar.geometry.static.ravel(),
    }
    described = descriptors(avatar, clip)
    close["descriptors"], (close["components"], close["outside"]) = (
        described,
        read_components(avatar.components, described),
    )
    for name, expected in close.items():
        np.testing.assert_allclose(found[name], expected, rtol=EXACT, atol=EXACT, err_msg=name)
    exact = {"frames": len(clip), "tiles": texel_tiles(texels.texels, texels.size).ravel()}
    exact["texels"] = pack_texels(texels.triangles, texels.barycentrics, texels.one_sided).ravel()
    for name, expected in exact.items():
        np.testing.assert_array_equal(found[name], expected, err_msg=name)
    if avatar.surface:
        mesh = surface_mesh(avatar)
        for ours, theirs in zip(found["surface"], (mesh.triangles, mesh.ring_starts, mesh.ring), strict=True):
            np.testing.assert_array_equal(ours, theirs.ravel())


def descriptors(avatar: Avatar, clip: Any) -> Array:
    windows = [avatar.encoding.frames(frame) for frame in FRAMES]
    skeleton, encoding = avatar.rig.skeleton, avatar.encoding
    return np.stack([describe_window(skeleton, encoding, clip.rotations[w], clip.translations[w]) for w in windows])


@pytest.mark.parametrize("wavelet", ["bior4.4", "bior1.1", "bior2.2"])
def test_levels_without_details_become_the_same_filter(tmp_path: Path, wavelet: str) -> None:
    avatar = synthetic_avatar(wavelet=wavelet)
    write(tmp_path / "a.muaavatar", avatar)
    [found] = node("values", tmp_path / "a.muaavatar", 0)
    asked = [(levels, 0) for levels in range(4)] + [(2, 1), (2, 2)]
    for (levels, coarser), filtered in zip(asked, found["upsampling"] + found["halved"], strict=True):
        taps, delay = upsampling_taps(avatar.wavelet.rec_lo, levels, coarser)
        assert [filtered["reach"], filtered["factor"], filtered["delay"]] == [*taps.shape, delay]
        np.testing.assert_allclose(filtered["taps"], taps.ravel(), rtol=EXACT, atol=EXACT)


def scattered() -> Avatar:
    """Texels far apart in space beside each other in the texture, and rotations of either sign."""
    avatar, rng = synthetic_avatar(), np.random.default_rng(2)
    static = avatar.geometry.static.copy()
    static[0] += rng.choice([0, 3 * REACH * texel_length(avatar)], static.shape[1])
    static[3:7] = 0.9 * rng.choice([-1, 1], static.shape[1]) + 0.1 * static[3:7]
    return replace(avatar, geometry=replace(avatar.geometry, static=static))


def with_taps(taps: int) -> Avatar:
    avatar = synthetic_avatar()
    filters: dict[str, Any] = {
        name: np.pad(getattr(avatar.wavelet, name), (taps - 10) // 2) for name in ("rec_lo", "rec_hi")
    }
    return replace(avatar, wavelet=replace(avatar.wavelet, **filters))


COARSER: dict[str, Any] = {
    "full": synthetic_avatar,
    "sparse": lambda: sparse_avatar(4),
    "scattered": scattered,
    "as many taps as may be": lambda: with_taps(32),
    "too many taps": lambda: with_taps(34),
}


@pytest.mark.parametrize("made", COARSER)
def test_coarser_levels_are_those_of_python(tmp_path: Path, made: str) -> None:
    path = tmp_path / "a.muaavatar"
    write(path, COARSER[made](), storage="f32")
    avatar, [found] = read(path), node("levels", path)
    assert len(found) == coarsest(avatar) == (0 if made == "too many taps" else 2)
    counts = [len(at_level(avatar, number).rig.texels.texels) for number in range(len(found) + 1)]
    assert node("values", path, 0)[0]["counts"] == counts
    for number, level in enumerate(found, 1):
        expected = at_level(avatar, number)
        texels = expected.rig.texels
        assert level["size"] == texels.size
        np.testing.assert_array_equal(level["texels"], texels.texels)
        np.testing.assert_array_equal(level["triangles"], texels.triangles)
        np.testing.assert_allclose(level["barycentrics"], texels.barycentrics[:, :2].ravel(), atol=ROUNDED)
        words = pack_texels(texels.triangles, texels.barycentrics, texels.one_sided)
        np.testing.assert_array_equal(level["words"][::2], words[:, 0])
        np.testing.assert_array_equal(level["geometry"], expected.geometry.static.ravel())
        np.testing.assert_array_equal(level["appearance"], expected.appearance.static.ravel())


@pytest.mark.parametrize("storage", ["f32", "packed"])
def test_expressions_are_those_of_python(tmp_path: Path, storage: Any) -> None:
    """What a thread for each vertex reads, which texels are in reach at every level, weights of a clip, what shows."""
    path = tmp_path / "a.muaavatar"
    write(path, faster(with_rules(with_expressions(sparse_avatar(2)))), storage=storage)
    avatar, [found] = read(path), node("expressions", path, *FRAMES)
    held = avatar.rig.expressions
    assert held is not None
    assert found["names"] == list(held.names)
    targets = by_vertex(held.starts, held.vertices, held.changes)
    for name in ("vertices", "starts", "expressions", "changes"):
        np.testing.assert_array_equal(found["targets"][name], getattr(targets, name).ravel(), err_msg=name)
    for words, expected in zip(found["packed"], pack_entries(targets), strict=True):
        np.testing.assert_array_equal(words, expected.ravel())
    reach = reach_of(targets.vertices, avatar.rig.mesh.faces, np.zeros(0, int))
    for name in ("vertices", "corners", "starts", "stars"):
        np.testing.assert_array_equal(found["reach"][name], getattr(reach, name).ravel(), err_msg=name)
    for number, tiles in enumerate(found["tiles"]):
        texels = at_level(avatar, number).rig.texels
        reached = reach_of(targets.vertices, avatar.rig.mesh.faces, texels.triangles).texels
        np.testing.assert_array_equal(tiles, texel_tiles(texels.texels, texels.size, reached).ravel())
    assert len(found["tiles"]) == 3
    clip = resample(avatar.clips[0], avatar.encoding.rate)
    assert clip.expressions is not None
    np.testing.assert_allclose(found["weights"], clip.expressions[FRAMES], rtol=0, atol=ROUNDED)
    np.testing.assert_allclose(found["shown"], held.shown(clip.expressions[FRAMES]), rtol=0, atol=ROUNDED)
    assert found["shown"] != found["weights"]


def test_rules_leave_of_any_weights_what_they_leave_in_the_package(tmp_path: Path) -> None:
    file = tmp_path / "cases.json"
    file.write_text(json.dumps([(rules.tolist(), weights.tolist()) for rules, weights in cases()]))
    for (rules, weights), found in zip(cases(), node("rules", file), strict=True):
        np.testing.assert_allclose(found, held_back(rules, weights), rtol=0, atol=ROUNDED)


def test_weights_count_among_what_clips_gain(tmp_path: Path) -> None:
    """40 frames at a thousand times their rate: 3 joints of each stay within 2^24, 603 numbers do not."""
    content = encode(with_expressions(synthetic_avatar()), storage="f32")
    files = [edited(content, crowded(expressions)) for expressions in (1, 600)]
    assert answers(tmp_path, files) == [python_answer(file) for file in files]
    assert [len(python_answer(file)) for file in files] == [1, 3]


def test_levels_are_chosen_as_everywhere() -> None:
    table = GOLDEN / "level_choice.json"
    assert node("choices", table)[0] == [case["levels"] for case in json.loads(table.read_text())]


def test_avatars_take_turns_as_in_python(tmp_path: Path) -> None:
    for seed in range(12):
        told = list(run(wander(seed, 400)))
        (tmp_path / "frames.txt").write_text("".join(written(frame) + "\n" for frame, _, _ in told))
        assert node("turns", tmp_path / "frames.txt")[0] == [decided(steps) for _, _, steps in told], seed


def test_a_frame_may_hold_what_it_may_in_python(tmp_path: Path) -> None:
    for seed in range(6):
        lines, decisions = timed(seed, 6000)
        (tmp_path / "times.txt").write_text("".join(line + "\n" for line in lines))
        assert node("budget", tmp_path / "times.txt")[0] == decisions, seed


@pytest.mark.parametrize("scale", [1, 0.1])
def test_cameras_are_those_of_python(scale: float) -> None:
    """Of people, and of figures so small that the near plane comes nearer."""
    box = scale * np.array([[-0.8, -0.1, -0.3], [0.7, 1.8, 0.5]])
    [found] = node("views", *box.ravel())
    camera = orbit(box, screen=(96, 128), azimuth=0.4, elevation=0.2, fov=0.6)
    expected = {
        "view": camera.view,
        "projection": perspective(0.6, aspect=96 / 128, near=camera.near),
        "viewProjection": view_projection(camera),
        "position": camera.position,
        "target": box.mean(axis=0),
        "near": camera.near,
        "texel": texel_pixels(0.01, box, [camera])[1],
        "distance": np.linalg.norm(camera.position - box.mean(axis=0)),
    }
    eyes = stereo(camera, EYE_DISTANCE)
    expected["texelOfEyes"] = texel_pixels(0.01, box, eyes)[1]
    around = np.array([camera.position - 0.1, camera.position + 0.1])
    expected["within"], expected["texelWithin"] = texel_pixels(0.01, around, [camera])
    for fewest, cameras in zip(found.pop("fewest"), ([camera], eyes), strict=True):
        corners = [splat_corners([box, around], splats, cameras) for splats in (fewest - 1, fewest)]
        assert corners[0] != 3
        assert corners[1] == 3
    for eye, theirs in zip(found["eyes"], eyes, strict=True):
        assert eye["screen"] == list(theirs.screen)
        for name, value in {"view": theirs.view, "viewProjection": view_projection(theirs)}.items():
            np.testing.assert_allclose(eye[name], value.ravel(), atol=EXACT)
        np.testing.assert_allclose(eye["position"], theirs.position, atol=EXACT)
    places = [-12, -3, -0.5, 0, 0.5, 3, 12]
    boxes = [np.array([[x, y, z], [x + 0.5, y + 0.5, z + 0.5]]) for x in places for y in places for z in places]
    before = camera.position - camera.near / 2 * camera.view[2, :3]
    boxes.append(np.array([before - camera.near / 8, before + camera.near / 8]))
    assert found["seen"] == [bool(sees(camera, one)) for one in boxes]
    assert not found["seen"][-1]
    assert len(set(found["seen"])) == 2
    for name, value in expected.items():
        np.testing.assert_allclose(found[name], np.ravel(value) if np.ndim(value) else value, atol=EXACT, err_msg=name)


@pytest.mark.skipif(not TSC.exists(), reason="needs the packages of tests/web/package.json: npm ci --prefix tests/web")
def test_types_hold() -> None:
    ran = subprocess.run([TSC, "-p", str(HERE)], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout


def test_every_finite_half_is_expanded_exactly() -> None:
    np.testing.assert_array_equal(node("halves")[0], np.arange(0x7C00, dtype="<u2").view("<f2").astype(float))


def test_numbers_in_sentences_are_written_as_python_writes_them() -> None:
    numbers = [0.5, 1.26, 65536, 1e-7, 9e-7, 123456, 1234567, -0.00012345, 3.0, 1e16, 2.5e-5, 0.1]
    expected = [[f"{n:.4g}", f"{n:.6g}", f"{n:.1e}", repr(float(n))] for n in numbers]
    assert node("numbers", *numbers)[0] == expected
    assert [row[3] for row in node("numbers", "NaN", "-Infinity")[0]] == [repr(float("nan")), repr(-float("inf"))]
