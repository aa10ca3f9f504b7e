"""BVH reading against scipy's Euler angles and a slow forward kinematics of its own."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from shared_data import SharedData

from mua.errors import InputError
from mua.motion.bvh import read_bvh
from mua.motion.source_motion import SourceMotion

# Products of at most 40 rotations and as many additions of offsets of up to 200 units: 40 x 16 eps x 200.
BOUND = 40 * 16 * np.finfo(float).eps * 200

PERSON = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT LeftFoot
  {
    OFFSET 1 -9 0
    CHANNELS 3 Yrotation Zrotation Yrotation
    End Site
    {
      OFFSET 0 0 2
    }
  }
  JOINT Head
  {
    OFFSET 0 7 0.5
    CHANNELS 1 Xrotation
    End Site
    {
      OFFSET 0 2 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
0 9 0 0 0 0 0 0 0 0
1 9.5 -2 10 -20 30 5 6 -7 45
"""


def write(folder: Path, text: str) -> Path:
    path = folder / "motion.bvh"
    path.write_bytes(text.encode())
    return path


def slow_world_positions(path: Path) -> np.ndarray:
    """Positions [F, J, 3] of all joints and end sites by 4x4 matrices, one joint and frame at a time."""
    head, tail = path.read_text().split("MOTION")
    stack: list[int] = []
    joints: list[dict] = []
    for words in (line.split() for line in head.splitlines() if line.strip()):
        if words[0] in ("ROOT", "JOINT", "End"):
            joints.append({"parent": stack[-1] if stack else None, "channels": []})
        elif words[0] == "{":
            stack.append(len(joints) - 1)
        elif words[0] == "}":
            stack.pop()
        elif words[0] == "OFFSET":
            joints[stack[-1]]["offset"] = [float(word) for word in words[1:]]
        elif words[0] == "CHANNELS":
            joints[stack[-1]]["channels"] = words[2:]
    frames = []
    for row in tail.split("\n")[3:]:
        if not row.strip():
            continue
        values = iter(float(word) for word in row.split())
        world: list[np.ndarray] = []
        for joint in joints:
            local, offset = np.eye(4), list(joint["offset"])
            for channel in joint["channels"]:
                if channel.endswith("position"):
                    offset["XYZ".index(channel[0])] = next(values)
                else:
                    turn = Rotation.from_euler(channel[0].lower(), next(values), degrees=True).as_matrix()
                    local[:3, :3] = local[:3, :3] @ turn
            local[:3, 3] = offset
            world.append(local if joint["parent"] is None else world[joint["parent"]] @ local)
        frames.append([matrix[:3, 3] for matrix in world])
    return np.array(frames)


def world_positions(motion: SourceMotion) -> np.ndarray:
    return motion.skeleton.world(motion.clip.rotations, motion.clip.translations)[1]


@pytest.mark.parametrize("order", ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XYX", "ZXZ", "Y", "XZ"])
def test_composes_euler_channels_in_file_order(tmp_path: Path, order: str) -> None:
    names = " ".join(f"{axis}rotation" for axis in order)
    angles = np.array([[25.0, -130, 70], [0, 0, 0], [179, 91, -3]])[:, : len(order)]
    rows = "\n".join(" ".join(map(str, row)) for row in angles)
    text = (
        f"HIERARCHY\nROOT a\n{{\nOFFSET 0 1 0\nCHANNELS {len(order)} {names}\n}}\nMOTION\nFrames: 3\nFrame Time: 0.1\n"
    )
    motion = read_bvh(write(tmp_path, text + rows))
    expected = Rotation.from_euler(order, angles, degrees=True)
    found = Rotation.from_quat(motion.clip.rotations[:, 0], scalar_first=True)
    assert (found * expected.inv()).magnitude().max() < BOUND


def test_composes_a_fourth_rotation(tmp_path: Path) -> None:
    text = "HIERARCHY\nROOT a\n{\nOFFSET 0 1 0\nCHANNELS 4 Xrotation Yrotation Zrotation Xrotation\n}\n"
    motion = read_bvh(write(tmp_path, text + "MOTION\nFrames: 1\nFrame Time: 0.1\n10 20 30 40"))
    expected = Rotation.from_euler("XYZ", [10, 20, 30], degrees=True) * Rotation.from_euler("X", 40, degrees=True)
    found = Rotation.from_quat(motion.clip.rotations[0, 0], scalar_first=True)
    assert (found * expected.inv()).magnitude() < BOUND


def test_places_joints_and_end_sites_like_slow_kinematics(tmp_path: Path) -> None:
    path = write(tmp_path, PERSON)
    motion = read_bvh(path, scale=1.0)
    assert motion.skeleton.names == ("Hips", "LeftFoot", "LeftFoot_end", "Head", "Head_end")
    assert motion.clip.rate == 25
    np.testing.assert_allclose(world_positions(motion), slow_world_positions(path), atol=BOUND)


def test_the_rest_pose_is_that_of_the_offsets(tmp_path: Path) -> None:
    skeleton = read_bvh(write(tmp_path, PERSON), scale=1.0).skeleton
    _, at = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    expected = np.array([[0, 0, 0], [1, -9, 0], [1, -9, 2], [0, 7, 0.5], [0, 9, 0.5]])
    np.testing.assert_allclose(at, expected, atol=BOUND)


@pytest.mark.parametrize("name", ["cmu/02_01.bvh", "dab.bvh"])
def test_places_real_motion_like_slow_kinematics(shared_data: SharedData, name: str) -> None:
    path = shared_data.path(f"motion/{name}")
    motion = read_bvh(path, scale=1.0)
    expected = slow_world_positions(path)
    if "Z is up" in " ".join(motion.notes):
        expected = np.stack([expected[..., 0], expected[..., 2], -expected[..., 1]], axis=-1)
    np.testing.assert_allclose(world_positions(motion), expected, atol=BOUND)


def test_finds_centimetres_and_thirty_frames_a_second_in_cmu_motion(shared_data: SharedData) -> None:
    motion = read_bvh(shared_data.path("motion/cmu/02_01.bvh"))
    assert motion.clip.rate == 30
    heights = world_positions(motion)[..., 1]
    assert -0.05 < heights.min() < 0.05
    assert 1.5 < heights.max() < 1.8


@pytest.mark.parametrize("unit", [1.0, 0.1, 0.01, 0.001, 0.0254])
def test_brings_every_common_unit_to_metres(tmp_path: Path, unit: float) -> None:
    leg, trunk, arm = 1.0 / unit, 0.5 / unit, 0.8 / unit
    text = f"""HIERARCHY
ROOT Hips\n{{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition
JOINT LeftFoot\n{{\nOFFSET 0 {-leg} 0\nCHANNELS 0\n}}
JOINT Chest\n{{\nOFFSET 0 {trunk} 0\nCHANNELS 0\nJOINT Hand\n{{\nOFFSET {arm} 0 0\nCHANNELS 0\n}}\n}}\n}}
MOTION\nFrames: 1\nFrame Time: 1\n0 {leg} 0\n"""
    motion = read_bvh(write(tmp_path, text))
    np.testing.assert_allclose(world_positions(motion)[0, 3], [0.8, 1.5, 0], rtol=1e-12)


def test_a_span_that_no_unit_makes_a_person_s_takes_the_nearest_by_ratio(tmp_path: Path) -> None:
    text = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\nEnd Site\n{\nOFFSET 0 7 0\n}\n}\n"
    motion = read_bvh(write(tmp_path, text + "MOTION\nFrames: 1\nFrame Time: 0.1\n0"))
    assert motion.skeleton.bind_translations[1, 1] == 7  # metres, not decimetres


@pytest.mark.parametrize(
    ("seconds", "rate"), [("0.00833", 120), ("0.03334", 30), ("0.0417", 24), ("0.0404", 1 / 0.0404), ("2", 0.5)]
)
def test_a_frame_time_that_was_rounded_means_a_whole_rate(tmp_path: Path, seconds: str, rate: float) -> None:
    assert read_bvh(write(tmp_path, PERSON.replace("0.04\n", f"{seconds}\n"))).clip.rate == rate


def test_takes_a_given_scale(tmp_path: Path) -> None:
    motion = read_bvh(write(tmp_path, PERSON), scale=0.5)
    np.testing.assert_array_equal(motion.clip.translations[:, 0], [[0, 4.5, 0], [0.5, 4.75, -1]])


@pytest.mark.parametrize(
    "variant",
    [
        PERSON.replace("\n", "\r\n"),
        PERSON.replace("  ", "\t").replace(" ", "\t").replace("Frame\tTime:", "Frame Time:").replace("\tSite", " Site"),
        PERSON.lower().replace("hips", "Hips").replace("leftfoot", "LeftFoot").replace("head", "Head"),
        PERSON.replace("\n", "\n\n  \n"),
        PERSON.replace("\n  {", " {").replace("\n{", " {"),
        "\ufeff" + PERSON,
        PERSON.rstrip(),
        PERSON.replace(".", ","),
        PERSON.replace("0.04", "0,04"),
        PERSON.replace("1 9.5 -2 10", "1, 9.5, -2, 10"),
        "# exported today\n" + PERSON.replace("  JOINT Head", "  // the skull\n  JOINT Head"),
    ],
    ids=[
        *("crlf", "tabs", "lower case", "blank lines", "braces on the line", "byte order mark", "no last newline"),
        *("decimal commas", "a decimal comma in the header", "commas between numbers", "comments"),
    ],
)
def test_reads_the_same_from_other_layouts(tmp_path: Path, variant: str) -> None:
    expected = read_bvh(write(tmp_path, PERSON))
    found = read_bvh(write(tmp_path, variant))
    assert found.skeleton.names == expected.skeleton.names
    np.testing.assert_array_equal(found.clip.rotations, expected.clip.rotations)
    np.testing.assert_array_equal(found.clip.translations, expected.clip.translations)


def test_keeps_spaces_in_joint_names(tmp_path: Path) -> None:
    motion = read_bvh(write(tmp_path, PERSON.replace("LeftFoot", "Bip01 L Foot")))
    assert motion.skeleton.names[1] == "Bip01 L Foot"


REFERENCE = """HIERARCHY
ROOT Reference
{
OFFSET 0 0 0
CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
JOINT Hips
{
OFFSET 0 1 0
CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
JOINT Head
{
OFFSET 0 0.7 0
CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
}
}
}
MOTION
Frames: 2
Frame Time: 0.1
"""


def test_carries_hips_that_move_below_a_moving_reference(tmp_path: Path) -> None:
    rows = "0 0 0 0 0 0  0 1 0 0 0 0  0 0.7 0 0 0 0\n5 0 1 0 90 0  0.2 1.1 3 0 0 10  0 0.7 0 20 0 0\n"
    path = write(tmp_path, REFERENCE + rows)
    motion = read_bvh(path, scale=1.0)
    assert motion.skeleton.root == 1
    assert motion.notes == ()
    np.testing.assert_allclose(world_positions(motion), slow_world_positions(path), atol=BOUND)


@pytest.mark.parametrize("ends", [(0.7, 0.9), (0.799, 0.801)])
def test_follows_bones_that_stretch(tmp_path: Path, ends: tuple[float, float]) -> None:
    rows = "".join(f"0 0 0 0 0 0  0 1 0 0 0 0  0 {end} 0 0 0 0\n" for end in ends)
    path = write(tmp_path, REFERENCE + rows)
    motion = read_bvh(path, scale=1.0)
    np.testing.assert_allclose(motion.skeleton.bind_translations[2], [0, 0.8, 0])
    np.testing.assert_allclose(world_positions(motion), slow_world_positions(path), atol=BOUND)
    assert motion.notes == ()


def test_adds_positions_that_are_deviations_from_the_offset(tmp_path: Path) -> None:
    rows = "0 0 0 0 0 0  0 0 0 0 0 0  0 0 0 0 0 0\n0 0 0 0 0 0  2 0 0 0 0 0  0 0 0 0 0 0\n"
    motion = read_bvh(write(tmp_path, REFERENCE + rows), scale=1.0)
    np.testing.assert_array_equal(motion.clip.translations[:, motion.skeleton.root], [[0, 1, 0], [2, 1, 0]])
    np.testing.assert_array_equal(motion.skeleton.bind_translations[2], [0, 0.7, 0])


def test_takes_positions_for_the_offset_that_starts_far_along_the_path(tmp_path: Path) -> None:
    """Hips below a reference, whose offset is where some frame stands: most frames are nearer to the origin."""
    text = REFERENCE.replace("OFFSET 0 1 0", "OFFSET 0 1 -40")
    assert text != REFERENCE
    for far in (-41, 1):
        rows = f"0 0 0 0 0 0  0 1 {far} 0 0 0  0 0.7 0 0 0 0\n0 0 0 0 0 0  0 1 3 0 0 0  0 0.7 0 0 0 0\n"
        motion = read_bvh(write(tmp_path, text + rows), scale=1.0)
        np.testing.assert_array_equal(world_positions(motion)[:, 1], [[0, 1, far], [0, 1, 3]])


def test_reads_utf_16(tmp_path: Path) -> None:
    path = write(tmp_path, PERSON)
    path.write_bytes(PERSON.replace("Head", "頭").encode("utf-16"))
    assert read_bvh(path).skeleton.names[3] == "頭"


@pytest.mark.parametrize("stated", [1, 3, 9999])
def test_reads_all_frames_where_the_file_miscounts_them_and_says_so(tmp_path: Path, stated: int) -> None:
    motion = read_bvh(write(tmp_path, PERSON.replace("Frames: 2", f"Frames: {stated}")))
    assert len(motion.clip) == 2
    assert f"holds 2 frames, though it says {stated}" in motion.notes[0]


def test_reads_frames_over_several_lines(tmp_path: Path) -> None:
    motion = read_bvh(write(tmp_path, PERSON.replace(" -20 30", "\n-20 30")))
    np.testing.assert_array_equal(motion.clip.rotations, read_bvh(write(tmp_path, PERSON)).clip.rotations)


def test_reads_headers_however_they_are_spaced(tmp_path: Path) -> None:
    spaced = PERSON.replace("Frames: 2", "frames :2").replace("Frame Time:", "FRAME   Time :")
    assert spaced != PERSON
    motion, plain = read_bvh(write(tmp_path, spaced)), read_bvh(write(tmp_path, PERSON))
    assert motion.clip.rate == plain.clip.rate
    np.testing.assert_array_equal(motion.clip.rotations, plain.clip.rotations)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("HIERARCHY", "HIERARCHIE", "HIERARCHY"),
        ("MOTION", "", "MOTION"),
        ("OFFSET 1 -9 0", "OFFSET 1 -9", "OFFSET of LeftFoot"),
        ("OFFSET 1 -9 0", "OFFSET 1 nine 0", "OFFSET of LeftFoot"),
        ("OFFSET 1 -9 0", "OFFSET 1 inf 0", "OFFSET of LeftFoot"),
        ("OFFSET 1 -9 0", "OFFSET 1 -9e99 0", r"the longest way along OFFSETs is 9e\+99, expected"),
        ("CHANNELS 1 Xrotation", "CHANNELS 2 Xrotation", "CHANNELS of Head"),
        ("CHANNELS 1 Xrotation", "CHANNELS", "CHANNELS of Head"),
        ("CHANNELS 1 Xrotation", "CHANNELS 1 Xscale", "xscale"),
        ("ROOT Hips\n{", "ROOT Hips", "found 'OFFSET 0 0 0'"),
        ("ROOT Hips", "JOINT Hips", "ROOT"),
        ("  JOINT Head", "  ROOT Head", "one ROOT"),
        ("}\nMOTION", "}\nROOT Other\n{\nOFFSET 0 0 0\n}\nMOTION", "save every person to a file"),
        ("}\nMOTION", "MOTION", "not closed"),
        ("}\nMOTION", "}\n}\nMOTION", "found '}'"),
        ("{\n  OFFSET 0 0 0", "{\n{\n  OFFSET 0 0 0", "found '{'"),
        ("0 9 0 0 0 0 0 0 0 0", "0 9 0 0 0 0 0 0 0", "2 frames of 10 values, found 19 values"),
        ("5 6 -7 45", "5 6 -7 45\n" + "0 " * 20, "2 frames of 10 values, found 40 values"),
        ("Frames: 2", "Frames: 0", "at least 1 frame"),
        ("Frames: 2", "Frames: 1.5", "at least 1 frame"),
        ("Frames: 2", "Frames: two", "Frames:"),
        ("Frames: 2", "Frames:", "Frames:"),
        ("Frames: 2\n", "", "Frames:"),
        ("Frame Time: 0.04", "Frame Time: 0", "Frame Time"),
        ("Frame Time: 0.04", "Frame Time: -1", "Frame Time"),
        ("Frame Time: 0.04", "Frame Time: 30", "Frame Time: expected seconds above 0 and up to 5, found 30"),
        ("Frame Time: 0.04\n", "", "Frame Time"),
        ("5 6 -7 45", "5 6 -7", "found 19 values"),
        ("5 6 -7 45", "5 6 -7 nan", "finite"),
        ("5 6 -7 45", "5 6 -7 x", "MOTION"),
    ],
)
def test_rejects_a_broken_file_in_a_sentence_that_names_it(tmp_path: Path, old: str, new: str, says: str) -> None:
    assert old in PERSON
    with pytest.raises(InputError, match=says) as error:
        read_bvh(write(tmp_path, PERSON.replace(old, new, 1)))
    assert "motion.bvh" in str(error.value)


def test_rejects_an_absent_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere\.bvh"):
        read_bvh(tmp_path / "nowhere.bvh")


def test_survives_truncation_at_every_offset(tmp_path: Path) -> None:
    whole = read_bvh(write(tmp_path, PERSON))
    refused = 0
    for end in range(len(PERSON)):
        try:
            read = read_bvh(write(tmp_path, PERSON[:end]))
        except InputError:
            refused += 1
            continue
        # Digits of the last number were lost, or whole frames, which a note reports.
        assert read.clip.rotations.shape == whole.clip.rotations.shape or "holds 1 frames" in read.notes[0]
    assert 0.9 * len(PERSON) < refused < len(PERSON)
