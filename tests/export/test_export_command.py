"""mua-export writes the requested files, all of them or none, and refuses wrong requests in a sentence."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from bvh_files import BVH
from commands import Commands, python
from splat_viewer import read_by_gaussforge, read_ply
from synthetic_avatar import synthetic_avatar

import mua
from mua.cli.export_files import parse_numbers
from mua.errors import InputError
from mua.export import formats
from mua.export.sequence import file_names, write_all
from mua.export.splats import morton_order

FRAMES = 7  # frames of the synthetic avatar's clip
STEPS = 1023  # steps of 10 bits, the fewest that any format has for a coordinate


def test_the_ending_says_which_format_and_the_command_what_was_written(
    command: Commands, avatar_file: Path, tmp_path: Path
) -> None:
    count = len(synthetic_avatar().rig.texels.texels)
    for name in ("a.ply", "a.compressed.ply", "a.spz"):
        ended = command("export", avatar_file, "-o", tmp_path / name)
        assert (ended.status, ended.err) == (0, "")
        size = (tmp_path / name).stat().st_size
        assert ended.out == f"{tmp_path / name}: {count} splats, {size / 1e3:.1f} KB\n"
        kind = name.removeprefix("a.")
        assert len(read_by_gaussforge(tmp_path / name, kind).centres) == count


@pytest.mark.parametrize(("axes", "turn"), [((), [-1, -1, 1]), (("--axes", "y-up"), [1, 1, 1])])
def test_splats_of_all_formats_stand_alike_y_down_unless_asked(
    command: Commands, avatar_file: Path, tmp_path: Path, axes: tuple[str, ...], turn: list[int]
) -> None:
    shown = mua.load(avatar_file).decode("wave", 0).centres * turn
    for kind in ("ply", "compressed.ply", "spz"):
        command("export", avatar_file, "-o", tmp_path / f"a.{kind}", *axes)
        found = read_by_gaussforge(tmp_path / f"a.{kind}", kind).centres
        order = morton_order(shown.astype(np.float32)) if kind == "compressed.ply" else slice(None)
        np.testing.assert_allclose(found, shown[order], atol=np.ptp(shown, axis=0).max() / STEPS)


@pytest.mark.parametrize(
    ("output", "frames", "names"),
    [
        ("seq", "2:6:2", ["frame_0002.ply", "frame_0004.ply"]),
        ("s_%d.spz", "5:", ["s_5.spz", "s_6.spz"]),
        ("s_%03d.ply", None, [f"s_{k:03}.ply" for k in range(FRAMES)]),
    ],
)
def test_a_sequence_has_a_file_for_each_frame(
    command: Commands, avatar_file: Path, tmp_path: Path, output: str, frames: str | None, names: list[str]
) -> None:
    asked = () if frames is None else ("--frames", frames)
    ended = command("export", avatar_file, "-o", tmp_path / "new" / output, *asked)
    assert (ended.status, ended.err) == (0, "")
    folder = tmp_path / "new" / ("seq" if output == "seq" else "")
    assert sorted(path.name for path in folder.iterdir()) == names
    assert f"{len(names)} files of" in ended.out


def test_frames_of_a_sequence_are_those_of_the_clip(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    command("export", avatar_file, "-o", tmp_path / "f_%d.ply", "--frames", "1:6:3", "--axes", "y-up")
    avatar = mua.load(avatar_file)
    for number in (1, 4):
        posed = avatar.decode("wave", number)
        np.testing.assert_array_equal(read_ply(tmp_path / f"f_{number}.ply").centres, posed.centres)


def test_a_sequence_that_fails_leaves_nothing_behind(
    command: Commands, avatar_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = []

    def fail_at_the_third(*_: object) -> bytes:
        made.append(1)
        if len(made) == 3:
            raise InputError("no more")
        return b"x"

    monkeypatch.setitem(formats.SPLAT_FORMATS, ".ply", fail_at_the_third)
    (tmp_path / "f_0.ply").write_bytes(b"old")
    ended = command("export", avatar_file, "-o", tmp_path / "f_%d.ply")
    assert ended.sentence == "error: no more"
    assert [path.name for path in tmp_path.iterdir()] == ["f_0.ply"]
    assert (tmp_path / "f_0.ply").read_bytes() == b"old"


def test_a_failed_write_is_reported_and_leaves_nothing_behind(tmp_path: Path) -> None:
    (tmp_path / "b").mkdir()
    with pytest.raises(InputError, match=r"b: cannot be written \(.*\)"):
        write_all((tmp_path / name, b"x") for name in ("b", "c"))
    assert [path.name for path in tmp_path.iterdir()] == ["b"]


def test_a_clip_is_chosen_by_its_name(command: Commands, avatar_files: tuple[Path, ...], tmp_path: Path) -> None:
    file = avatar_files[1]
    command("export", file, "-o", tmp_path / "b.ply", "--clip", "twice", "--frames", "8", "--axes", "y-up")
    np.testing.assert_array_equal(read_ply(tmp_path / "b.ply").centres, mua.load(file).decode("twice", 8).centres)


def test_a_mapping_says_which_joint_moves_and_a_name_which_of_several_motions(
    command: Commands, avatar_file: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "motions"
    folder.mkdir()
    (folder / "nod.bvh").write_text(BVH.replace("spine", "thing"))
    (folder / "still.bvh").write_text(re.sub(r"[12]0 0 0$", "0 0 0", BVH.replace("spine", "thing"), flags=re.M))
    centres = {}
    for joint in ("middle", "tip"):
        (tmp_path / f"{joint}.json").write_text(json.dumps({"root": "hips", joint: "thing"}))
        for clip in ("nod", "still"):
            more = ("--motion", folder, "--mapping", tmp_path / f"{joint}.json", "--clip", clip, "--frames", 4)
            ended = command("export", avatar_file, "-o", tmp_path / "b.ply", *more)
            assert ended.status == 0, ended.err
            assert "joints" in ended.err, "how the joints match is reported"
            centres[joint, clip] = read_ply(tmp_path / "b.ply").centres
    assert len({found.tobytes() for found in centres.values()}) == len(centres)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ((), "-o is not given; expected a directory or a name that ends in"),
        (("-o", "a.obj"), "-o is a.obj; expected a directory or a name that ends in .compressed.ply, .ply"),
        (("-o", "a.ply", "--what", "mesh"), "--what is 'mesh'; a .ply file holds splats"),
        (("-o", "a.ply", "--axes", "z-up"), "--axes is 'z-up'; expected y-up or y-down"),
        (("-o", "a.ply", "--mapping", "m.json"), "--mapping: works only with --motion, which is not given"),
        (("-o", "a.ply", "--clip", "run"), "--clip is 'run'; "),
        (("-o", "a.glb", "--clip", "wave", "--clip", "run"), "--clip is given 2 times; a file holds one clip"),
        (("-o", "a.ply", "--frames", "0:3"), "-o is a.ply, one file, but --frames 0:3 names 3 frames; "
         "expected a directory or a name such as a_%04d.ply"),
        (("-o", "a.ply", "--frames", "7"), "--frames is '7'; clip 'wave' has frames 0 to 6"),
        (("-o", "a_%s_%d.ply", "--frames", "0:3"), "-o is a_%s_%d.ply; expected one place for the number of the frame"),
    ],
)  # fmt: skip
def test_rejects_a_wrong_option(
    command: Commands,
    avatar_file: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    options: tuple[str, ...],
    sentence: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert command("export", avatar_file, *options).sentence.startswith(f"error: {sentence}")
    assert list(tmp_path.iterdir()) == []


def test_frames_are_parsed() -> None:
    clip = synthetic_avatar().clips[0]
    for text, numbers in (("3", [3]), ("2:5", [2, 3, 4]), (":4:3", [0, 3]), ("5:", [5, 6]), ("::3", [0, 3, 6])):
        assert list(parse_numbers(text, clip)) == numbers
    for text in ("", "a", "1:2:3:4", "-1", "3:3", "0:8", "0:4:0"):
        with pytest.raises(InputError, match=f"--frames is '{text}'"):
            parse_numbers(text, clip)


def test_names_need_one_place_for_the_number() -> None:
    assert file_names(Path("a/b_%02d.ply"), range(3, 5), suffix=".ply") == [Path("a/b_03.ply"), Path("a/b_04.ply")]
    for name in ("b_%s%d.ply", "b_%.ply", "b_%%.ply", "b_%q.ply", "b_%.0s.ply"):
        with pytest.raises(InputError, match="expected one place for the number of the frame"):
            file_names(Path(name), range(2), suffix=".ply")


def test_splats_need_no_extra(avatar_file: Path, tmp_path: Path) -> None:
    from bare_python import run_bare

    code = "sys.argv[0] = 'mua-export'\nfrom mua.cli.export import run\nrun()"
    for name in ("a.ply", "a.compressed.ply", "a.spz"):
        ended = run_bare(code, avatar_file, "-o", tmp_path / name)
        assert (ended.status, ended.err) == (0, "")


def test_options_are_completed() -> None:
    line = {"_MUA_EXPORT_COMPLETE": "complete_bash", "COMP_WORDS": "mua-export --axes ", "COMP_CWORD": "2"}
    ended = python("sys.argv[0] = 'mua-export'; from mua.cli.export import run; run()", **line)
    assert ended.out.split() == ["y-up", "y-down"]
