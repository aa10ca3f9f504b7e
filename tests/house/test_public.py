"""The names of `import mua`: accepted and refused arguments, and the packages they load."""

import ast
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar

import mua
from mua.avatar.camera import orbit, perspective
from mua.avatar.decode import box_of, decode_clip_frame
from mua.baking import pipeline
from mua.baking.listener import Listener
from mua.baking.settings import BakeSettings
from mua.pose.resample import resample
from mua.student.settings import preset

AVATAR = synthetic_avatar()
WAVE = AVATAR.clips[0]
WINDOW = [WAVE.pose(f) for f in (2, 1, 0)]
SPLATS = AVATAR.decode(WAVE.name, 2)


class Somewhere:
    """A path of another library."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def __fspath__(self) -> str:
        return str(self._path)


def test_every_public_name_is_there() -> None:
    assert set(mua.__all__) <= set(dir(mua))
    assert {*mua._PLACES, "InputError"} == set(mua.__all__)
    for name in mua.__all__:
        assert getattr(mua, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'lod'"):
        mua.lod  # noqa: B018 asking is the test


@pytest.mark.parametrize("kind", [str, Path, Somewhere])
def test_an_avatar_is_saved_and_loaded_by_any_kind_of_path(kind: Callable[[Path], Any], tmp_path: Path) -> None:
    path = kind(tmp_path / "a.muaavatar")
    mua.save(path, AVATAR, storage="f32")
    np.testing.assert_array_equal(mua.load(path).geometry.static, AVATAR.geometry.static)


def test_a_clip_is_decoded_by_its_name_by_itself_and_by_its_window() -> None:
    expected = decode_clip_frame(AVATAR, WAVE, frame=2).centres
    for decoded in (SPLATS, AVATAR.decode(WAVE, 2), AVATAR.decode(WINDOW)):
        np.testing.assert_array_equal(decoded.centres, expected)


def test_numpys_numbers_do_for_frames_and_names_for_element_types() -> None:
    frame: Any = np.int64(2)
    assert AVATAR.decode(WAVE.name, frame, dtype="float64").centres.dtype == np.float64


def test_quaternions_of_another_length_are_the_same_rotations() -> None:
    np.testing.assert_array_equal(AVATAR.decode(_turned(2.0)).centres, AVATAR.decode(_turned(4.0)).centres)


@pytest.mark.parametrize("rate", [10.0, 24.0, 60.0])
def test_a_clip_of_another_rate_is_resampled_to_the_avatars(rate: float) -> None:
    other = replace(WAVE, rate=rate)
    resampled = resample(other, AVATAR.encoding.rate)
    for frame in (0, 1, len(resampled) - 1):
        expected = AVATAR.decode(resampled, frame).centres
        np.testing.assert_array_equal(AVATAR.decode(other, frame).centres, expected)
    with pytest.raises(
        mua.InputError, match=f"frame is {len(resampled)}; clip .* has frames 0 to {len(resampled) - 1}"
    ):
        AVATAR.decode(other, len(resampled))


def test_a_picture_shows_all_splats_on_the_background() -> None:
    picture = np.asarray(mua.render(SPLATS, size=(48, 64), azimuth=30, elevation=10, background="#ff0000"))
    assert picture.shape == (64, 48, 3)
    assert picture.dtype == np.uint8
    np.testing.assert_array_equal(picture[0], np.tile([255, 0, 0], (48, 1)))
    assert (picture != [255, 0, 0]).any()


def test_a_camera_in_the_middle_of_the_head_sees_a_picture() -> None:
    """A user's camera, of float32 and with a size of numpy's numbers."""
    top = SPLATS.centres[SPLATS.centres[:, 1].argmax()]
    view = np.eye(4, dtype=np.float32)
    view[:3, 3] = -top
    camera = mua.Camera(view, perspective(0.9, aspect=1), (np.int64(24), 24))  # type: ignore[arg-type]
    assert np.asarray(mua.render(SPLATS, camera)).shape == (24, 24, 3)


def test_a_picture_turns_with_the_azimuth_in_degrees() -> None:
    front, left, back = (np.asarray(mua.render(SPLATS, size=(32, 32), azimuth=turn)) for turn in (0, 90, 360))
    np.testing.assert_array_equal(front, back)
    assert (front != left).any()


def _turned(scale: float = 1.0, **changes: Any) -> mua.Clip:
    return replace(WAVE, rotations=scale * WAVE.rotations, **changes)


def _seen(**changed: Any) -> mua.Camera:
    return replace(orbit(box_of(SPLATS.centres), screen=(16, 16)), **changed)


WRONG: dict[str, tuple[Callable[[], object], str]] = {
    "a number as path": (lambda: mua.load(3), r"path is 3 \(int\); expected a path, as a str or an os\.PathLike"),  # type: ignore[arg-type]
    "bytes as path": (lambda: mua.load(b"a"), "expected a path, as a str"),  # type: ignore[arg-type]
    "no path of any system": (lambda: mua.load("a\0b"), "expected a path, as a str"),
    "no such file": (lambda: mua.load("none.muaavatar"), r"none\.muaavatar: there is no such file"),
    "storage": (lambda: mua.save("a", AVATAR, storage="f8"), "storage is 'f8'; expected f32 or f16 or i8"),  # type: ignore[arg-type]
    "no avatar to save": (lambda: mua.save("a", "b"), "avatar is 'b'; expected a mua.Avatar"),  # type: ignore[arg-type]
    "an empty path": (lambda: mua.load(""), "path is ''; expected a path, as a str"),
    "weights without names": (
        lambda: AVATAR.decode("wave", expressions=[0.5]),  # type: ignore[arg-type]
        r"expressions is \[0\.5\] \(list\); expected weights by name",
    ),
    "clip name": (lambda: AVATAR.decode("jump"), "clip is 'jump'; the avatar holds 'wave'"),
    "no clip": (lambda: AVATAR.decode(7), r"clip is 7 \(int\); expected a clip's name"),  # type: ignore[arg-type]
    "frame too late": (lambda: AVATAR.decode("wave", 10**6), "frame is 1000000; clip 'wave' has frames 0 to"),
    "frame before the first": (lambda: AVATAR.decode("wave", -1), "frame is -1; clip 'wave' has frames 0 to"),
    "half a frame": (lambda: AVATAR.decode("wave", 0.5), r"frame is 0\.5 \(float\); expected a whole number"),  # type: ignore[arg-type]
    "truth as frame": (lambda: AVATAR.decode("wave", True), r"frame is True \(bool\)"),
    "element type": (lambda: AVATAR.decode("wave", dtype="int8"), "dtype is 'int8'; expected float32 or float64"),
    "unknown element type": (lambda: AVATAR.decode("wave", dtype="f17"), "dtype is 'f17'; expected"),
    "short window": (lambda: AVATAR.decode(WINDOW[:2]), "the window has 2 poses; expected 3, newest first"),
    "frame of a window": (lambda: AVATAR.decode(WINDOW, 1), "a window of poses has only frame 0"),
    "window of other things": (lambda: AVATAR.decode([1, 2, 3]), "expected a clip's name, a Clip or poses"),  # type: ignore[list-item]
    "joints of another skeleton": (
        lambda: AVATAR.decode([mua.Pose(np.ones((5, 4)) / 2, np.zeros((5, 3)))] * 3),
        r"rotations of a pose: the shape is \[5, 4\], expected \[3, 4\]",
    ),
    "translations of another length": (
        lambda: AVATAR.decode(_turned(translations=WAVE.translations[1:])),
        r"translations of clip 'wave': the shape is .*, expected \[",
    ),
    "no rotation": (lambda: AVATAR.decode(_turned(0.0)), "a quaternion is 0 0 0 0, expected a rotation"),
    "not finite": (lambda: AVATAR.decode(_turned(np.nan)), "rotations of clip 'wave': a value is not finite"),
    "rows of several lengths": (
        lambda: AVATAR.decode([mua.Pose([[1.0, 0, 0, 0], [1.0]], np.zeros((3, 3)))] * 3),  # type: ignore[arg-type]
        "rotations of a pose: not an array",
    ),
    "text as rotations": (
        lambda: AVATAR.decode([mua.Pose(np.full((3, 4), "a"), np.zeros((3, 3)))] * 3),
        "elements of type .*, expected real numbers",
    ),
    "a clip without frames": (lambda: AVATAR.decode(WAVE.cut(slice(0))), "clip 'wave' has no frames"),
    "a clip at rest": (lambda: AVATAR.decode(replace(WAVE, rate=0)), "rate of clip 'wave' is 0; expected 1 to 1000"),
    "no rate": (lambda: AVATAR.decode(replace(WAVE, rate=np.nan)), "rate of clip 'wave': a value is not finite"),
    "no splats": (lambda: mua.render(WAVE), "splats is <mua.Clip .*; expected what Avatar.decode returns"),  # type: ignore[arg-type]
    "colour": (lambda: mua.render(SPLATS, background="whitish"), "background is 'whitish'; expected a colour name"),
    "number as colour": (lambda: mua.render(SPLATS, background=3), r"background is 3 \(int\)"),  # type: ignore[arg-type]
    "one side": (lambda: mua.render(SPLATS, size=64), r"size is 64 \(int\); expected width and height"),  # type: ignore[arg-type]
    "empty image": (lambda: mua.render(SPLATS, size=(0, 64)), "expected sides of 1 to 8192 pixels"),
    "angle": (lambda: mua.render(SPLATS, azimuth=np.inf), "azimuth: a value is not finite"),
    "no camera": (lambda: mua.render(SPLATS, "front"), "camera is 'front'; expected a mua.Camera"),  # type: ignore[arg-type]
    "view of three rows": (
        lambda: mua.render(SPLATS, _seen(view=np.eye(3))),
        r"view of the camera: the shape is \[3, 3\]",
    ),
    "view that is none": (lambda: mua.render(SPLATS, _seen(view=np.full((4, 4), np.nan))), "a value is not finite"),
    "view that scales": (
        lambda: mua.render(SPLATS, _seen(view=np.diag([2.0, 2, 2, 1]))),
        "view of the camera: expected a rotation and a translation",
    ),
    "no perspective": (
        lambda: mua.render(SPLATS, _seen(projection=np.eye(4))),
        "projection of the camera: expected a perspective",
    ),
    "empty screen": (
        lambda: mua.render(SPLATS, _seen(screen=(0, 0))),
        "screen of the camera is .*; expected sides of 1",
    ),
    "camera and angle": (
        lambda: mua.render(SPLATS, mua.Camera(np.eye(4), np.eye(4), (64, 64)), azimuth=3),
        "camera is given together with size, azimuth or elevation",
    ),
}


WRONG_OPTIONS: dict[str, tuple[dict[str, Any], str]] = {
    "character": ({"character": 3}, r"character is 3 \(int\); expected a path"),
    "absent character": ({"character": "none.glb"}, r"none\.glb: there is no such file"),
    "motion": ({"motion": ["a.bvh", None]}, "motion is None; expected a path"),
    "absent motion": ({"motion": "none.bvh"}, r"--motion none\.bvh: there is no such file or directory"),
    "output": ({"output": "a.glb"}, r"-o a\.glb: expected a name that ends in \.muaavatar"),
    "preset": ({"preset": "huge"}, "preset: 'huge' is unknown, expected one of tiny, preview, paper"),
    "frames": ({"frames": "many"}, "frames is 'many'; expected a whole number"),
    "no frames": ({"frames": 0}, "--frames 0: expected at least 1"),
    "texels": ({"texels": 100}, "--texels 100: expected a multiple of 16 from 32 on"),
    "few texels": ({"texels": 16}, "--texels 16: expected a multiple of 16 from 32 on"),
    "half a texel": ({"texels": 64.5}, r"texels is 64\.5 \(float\); expected a whole number"),
    "held-out clip": ({"hold_out": [1]}, r"hold_out is \[1\] \(list\); expected a name or a list of names"),
    "clips": ({"clips": 0.5}, r"clips is 0\.5 \(float\); expected a name or a list of names"),
    "mapping": ({"mapping": 3}, r"mapping is 3 \(int\); expected a path"),
    "feet": ({"feet": "glue"}, "feet is 'glue'; expected auto or keep or plant"),
    "uv": ({"uv": "cut"}, "uv is 'cut'; expected keep or unwrap or auto"),
    "detail": ({"detail": {"nose": 2}}, "--detail nose=2: expected a part and a factor"),
    "height": ({"height": "tall"}, "height: has elements of type .*, expected real numbers"),
    "storage": ({"storage": "f8"}, "storage is 'f8'; expected f32 or f16 or i8"),
    "seed": ({"seed": -1}, "--seed -1: expected 0 or more"),
    "device": ({"device": "tpu"}, "device is 'tpu'; expected auto or cpu or cuda"),
    "jobs": ({"jobs": 0}, "--jobs 0: expected at least 1"),
    "work": ({"work": 3}, r"work is 3 \(int\); expected a path"),
}


@pytest.mark.parametrize("wrong", WRONG_OPTIONS)
def test_a_bake_refuses_a_wrong_option_in_a_sentence(wrong: str) -> None:
    options, sentence = WRONG_OPTIONS[wrong]
    with pytest.raises(mua.InputError, match=sentence):
        mua.bake(**options)


def test_a_bake_gets_the_settings_that_its_options_say(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Python's log also gets what the command prints."""
    given: list[BakeSettings] = []

    def carry_out(settings: BakeSettings, listener: Listener) -> None:
        given.append(settings)
        listener.note("A note.")
        for stage in ("geometry", "appearance", "geometry"):  # take turns
            listener.stage(stage)

    monkeypatch.setattr(pipeline, "bake", carry_out)
    monkeypatch.chdir(tmp_path)
    Path("walk.bvh").write_text("HIERARCHY")
    motion: dict[str, Any] = {"motion": "walk.bvh", "mapping": {"a": "b"}}
    with caplog.at_level("INFO"):
        mua.bake(output=Path("a.muaavatar"), clips=2, hold_out="turn", detail={"head": 3}, texels=64, **motion)
    (settings,) = given
    assert (settings.output, settings.work, settings.clips) == (Path("a.muaavatar"), Path("a.work"), ("2",))
    assert (settings.hold_out, settings.detail, settings.mapping) == (("turn",), {"head": 3}, {"a": "b"})
    assert settings.student == replace(preset("preview"), texels=64)
    assert caplog.messages == ["A note.", "geometry", "appearance"]


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({}, r"nothing/here: there is no such directory"),
        ({"recording": 3}, r"recording is 3 \(int\); expected a directory or a mua\.Recording"),
        ({"stage": "fine"}, "stage is 'fine'; expected None or coarse or bases"),
        ({"storage": "f8"}, "storage is 'f8'; expected"),
        ({"seed": 0.5}, r"seed is 0\.5 \(float\); expected a whole number"),
        ({"recipe": "own"}, "recipe: 'own' is unknown"),
    ],
)
def test_a_training_refuses_a_wrong_option_in_a_sentence(options: dict[str, Any], sentence: str) -> None:
    with pytest.raises(mua.InputError, match=sentence):
        mua.train(**({"recording": "nothing/here"} | options))


RIG, STILL = AVATAR.rig, AVATAR.rig.skeleton.bind_pose
WRONG_WRITING: dict[str, tuple[dict[str, Any], str]] = {
    "directory": ({"directory": 3}, r"directory is 3 \(int\); expected a path"),
    "rig": ({"rig": "hero"}, "rig is 'hero'; expected a mua"),
    "rate": ({"rate": "fast"}, "rate is fast, expected 1 to 1000 frames per second"),
    "shard": ({"shard_frames": 0}, "shard_frames is 0, expected at least 1"),
    "clip": ({"clip": 3}, r"the clip's name is 3 \(int\); expected a text"),
    "pose": ({"pose": (0, 1)}, r"pose is \(0, 1\) \(tuple\); expected a mua\.Pose"),
    "mesh": ({"mesh": "tube"}, "mesh is no array of numbers, expected one of the shape"),
    "texture": ({"texture": [[1.0], [1.0, 2.0]]}, "texture is no array that numpy reads"),
    "text as texture": ({"texture": "red"}, "texture has elements of type .*, expected real numbers"),
}


@pytest.mark.parametrize("wrong", WRONG_WRITING)
def test_a_writer_refuses_what_is_no_frame(wrong: str, tmp_path: Path) -> None:
    given: dict[str, Any] = {"directory": tmp_path, "rig": RIG, "rate": 24.0, "clip": "wave", "pose": STILL}
    given |= {"mesh": RIG.mesh.vertices, "texture": np.zeros((len(RIG.texels.texels), 23)), "shard_frames": 32}
    given |= WRONG_WRITING[wrong][0]

    def write() -> None:
        options = {name: given[name] for name in ("rate", "shard_frames")}
        with mua.TeacherWriter(given["directory"], given["rig"], **options) as writer:
            writer.start_clip(given["clip"])
            writer.add(given["pose"], given["mesh"], given["texture"])

    with pytest.raises(mua.InputError, match=WRONG_WRITING[wrong][1]):
        write()


def test_a_recording_refuses_frames_that_it_does_not_hold(written: Path) -> None:
    recording = mua.Recording(Somewhere(written))
    count = recording.count()
    assert repr(recording).startswith(f"<mua.Recording '{written}': {count} training and ")
    for rows in ([count], [-1]):
        with pytest.raises(mua.InputError, match=rf"row {rows[0]}, but it holds {count} training frames"):
            recording.meshes(rows)
        with pytest.raises(mua.InputError, match=f"row {rows[0]}"):
            recording.subbands(slice(0, 11), rows)
    with pytest.raises(mua.InputError, match=r"frame is 10000; clip '\w+' has frames 0 to"):
        recording.clips[0].pose(10000)


@pytest.mark.parametrize("wrong", WRONG)
def test_a_wrong_call_ends_in_a_sentence(wrong: str) -> None:
    call, sentence = WRONG[wrong]
    with pytest.raises(mua.InputError, match=sentence) as raised:
        call()
    assert "\n" not in str(raised.value)


def test_an_avatar_says_what_it_is_in_a_line() -> None:
    assert repr(AVATAR) == (
        f"<mua.Avatar 'synthetic': 3 joints, 12 vertices, {len(SPLATS)} splats of 32 x 32 texels, 1 clip>"
    )
    assert repr(WAVE) == f"<mua.Clip 'wave': {len(WAVE)} frames at {WAVE.rate:g} a second, 3 joints>"
    assert repr(SPLATS) == f"<mua.Splats: {len(SPLATS)} splats, float32>"


def test_records_that_hold_arrays_are_compared_by_identity() -> None:
    """Arrays compare element by element: an equality made of them fails, and a hash does too."""
    wrong = []
    for path in sorted(Path(mua.__file__).parent.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ClassDef) and _is_record_of_arrays(node):
                written = " ".join(map(ast.unparse, node.decorator_list))
                if "eq=False" not in written:
                    wrong.append(f"{path.name}: {node.name}")
    assert wrong == []
    assert replace(AVATAR) != AVATAR
    assert len({AVATAR, AVATAR}) == 1


def _is_record_of_arrays(node: ast.ClassDef) -> bool:
    fields = [ast.unparse(line.annotation) for line in node.body if isinstance(line, ast.AnnAssign)]
    holds = any(kind in field for field in fields for kind in ("Array", "Tensor", "ndarray"))
    return holds and any("dataclass" in ast.unparse(decorator) for decorator in node.decorator_list)
