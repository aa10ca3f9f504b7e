"""The editor imports sound and unsound files, shows them, and places avatars by menu and drop."""

import io
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from csharp import PROGRAMS, ROOT, CSharp
from frame_bounds import FRAME_ORDER
from package_compiler import Compiler, assemblies
from PIL import Image
from synthetic_avatar import synthetic_avatar, with_expressions
from training import outside_of_training

from mua.asset import write

Reports = dict[str, list[list[str]]]
Story = Callable[..., Reports]


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> Path:
    """Named as the assembly that may see the package's internals."""
    compiler, known = Compiler(csharp, "editor", packages=False), assemblies()
    package = [name for name in known["Mua.Avatar.Editor"].references if name in known]
    references = [compiler.built(name) for name in ("UnityEngine", "UnityEditor", *package, "Mua.Avatar.Editor")]
    return csharp.build(
        [PROGRAMS / "shared" / "PackageResources.cs", *PROGRAMS.glob("Importer*.cs")],
        name="Mua.Avatar.Editor.Tests",
        references=references,
    )


@pytest.fixture
def story(csharp: CSharp, program: Path) -> Story:
    def tell(name: str, *files: Path) -> Reports:
        reported: Reports = {"log": [], "dialog": [], "undo": [], "saved": [], "object": []}
        for line in csharp.run(program, ROOT / "ComputeShaders", name, *files).splitlines():
            key, *values = line.split("\t")
            reported.setdefault(key, []).append(values)
        return reported

    return tell


@pytest.fixture
def sound(tmp_path: Path) -> Path:
    """An avatar with a thumbnail of 30 x 40."""
    stream = io.BytesIO()
    Image.fromarray(np.zeros((40, 30, 3), np.uint8)).save(stream, "PNG")
    path = tmp_path / "Walking Woman.muaavatar"
    write(path, replace(synthetic_avatar(), thumbnail=stream.getvalue()), storage="f16")
    return path


def test_a_sound_file_becomes_an_asset_of_its_bytes(story: Story, sound: Path) -> None:
    reported = story("Imports", sound)
    assert reported["asset"] == [["Walking Woman", str(sound.stat().st_size), "", "thumbnail avatar", "30 x 40"]]
    assert reported["error"] == [[""]]
    assert reported["summary"] == [["synthetic"]]
    assert reported["textures"] == [["1", "1"]]  # one, without smaller copies of itself
    kept = story("Keeps", sound)
    assert [kept[key] for key in ("content", "summary", "thumbnail")] == [[["True"]]] * 3


def test_a_file_inside_a_package_is_imported(story: Story, sound: Path) -> None:
    reported = story("ImportsFromPackage", sound)
    assert reported["asset"] == story("Imports", sound)["asset"]
    assert reported["error"] == [[""]]


@pytest.mark.parametrize("thumbnail", [b"", b"\x89PNG\r\n\x1a\n and nothing"], ids=["none", "no picture"])
def test_a_file_without_a_thumbnail_has_the_editors_own_icon(story: Story, tmp_path: Path, thumbnail: bytes) -> None:
    path = tmp_path / "a.muaavatar"
    write(path, replace(synthetic_avatar(), thumbnail=thumbnail), storage="f32")
    reported = story("Imports", path)
    [asset] = reported["asset"]
    assert reported["textures"] == [["0", "0"]]
    assert asset == ["a", str(path.stat().st_size), "", "avatar", ""]
    assert story("Inspects", path)["gui"][0] == ["title synthetic"]


def test_an_unsound_file_becomes_an_asset_that_says_why(story: Story, sound: Path) -> None:
    """One import error with file, field and value, and no exception."""
    avatar = synthetic_avatar()
    write(sound, replace(avatar, name="x" * 20))
    sound.write_bytes(sound.read_bytes().replace(b"x" * 20, b"\xff" * 20))
    reported = story("Imports", sound)
    assert reported["log"] == []
    [[name, length, fault, parts, icon]] = reported["asset"]
    assert (name, length, parts, icon) == (sound.stem, "0", "avatar", "")
    assert fault == "name: the text is not UTF-8"
    assert reported["error"] == [[f"MUA: {sound}: {fault}."]]


def test_an_empty_file_and_one_that_vanishes_say_so(story: Story, tmp_path: Path) -> None:
    empty, gone, folder = (tmp_path / f"{name}.muaavatar" for name in ("empty", "gone", "folder"))
    empty.touch()
    folder.mkdir()
    reported = story("Imports", empty, gone, folder)
    faults = [asset[2] for asset in reported["asset"]]
    assert "0 bytes" in faults[0]
    assert all("cannot be read" in fault for fault in faults[1:])
    assert all(error.count("|") == 0 and error.startswith("MUA: ") for [error] in reported["error"])
    assert reported["log"] == []


def test_the_inspector_shows_tables_or_the_fault(story: Story, sound: Path, tmp_path: Path) -> None:
    lines = [line for [line] in story("Inspects", sound)["gui"]]
    assert lines[:4] == ["texture 30 x 40", "title synthetic", "label format", lines[3]]
    assert [line for line in lines if line.startswith("title")][-1] == "title 1 clip"
    assert "label geometry ranks" in lines
    bad = tmp_path / "bad.muaavatar"
    bad.write_bytes(sound.read_bytes()[:100])
    [[line]] = story("Inspects", bad)["gui"]
    assert line.startswith("Error ")


def test_the_demo_scene_shows_the_avatar_to_its_camera(story: Story, sound: Path) -> None:
    reported = story("MakesScene", sound)
    objects = {name: (kinds, [float(value) for value in numbers]) for name, kinds, *numbers, _ in reported["object"]}
    assert {name: kinds for name, (kinds, _) in objects.items()} == {
        "Ground": "MeshFilter MeshRenderer",
        "Sun": "Light",
        "Main Camera": "Camera",
        "Walking Woman": "AvatarRenderer",
    }
    camera = objects["Main Camera"][1]
    assert camera[2] > 3  # in front of the character, which looks along +Z and is 3 m tall
    assert camera[3:] == pytest.approx([0, 0, -1], abs=1e-5)
    assert objects["Sun"][1][4] < 0  # shines down
    assert reported["shows"] == [["Walking Woman"]]
    assert reported["selected"] == [["Walking Woman"]]
    assert reported["saved"] == [["Assets/MUA Demo.unity"]]
    assert reported["dialog"] == []


def test_a_demo_scene_is_not_replaced_without_consent(story: Story, sound: Path) -> None:
    reported = story("KeepsScene", sound)
    assert (reported["object"], reported["saved"]) == ([], [])
    assert reported["dialog"] == [["Assets/MUA Demo.unity exists. Replace it?"]]


def test_without_an_avatar_the_menu_says_what_to_do(story: Story, tmp_path: Path) -> None:
    reported = story("HasNoAvatar")
    assert (reported["object"], reported["saved"]) == ([], [])
    assert ".muaavatar" in reported["dialog"][0][0]
    unsound = tmp_path / "bad.muaavatar"
    unsound.touch()
    assert story("MakesScene", unsound)["dialog"] == reported["dialog"]


def test_an_avatar_is_made_below_the_object_clicked_and_can_be_undone(story: Story, sound: Path) -> None:
    reported = story("MakesObject", sound)
    [made] = [thing for thing in reported["object"] if thing[0] == "Walking Woman"]
    assert [made[1], made[-1]] == ["AvatarRenderer", "parent"]
    assert [float(value) for value in made[2:5]] == [1, 2, 3]
    assert reported["undo"] == [["Create Walking Woman"]]
    assert reported["selected"] == [["Walking Woman"]]
    assert [thing[0] for thing in story("MakesObject")["object"]] == ["parent", "MUA Avatar"]


def test_a_second_avatar_has_another_name_and_lies_in_the_stage_that_is_open(story: Story, sound: Path) -> None:
    reported = story("MakesTwins", sound)
    assert [thing[0] for thing in reported["object"]] == [
        "parent",
        "Walking Woman",
        "Walking Woman (1)",
        "Walking Woman",
    ]
    assert reported["staged"] == [["Walking Woman"], ["Walking Woman"]]


def test_an_avatar_is_dropped_into_the_scene(story: Story, sound: Path) -> None:
    reported = story("Drops", sound)
    assert (reported["hover"], reported["other"], reported["drop"]) == ([["Copy", "0"]], [["None", "None"]], [["Copy"]])
    [made] = reported["object"]
    assert [float(value) for value in made[2:5]] == [1, 0, 2]


def test_an_avatar_is_dropped_on_the_hierarchy(story: Story, sound: Path) -> None:
    reported = story("DropsOnRows", sound)
    assert reported["drop"] == [["Copy"]] * 4
    assert reported["parent"] == [["row", "3"], ["row", "3"], ["none", "0"], ["row", "3"]]
    assert reported["other"] == [["None"]]


def test_the_scene_view_frames_and_picks_what_is_drawn(story: Story, sound: Path) -> None:
    reported = story("IsFramed", sound)
    assert (reported["one"], reported["both"]) == ([["True", "True"]], [["True", "True"]])
    assert (reported["clicked"], reported["empty"]) == ([["1", "True"]], [["1", "False"]])


def test_an_opened_prefab_is_apart_from_the_scene(story: Story, sound: Path) -> None:
    """The scene view shows the avatars of the prefab, the game view those of the scene, with shadows."""
    count = len(synthetic_avatar().rig.texels.texels)
    one, two = str(count + count % 2), str(2 * (count + count % 2))
    reported = story("OpensPrefab", sound)
    game, view = 1 << 63, 2
    assert reported["shadow"] == [["True", "1"], ["True", f"{game | view}"], ["True", f"{game}"]]  # hidden at last
    assert reported["seen"] == [
        *(["view", "1", one], ["game", "0", "0"]),  # the prefab's alone
        *(["view", "1", one], ["game", "1", one]),
        *(["view", "2", one], ["game", "1", one]),  # with the prefab's mesh
        *(["view", "2", two], ["game", "2", two]),  # both avatars in the scene
        *(["view", "1", one], ["game", "2", two]),  # one of them, with its mesh, is hidden in the Hierarchy
    ]


def test_the_selected_avatar_comes_first(story: Story, sound: Path, tmp_path: Path) -> None:
    other = tmp_path / "Other.muaavatar"
    write(other, synthetic_avatar(2), storage="f16")
    assert story("Selects", sound, other)["found"] == [["Other"]]
    other.write_bytes(b"no avatar")
    assert story("Selects", sound, other)["found"] == [["Walking Woman"]]


def test_a_component_is_scrubbed_in_its_inspector(story: Story, tmp_path: Path) -> None:
    """A chosen clip plays from what is loaded already."""
    avatar = synthetic_avatar()
    path = tmp_path / "a.muaavatar"
    write(path, replace(avatar, clips=(avatar.clips[0], replace(avatar.clips[0], name="nod"))), storage="f16")
    reported = story("Scrubs", path)
    last = len(avatar.clips[0]) - 1
    first, chosen, scrubbed, again, playing, _, failed = (line for [line] in reported["gui"])
    assert first == f"popup wave of wave, nod; button Play; slider 0 of 0 to {last}"
    assert chosen == first
    assert reported["clip"] == [["1", "True"]]
    assert scrubbed == f"popup nod of wave, nod; button Play; slider 0 of 0 to {last}"
    assert again == scrubbed.replace("slider 0", "slider 3")
    # An editor that does not play is asked once for a frame and its picture.
    assert reported["asked"] == [["1", "1"]] * 2
    assert reported["frame"] == [["3"]]
    assert reported["playing"] == [["False"]]
    outside = 100 * outside_of_training(path, 3)
    assert playing.split("; ")[1:] == [
        "button Pause",
        f"slider 3 of 0 to {last}",
        f"value Outside Training: {outside:.0f} %",
    ]
    assert failed.startswith("property nod; Error ")
    assert reported["alive"] == [["0"]]


def test_a_face_is_moved_in_the_inspector(story: Story, tmp_path: Path) -> None:
    """Each movement of a slider is shown with the one frame that the editor is asked for."""
    avatar, path = synthetic_avatar(), tmp_path / "a.muaavatar"
    write(path, replace(with_expressions(avatar), clips=avatar.clips), storage="f16")
    reported = story("MovesFace", path)
    shut, opened, *_ = (line for [line] in reported["gui"])
    assert shut.endswith("foldout Expressions")
    names = ("jawOpen", "eyeBlinkLeft", "nothing", "Mund auf")
    assert opened.split("foldout Expressions; ")[1].split("; ")[:4] == [f"slider {name} 0 of 0 to 1" for name in names]
    assert reported["moved"] == [[weight, "1", str(len(FRAME_ORDER) + 3)] for weight in ("0.25", "0.5")]
    assert reported["reset"] == [["0"]]


def test_a_clip_plays_in_the_scene_view_until_something_ends_it(story: Story, sound: Path) -> None:
    """At twice its speed; nothing of the scene changes."""
    reported = story("Previews", sound)
    ends = ["pause", "deselected", "play mode", "no avatar", "destroyed"]
    assert [[end, done] for end, done, _ in reported["ended"]] == [[end, "True"] for end in ends]
    seconds = [float(second) for second, _ in reported["plays"]]
    assert seconds[:3] == pytest.approx([0.125, 0.25, 0.375], abs=1e-6)
    assert [repaints for _, repaints in reported["plays"]] == ["True"] * 5
    assert [float(ended[2]) for ended in reported["ended"][:2]] == pytest.approx(seconds[:2])
    assert reported["saved"] == [["True", "0"]]
    frames = [line.split("slider ")[1].split(" ")[0] for [line] in reported["gui"][1:3]]
    assert frames == ["3", "3"]  # at 24 Hz
    assert (reported["log"], reported["alive"]) == ([], [["0"]])


def test_several_components_have_no_clip_in_common_to_scrub(story: Story, sound: Path) -> None:
    several, one = (line for [line] in story("EditsSeveral", sound)["gui"])
    assert several.startswith("property ")
    assert "slider" not in several
    assert one.startswith("popup ")


def test_a_file_that_changes_is_shown_anew(story: Story, sound: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.muaavatar"
    write(other, replace(synthetic_avatar(), name="another"), storage="f16")
    reported = story("Reimports", sound, other)
    assert reported["name"] == [["synthetic"] * 2, ["another"] * 2]
    assert reported["alive"] == [["0"]]


def test_the_menu_is_complete(story: Story) -> None:
    assert {item for [item] in story("Menus")["menu"]} == {
        "MUA/Create Demo Scene",
        "MUA/Set Up Project for Quest",
        "MUA/Set Up Project for PC Link",
        "MUA/Check Project",
        "MUA/Run Self-Test",
        "GameObject/MUA Avatar",
    }
