"""Facial motion: of Live Link Face, Audio2Face and poses with a face, and weights on a character's own expressions."""

import json
from pathlib import Path
from typing import Any

import gltf_files
import numpy as np
import pytest
from people import person, walk

from mua.arrays import Array
from mua.errors import InputError
from mua.motion.face import read_face, with_face
from mua.motion.load import load_motions
from mua.motion.poses_file import read_poses, write_poses
from mua.pose.clip import Clip

NAMES = ("EyeBlinkLeft", "JawOpen", "HeadYaw")


def recording(
    path: Path, weights: Array, codes: list[str] | None = None, header: str = "Timecode,BlendShapeCount"
) -> Path:
    codes = codes or [f"14:44:{18 + k // 60:02}:{k % 60:02}.123" for k in range(len(weights))]
    lines = [",".join([header, *NAMES])]
    lines += [f"{code},61,{','.join(map(str, row))}" for code, row in zip(codes, weights.tolist(), strict=True)]
    path.write_text("\n".join(lines) + "\n")
    return path


def standing(frames: int, rate: float = 30.0) -> Clip:
    skeleton = person()
    shape = (frames, 1, 1)
    return Clip("stand", rate, np.tile(skeleton.bind_rotations, shape), np.tile(skeleton.bind_translations, shape))


def test_reads_a_recording_of_live_link_face(tmp_path: Path) -> None:
    weights = np.linspace(0, 1, 90)[:, None] * [1, 0.5, 2]
    face = read_face(recording(tmp_path / "talk.csv", weights))
    assert (face.rate, face.names) == (60.0, NAMES[:2])  # the head's turn is no expression
    np.testing.assert_allclose(face.weights, weights[:, :2])


def test_fills_frames_that_the_phone_dropped(tmp_path: Path) -> None:
    codes = ["00:00:00:58", "00:00:00:59", "00:00:01:02", "00:00:01:03"]
    face = read_face(recording(tmp_path / "talk.csv", np.array([[0, 0, 0], [0, 0, 0], [0.9, 0, 0], [1, 0, 0]]), codes))
    np.testing.assert_allclose(face.weights[:, 0], [0, 0, 0.3, 0.6, 0.9, 1])


def test_weights_are_held_to_0_and_1(tmp_path: Path) -> None:
    face = read_face(recording(tmp_path / "talk.csv", np.array([[-0.1, 1.2, 0]])))
    np.testing.assert_array_equal(face.weights, [[0, 1]])


def assert_refused(path: Path, text: str, sentence: str) -> None:
    path.write_text(text)
    with pytest.raises(InputError, match=sentence) as error:
        read_face(path)
    assert str(path) in str(error.value)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "the first line is '', expected Timecode,BlendShapeCount, then names"),
        ("frame,a,b\n1,2,3\n", "the first line is 'frame,a,b', expected Timecode"),
        ("Timecode,BlendShapeCount,JawOpen\n", "holds no frame"),
        ("Timecode,BlendShapeCount,JawOpen\n0:0:0:1,61\n", "line 2 holds 2 values, expected the 3 of the first line"),
        ("Timecode,BlendShapeCount,JawOpen\n0:0:0:1,61,x\n", "line 2: JawOpen is 'x', expected a finite number"),
        ("Timecode,BlendShapeCount,JawOpen\n0:0:0:1,61,nan\n", "line 2: JawOpen is 'nan', expected a finite number"),
        ("Timecode,BlendShapeCount,JawOpen\n0:0:1,61,0\n", "line 2: Timecode is '0:0:1', expected hours:minutes"),
        ("Timecode,BlendShapeCount,JawOpen\n0:0:0:99,61,0\n", "counts 99 frames in a second, expected less than 60"),
        ("Timecode,BlendShapeCount,JawOpen\n0:0:0:2,61,0\n0:0:0:2,61,0\n", "line 3: the timecode 0:0:0:2 does not"),
    ],
)
def test_a_damaged_recording_is_a_sentence(tmp_path: Path, text: str, sentence: str) -> None:
    assert_refused(tmp_path / "talk.csv", text, sentence)


def audio2face(**changed: Any) -> str:
    exported = {"exportFps": 60.0, "numPoses": 2, "numFrames": 2, "facsNames": ["jawOpen", "eyeBlinkLeft"]}
    return json.dumps(exported | {"weightMat": [[0.25, 0], [1.5, 0.5]]} | changed)


def test_reads_a_face_of_audio2face(tmp_path: Path) -> None:
    path = tmp_path / "talk.json"
    path.write_text(audio2face())
    face = read_face(path)
    assert (face.rate, face.names) == (60.0, ("jawOpen", "eyeBlinkLeft"))
    np.testing.assert_array_equal(face.weights, [[0.25, 0], [1, 0.5]])


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("{", "cannot be read as JSON"),
        ("[]", "holds no exportFps; expected a face of Audio2Face with exportFps, facsNames, weightMat"),
        (audio2face(exportFps=0), "exportFps is 0, expected"),
        (audio2face(facsNames=[1, 2]), "facsNames is .*, expected a list of names"),
        (audio2face(weightMat=[]), "weightMat"),
        (audio2face(weightMat=[[0.5]]), "weightMat"),
        (audio2face(weightMat=[[0.5, None]]), "weightMat"),
    ],
)
def test_a_damaged_face_of_audio2face_is_a_sentence(tmp_path: Path, text: str, sentence: str) -> None:
    assert_refused(tmp_path / "talk.json", text, sentence)


def test_a_face_is_put_on_a_body_at_its_rate(tmp_path: Path) -> None:
    path = recording(tmp_path / "talk.csv", np.linspace(0, 1, 121)[:, None] * [1, 0.5, 0])
    (clip,), notes = with_face([standing(90)], path, ("blinkLeft", "aa", "Smoking"))
    assert clip.expressions is not None
    np.testing.assert_allclose(clip.expressions[30], [0.5, 0.25, 0])
    np.testing.assert_allclose(clip.expressions[60], [1, 0.5, 0])
    assert not clip.expressions[61:].any()  # the face ends after two seconds
    assert notes == []
    _, notes = with_face([standing(3)], path, ("jawOpen",))
    assert notes == ["talk.csv: the character has no expression for EyeBlinkLeft."]
    with pytest.raises(InputError, match="of which the character has none; it has Smoking"):
        with_face([standing(3)], path, ("Smoking",))


def test_motion_without_a_face_is_refused_as_one(tmp_path: Path) -> None:
    write_poses(tmp_path / "walk.npz", person(), walk(person()))
    with pytest.raises(InputError, match="no clip moves an expression, expected a face"):
        read_face(tmp_path / "walk.npz")


def test_poses_keep_their_face(tmp_path: Path) -> None:
    weights = np.linspace(0, 1, 6).reshape(3, 2)
    body = standing(3)
    clip = Clip("talk", 30.0, body.rotations, body.translations, expressions=weights)
    write_poses(tmp_path / "talk.npz", person(), clip, expressions=("jawOpen", "blink"))
    source = read_poses(tmp_path / "talk.npz")
    assert source.expressions == ("jawOpen", "blink")
    np.testing.assert_array_equal(np.asarray(source.clip.expressions), weights)
    (loaded,) = load_motions(
        tmp_path / "talk.npz",
        person(),
        mapping=None,
        rate=30.0,
        face=("eyeBlinkLeft", "eyeBlinkRight", "aa"),
    )
    np.testing.assert_allclose(np.asarray(loaded.clip.expressions), weights[:, [1, 1, 0]])
    with np.load(tmp_path / "talk.npz") as file:
        arrays: dict[str, Any] = dict(file)
    for change, sentence in (
        ({"expressions": weights[:2]}, "expressions"),
        ({"expressions": np.full((3, 2), np.nan)}, "expressions"),
        ({"expressions": None}, "has expression_names alone"),
    ):
        np.savez(tmp_path / "bad.npz", **{k: v for k, v in (arrays | change).items() if v is not None})
        with pytest.raises(InputError, match=sentence):
            read_poses(tmp_path / "bad.npz")


def test_a_clip_of_another_rig_brings_its_face(tmp_path: Path) -> None:
    glb = gltf_files.body()
    gltf_files.primitive(glb)["targets"] = [{"POSITION": glb.accessor(np.tile([0.1, 0, 0], (16, 1)))}]
    glb.json["meshes"][0]["extras"] = {"targetNames": ["viseme_aa"]}
    sampler = {"input": glb.accessor(np.array([0.0, 1.0])), "output": glb.accessor(np.array([[0.0], [1.0]]))}
    channel = {"sampler": 0, "target": {"node": 3, "path": "weights"}}
    glb.json["animations"] = [{"name": "talk", "samplers": [sampler], "channels": [channel]}]
    path = glb.save(tmp_path / "talk.glb")
    (clip,), _ = with_face([standing(31)], path, ("jawOpen",))
    np.testing.assert_allclose(np.asarray(clip.expressions)[:, 0], 0.7 * np.linspace(0, 1, 31), atol=1e-6)
