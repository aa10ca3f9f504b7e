"""3D keypoints: poses of a known motion come back from the places of its joints, and what cannot be read is named."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from captures import character_file
from commands import Commands

from mua import rotation
from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.capture.keypoint_fit import fit_keypoints
from mua.capture.readers.keypoints import Keypoints
from mua.capture.readers.keypoints.trc import read_trc
from mua.capture.silhouette import posed_template
from mua.characters.read import read_surfaces
from mua.errors import InputError
from mua.motion.poses_file import read_poses
from mua.pose.clip import Clip
from mua.pose.joint_names import roles
from mua.teachers.procedural import procedural_character

NEAR = 0.005  # metres: what the pull to the bind pose costs
ROLES = {
    "Neck": "neck",
    **{
        f"{side[0].upper()}{name}": f"{side} {part}"
        for side in ("left", "right")
        for name, part in {
            "Hip": "thigh",
            "Knee": "shin",
            "Ankle": "foot",
            "Shoulder": "upper_arm",
            "Elbow": "forearm",
            "Wrist": "hand",
        }.items()
    },
}


@pytest.fixture(scope="module")
def template(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("template") / "figure.glb"
    path.write_bytes(character_file(procedural_character()))
    return path


@pytest.fixture(scope="module")
def surfaces(template: Path) -> Surfaces:
    return read_surfaces(template)


@pytest.fixture(scope="module")
def known(surfaces: Surfaces) -> Clip:
    """A walk that turns round, some metres away."""
    character, root = procedural_character(), surfaces.skeleton.root
    clip = next(clip for clip in character.clips if clip.name == "walk").cut(np.arange(12) * 4)
    order = [character.skeleton.names.index(name) for name in surfaces.skeleton.names]
    turn = rotation.from_axis_angle(np.array([0.0, 1, 0]), np.linspace(2.0, 5.0, len(clip)))
    rotations, translations = clip.rotations[:, order], clip.translations[:, order]
    rotations[:, root] = rotation.multiply(turn, rotations[:, root])
    translations[:, root] += [1.0, 0.1, -2.0]
    return replace(clip, rotations=rotations, translations=translations)


def joints(surfaces: Surfaces, clip: Clip) -> Array:
    """Where the joints of ROLES are, [F, K, 3]."""
    found = roles(surfaces.skeleton, surfaces.roles)
    _, at = surfaces.skeleton.world(clip.rotations, clip.translations)
    return at[:, [found[role][0] for role in ROLES.values()]]


def trc(
    points: Array, *, unit: str = "mm", factor: float = 1000, rate: str = "30", names: tuple[str, ...] = tuple(ROLES)
) -> str:
    head = ["DataRate", "CameraRate", "NumFrames", "NumMarkers", "Units", "OrigDataRate"]
    lines = ["PathFileType\t4\t(X/Y/Z)\ta.trc", "\t".join(head)]
    lines += ["\t".join([rate, rate, str(len(points)), str(len(names)), unit, rate])]
    lines += [
        "Frame#\tTime\t" + "\t\t\t".join(names),
        "\t\t" + "\t".join(f"X{i}\tY{i}\tZ{i}" for i in range(len(names))),
    ]
    for number, frame in enumerate(points):
        cells = ["" if np.isnan(value) else f"{factor * value:.4f}" for value in frame.ravel()]
        lines.append("\t".join([str(number + 1), f"{number / 30:.3f}", *cells]))
    return "\n".join([*lines, ""])


def test_a_known_motion_comes_back(
    template: Path, surfaces: Surfaces, known: Clip, command: Commands, tmp_path: Path
) -> None:
    points = joints(surfaces, known)
    (tmp_path / "walk.trc").write_text(trc(points))
    ended = command("capture", "poses", tmp_path / "walk.trc", "--template", template, "-o", tmp_path / "walk.npz")
    assert "12 poses at 30 frames per second" in ended.out, ended
    clip = read_poses(tmp_path / "walk.npz").clip
    assert np.linalg.norm(joints(surfaces, clip) - points, axis=2).max() < NEAR
    np.testing.assert_allclose(angles(joints(surfaces, clip)), angles(points), atol=2)


def angles(points: Array) -> Array:
    """How far knees and elbows are bent [F, 4], degrees."""
    names = list(ROLES)
    found = []
    for a, b, c in (("Hip", "Knee", "Ankle"), ("Shoulder", "Elbow", "Wrist")):
        for side in "LR":
            ends = [points[:, names.index(side + name)] for name in (a, b, c)]
            u, v = ends[1] - ends[0], ends[2] - ends[1]
            cosine = np.sum(u * v, axis=1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
            found.append(np.degrees(np.arccos(np.clip(cosine, -1, 1))))
    return np.stack(found, axis=1)


def test_a_template_of_another_height_has_limbs_as_long_as_the_persons(
    template: Path, surfaces: Surfaces, known: Clip, command: Commands, tmp_path: Path
) -> None:
    (tmp_path / "walk.trc").write_text(trc(1.3 * joints(surfaces, known)))
    line = ("capture", "poses", tmp_path / "walk.trc", "--template", template, "-o", tmp_path / "walk.npz")
    assert "limbs are 1.30 times as long" in command(*line).out
    ended = command(*line, "--height", 1.3 * np.ptp(surfaces.vertices[:, 1]))
    assert ended.status == 0, ended
    assert "times as long" not in ended.out


def test_limbs_become_as_long_as_the_persons(surfaces: Surfaces, known: Clip) -> None:
    """A person a tenth larger, on the unchanged template."""
    points = 1.1 * joints(surfaces, known)
    fitted = fit_keypoints(Keypoints(Path("a.trc"), tuple(ROLES), points, 30.0), surfaces)
    assert fitted.limbs == pytest.approx(1.1, abs=1e-6)
    found = joints(surfaces, fitted.clip)
    for a, b in (("LHip", "LKnee"), ("RKnee", "RAnkle"), ("LShoulder", "LElbow")):
        pair = [list(ROLES).index(name) for name in (a, b)]
        fit, seen = (np.linalg.norm(np.diff(one[:, pair], axis=1)[:, 0], axis=1) for one in (found, points))
        np.testing.assert_allclose(fit, seen, atol=1e-6)


def test_points_that_were_not_seen_are_bridged(surfaces: Surfaces, known: Clip) -> None:
    points = joints(surfaces, known)
    gone = points.copy()
    gone[0] = np.nan
    gone[3:5, list(ROLES).index("LWrist")] = np.nan
    gone[:, list(ROLES).index("RAnkle")] = np.nan
    fitted = fit_keypoints(Keypoints(Path("a.trc"), tuple(ROLES), gone, 30.0), surfaces)
    assert np.isfinite(fitted.clip.rotations).all()
    assert np.isfinite(fitted.clip.translations).all()
    seen = np.isfinite(gone).all(axis=2)
    assert np.linalg.norm(joints(surfaces, fitted.clip) - points, axis=2)[seen].max() < 2 * NEAR


def test_keypoints_of_the_skin_turn_head_and_feet(surfaces: Surfaces, known: Clip) -> None:
    """Toes and nose go where the template's own skin is in the known motion."""
    names = ("Nose", "LBigToe", "RBigToe", "LHeel", "RHeel")
    ends = []
    for name, end in (
        ("Nose", "head"),
        ("LBigToe", "left foot"),
        ("RBigToe", "right foot"),
        ("LHeel", "left foot"),
        ("RHeel", "right foot"),
    ):
        part = roles(surfaces.skeleton, surfaces.roles)[end][0]
        below = [part in (one, *surfaces.skeleton.ancestors(one)) for one in range(len(surfaces.skeleton.names))]
        weight = (surfaces.skin_weights * np.array(below)[surfaces.skin_indices]).sum(axis=1)
        along = surfaces.vertices[:, 2] * (-1 if "Heel" in name else 1)
        ends.append(int(np.where(weight > 0.99, along, -np.inf).argmax()))
    skin = posed_template(surfaces, known)[:, ends]
    points = np.concatenate([joints(surfaces, known), skin], axis=1)
    fitted = fit_keypoints(Keypoints(Path("a.trc"), (*ROLES, *names), points, 30.0), surfaces)
    without = fit_keypoints(Keypoints(Path("a.trc"), tuple(ROLES), points[:, : len(ROLES)], 30.0), surfaces)
    away = [
        np.linalg.norm(posed_template(surfaces, one.clip)[:, ends] - skin, axis=2).mean() for one in (fitted, without)
    ]
    assert away[0] < 0.5 * away[1]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "the first line is ''; expected a .trc with PathFileType"),
        (trc(np.ones((2, 13, 3)), unit="inch"), "line 3: Units is 'inch'; expected m, cm, mm"),
        (trc(np.ones((2, 13, 3)), rate="0"), "line 3: DataRate is '0'; expected frames per second"),
        (trc(np.ones((0, 13, 3))), "has 13 keypoints in 0 frames"),
        (trc(np.ones((2, 13, 3))).replace("1000.0000", "wide", 1), "line 6: 'wide' is not a coordinate"),
    ],
)
def test_a_trc_that_cannot_be_read_is_named(tmp_path: Path, text: str, sentence: str) -> None:
    (tmp_path / "a.trc").write_text(text)
    with pytest.raises(InputError, match=f"a.trc.*{sentence}"):
        read_trc(tmp_path / "a.trc")


def test_units_are_metres(tmp_path: Path) -> None:
    (tmp_path / "a.trc").write_text(trc(np.full((2, 13, 3), 1.5), unit="cm", factor=100))
    np.testing.assert_allclose(read_trc(tmp_path / "a.trc").points, 1.5)


def test_unknown_keypoints_are_named(template: Path, command: Commands, tmp_path: Path) -> None:
    line = ("capture", "poses", tmp_path / "a.trc", "--template", template, "-o")
    (tmp_path / "a.trc").write_text(trc(np.ones((2, 13, 3)), names=tuple(f"marker{i}" for i in range(13))))
    assert "a.trc: 0 keypoints are joints of the template (none)" in command(*line, tmp_path / "a.npz").sentence
    (tmp_path / "a.trc").write_text(
        trc(np.where(np.arange(13)[:, None] % 2 == np.arange(2)[:, None, None], np.ones((2, 13, 3)), np.nan))
    )
    assert "no frame has 8 of the keypoints that are used; the most is 7" in command(*line, tmp_path / "a.npz").sentence
    assert "the suffix is .bvh, expected .npz" in command(*line, tmp_path / "a.bvh").sentence
    assert not (tmp_path / "a.npz").exists()
