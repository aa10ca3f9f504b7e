"""The VR player's scene in a player loop of stand-ins: what its inputs change, what it shows, what it says."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from csharp import PROGRAMS, ROOT, CSharp, by_name
from package_compiler import Compiler, assemblies
from synthetic_avatar import synthetic_avatar, with_surface
from training import outside_of_training

from mua.asset import write

KERNELS = ROOT / "ComputeShaders"
SAMPLE = ROOT / "unity-package" / "Samples~" / "VrPlayer"
Reports = dict[str, list[str]]
Story = Callable[..., Reports]


BOTH_INPUTS = pytest.mark.parametrize("program", [True, False], ids=["system", "manager"], indirect=True)


@pytest.fixture(scope="module")
def program(csharp: CSharp, request: pytest.FixtureRequest) -> Path:
    """The sample and its editor part with the test's program, for either of Unity's two input systems."""
    packages = getattr(request, "param", True)
    compiler = Compiler(csharp, "editor", packages=packages)
    sample, editor = assemblies()["Mua.Samples.VrPlayer"], assemblies()["Mua.Samples.VrPlayer.Editor"]
    names = ["UnityEngine", "UnityEditor", *(["Unity.InputSystem", "Unity.XR.MetaOpenXR"] if packages else [])]
    references = [compiler.built(name) for name in (*names, "Mua.Format", "Mua.Motion", "Mua.Avatar")]
    defines = sample.defines("editor", packages=packages)
    sources = [*sample.sources(), *editor.sources(), PROGRAMS / "shared", *sorted(PROGRAMS.glob("Player*.cs"))]
    return csharp.build(sources, name="PlayerProgram", references=references, defines=defines)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Assets, persistent data and StreamingAssets, all empty."""
    for name in ("Assets", "persistent/avatars", "streaming"):
        (tmp_path / name).mkdir(parents=True)
    return tmp_path


@pytest.fixture
def story(csharp: CSharp, program: Path, folder: Path) -> Story:
    def tell(
        name: str,
        *arguments: str,
        files: tuple[str, ...] = ("persistent/avatars/first", "persistent/avatars/second"),
    ) -> Reports:
        for seed, file in enumerate(files):
            put(folder / f"{file}.muaavatar", seed)
        folders = (folder, folder / "persistent", folder / "streaming")
        reported = {"log": [], **by_name(csharp.run(program, KERNELS, name, *folders, *arguments))}
        assert (reported["alive"], reported["recorders"]) == (["0"], ["0"])
        return reported

    return tell


def put(path: Path, seed: int) -> None:
    """An avatar of two clips, called after its file."""
    avatar = with_surface(synthetic_avatar(seed))
    clip = avatar.clips[0]
    path.parent.mkdir(exist_ok=True)
    write(path, replace(avatar, name=path.stem, clips=(clip, replace(clip, name="another"))), storage="i8")


def test_the_scene_has_what_the_player_needs(story: Story) -> None:
    reported = story("Scene", files=())
    assert reported["saved"] == ["Assets/Scenes/Player.unity"]
    assert [reported[name] for name in ("Ground", "Avatar", "User", "Head", "Panel", "Help")] == [
        ["MeshFilter MeshRenderer"],
        ["AvatarRenderer"],
        ["VrPlayer"],
        ["Camera HeadPose"],
        ["MeshRenderer TextMesh StandingText"],
        ["MeshRenderer TextMesh StandingText"],
    ]
    assert reported["light"] == ["Directional Soft"]
    assert reported["camera"] == ["False False SolidColor MainCamera"]
    assert (reported["ground"], reported["avatars"]) == (["True"], ["True"])
    assert reported["faces"] == ["0.00 0.00 -1.00, the user at 0.00 0.00 -2.20"]
    assert (reported["eyes"], reported["sees"]) == (["1.60"], ["0.05 to 100"])
    assert reported["light falls"] == ["-0.32 -0.77 0.56"]
    assert reported["Panel stands"] == ["-1.60 1.90 0.20 faces -0.50 0.00 0.87"]
    assert reported["Help stands"] == ["0.70 1.90 0.20 faces 0.50 0.00 0.87"]
    assert reported["letters"] == ["0.0280 UpperLeft", "0.0280 UpperLeft"]
    for action in ("walk", "turn", "zoom", "scrub", "play, pause", "next clip", "previous clip", "back to the start"):
        for named in (reported["help"][0], (SAMPLE / "README.md").read_text()):
            assert action in named
    assert reported["log"] == []


def test_letters_are_drawn_by_a_shader_that_tests_depth(story: Story) -> None:
    """With the font's texture, also where the font has made another one meanwhile."""
    reported = story("Letters")
    assert reported["shader"] == ["Hidden/MUA/Text"]
    assert reported["own"] == ["True", "True"]
    assert reported["log"] == []


@BOTH_INPUTS
def test_keys_do_what_the_table_says(story: Story) -> None:
    reported = story("Keys")
    assert reported == {
        "Space": ["playing True; frame -", "playing False; frame 3", "playing True; frame -"],
        "Period": ["frame 4"],
        "Comma": ["frame 3", "frame 2"],
        "RightBracket": ["frame 0; clip 1"],
        "LeftBracket": ["clip 0", "clip 1"],
        "Digit1": ["views Shadow"],
        "Digit2": ["views Geometry, Shadow"],
        "Digit3": ["views Geometry, Template, Shadow"],
        "Digit4": ["views Geometry, Template, Skeleton, Shadow"],
        "Digit5": ["views Geometry, Template, Skeleton"],
        "H": ["help False", "help True"],
        "W": ["user 0.00 0.00 -1.99"],
        "S": ["user 0.00 0.00 -2.20"],
        "D": ["user 0.21 0.00 -2.20"],
        "A": ["user 0.00 0.00 -2.20"],
        "R": ["user 0.00 0.21 -2.20"],
        "F": ["user 0.00 0.00 -2.20"],
        "E": ["avatar faces -0.22 0.00 -0.98"],
        "RightArrow": ["frame 6", "playing False; frame 3"],
        "LeftArrow": ["frame 0"],
        "UpArrow": ["user 0.00 0.15 -2.00; size 0.908"],
        "Backspace": [
            "user 0.00 0.00 -2.20; size 1.000; avatar faces 0.00 0.00 -1.00",
            "user 0.00 0.00 -2.20; size 1.000; avatar faces 0.00 0.00 -1.00",
        ],
        "Q": ["avatar faces 0.22 0.00 -0.98"],
        "DownArrow": ["user 0.00 -0.16 -2.42; size 1.101"],
        "PageDown": ["clip 0; avatar second"],
        "PageUp": ["avatar first", "avatar second"],
        "drag": [""],
        "right drag": ["head 0.75 0.50 0.43"],
        "wheel": ["user 0.00 0.86 -1.02; size 0.463"],
        "log": [],
        "alive": ["0"],
        "recorders": ["0"],
    }


def test_buttons_do_what_the_table_says(story: Story) -> None:
    reported = story("Controllers")
    assert reported == {
        "A": ["playing True; frame -", "playing False; frame 3"],
        "right trigger": ["frame 4"],
        "left trigger": ["frame 3"],
        "B": ["frame 0; clip 1"],
        "menu": ["help False"],
        "left stick pressed": ["help True"],
        "left stick up": ["user 0.00 0.00 -1.99"],
        "left stick at rest": [""],
        "right stick right": ["avatar faces -0.22 0.00 -0.98"],
        "right stick up": ["user 0.00 0.15 -1.81; size 0.908"],
        "right grip, right stick right": ["frame 6"],
        "right stick pressed": ["user 0.00 0.00 -2.20; size 1.000; avatar faces 0.00 0.00 -1.00"],
        "Y": ["frame 0; clip 0; avatar second"],
        "X": ["avatar first"],
        "left grip, A": ["views Shadow"],
        "left grip, B": ["views Geometry, Shadow"],
        "left grip, X": ["views Geometry, Template, Shadow"],
        "left grip, Y": ["views Geometry, Template, Skeleton, Shadow"],
        "left grip, right trigger": ["views Geometry, Template, Skeleton"],
        "left grip, left trigger": ["clip 1"],
        "log": [],
        "alive": ["0"],
        "recorders": ["0"],
    }


def test_nobody_grows_beyond_twice_shrinks_below_an_eighth_or_looks_over_the_top(story: Story) -> None:
    reported = story("Limits")
    assert (reported["size after UpArrow"], reported["size after DownArrow"]) == (["0.125"], ["2.000"])
    assert reported["looks after 4000"] == ["0.00 1.00 0.09"]  # 85 degrees
    assert reported["looks after -8000"] == ["0.00 -1.00 0.09"]


def test_a_stick_walks_by_its_way_beyond_the_dead_zone(story: Story) -> None:
    reported = story("Sticks")
    whole = 10 * 1.5 / 72  # frames, metres a second, frames a second
    assert float(reported["0.140"][0]) == 0
    for push, share in (("0.160", 0.01 / 0.85), ("0.575", 0.5), ("-0.575", -0.5), ("1.000", 1)):
        assert float(reported[push][0]) == pytest.approx(share * whole, abs=1e-4)


def test_a_second_turns_a_quarter_and_rises_a_metre_and_a_half_and_scrubs_two_seconds(story: Story) -> None:
    reported = story("Speeds")
    assert reported["turned"] == ["-1.00 0.00 0.00"]
    assert reported["risen"] == ["1.50"]
    assert reported["scrubbed"] == ["0.250"]  # in 9 of 72 frames


def test_where_no_avatars_are_streamed_there_is_no_index(story: Story) -> None:
    reported = story("Index", files=())
    assert (reported["of nothing"], reported["of what is gone"], reported["nowhere"]) == (
        ["False"],
        ["False"],
        ["False"],
    )


def test_a_headset_that_is_taken_off_is_set_up_again_when_it_comes_back(story: Story) -> None:
    reported = story("HeadsetGoes")
    assert (reported["worn"], reported["taken off"], reported["worn again"]) == (["True"], ["False"], ["True 0.5"])


@BOTH_INPUTS
def test_a_headset_gives_pose_floor_and_rate(story: Story) -> None:
    reported = story("Headset")
    assert reported["head"] == ["0.50 1.80 -1.95 looks 1.00 0.00 0.00"]
    assert (reported["foveation"], reported["origin"], reported["rate"]) == (["0.5"], ["Floor"], ["72"])
    assert "display 72 Hz, 72 wanted   foveation 0.50" in reported["panel"][0]
    assert reported["left stick up"] == ["user 0.21 0.00 -2.20"]  # to where the head looks
    assert reported["right drag"] == [""]  # a mouse does not turn a head that is tracked
    assert reported["zoomed"] == ["0.35 1.80 -0.98 near 0.025"]  # half as far, at the same height
    assert reported["back"] == ["0.00 1.80 -2.20 looks 0.00 0.00 1.00"]  # wherever in the room the user stands


def test_the_panel_says_what_is_shown_and_how_fast(story: Story, folder: Path) -> None:
    reported = story("Panel")
    outside = outside_of_training(folder / "persistent/avatars/first.muaavatar", 3)
    assert outside > 0.01
    assert reported["first"][0].startswith("72 fps   13.9 ms a frame")
    assert "|loading 0 %|" in reported["first"][0]
    assert reported["panel"][0].split("|") == [
        "72 fps   13.9 ms a frame   9.8 ms GPU",
        "",
        "ms on the GPU",
        "coarse mesh 0.50   texture 0.50   pose 0.50",
        "project 0.50   sort 0.50   draw -",
        "",
        "avatar 1/2   first",
        "clip 1/2   wave",
        "frame 4/7   paused",
        f"outside of training {100 * outside:.0f} %",
        "shown: splats shadow",
        "",
    ]


@BOTH_INPUTS
def test_a_frame_allocates_nothing_but_two_texts_a_second(story: Story) -> None:
    reported = story("Allocates")
    assert reported["texts"] == ["4"]
    assert reported["allocated"] == ["0"]


def test_avatars_come_in_the_order_of_folder_app_and_scene(story: Story) -> None:
    files = ("persistent/avatars/b", "persistent/avatars/a", "streaming/more/d", "streaming/c")
    order = ["a", "b", "c", "d", "asset"]
    reported = story("Order", files=files)
    assert reported["entry"] == [f"avatar {i}/5   {name}" for i, name in enumerate(order, 1)]
    assert reported["shown"][:4] == order[:4]
    assert reported["shown"][4] in ("a", "b")  # whose bytes the asset has


def test_avatars_inside_an_android_package_are_found_by_their_index(story: Story) -> None:
    reported = story("Streams", files=("persistent/avatars/a", "streaming/more/d", "streaming/c"))
    assert reported["index"] == ["c.muaavatar|more/d.muaavatar|"]
    assert reported["entry"] == ["avatar 1/3   a", "avatar 2/3   c", "avatar 3/3   d"]


def test_switching_gives_back_the_avatar_before(story: Story) -> None:
    reported = story("Switches")
    assert (reported["uploading"], reported["shown"], reported["kept"]) == (["True"] * 4, ["True"] * 4, ["True"])


def test_without_an_avatar_the_panel_says_where_to_put_one(story: Story, folder: Path) -> None:
    (folder / "persistent" / "avatars").rmdir()
    reported = story("Goes", files=())
    assert reported["state"] == ["Empty "]
    panel = reported["panel"][0].replace("|", " ")
    assert "No avatar was found. Put files like hero.muaavatar in" in panel
    assert str(folder / "persistent" / "avatars") in reported["panel"][0].replace("|", "")
    assert (folder / "persistent" / "avatars").is_dir()
    assert reported["log"] == []


def test_an_avatar_that_fails_says_why_and_makes_way_for_the_next(story: Story, folder: Path) -> None:
    (folder / "persistent" / "avatars" / "broken.muaavatar").write_bytes(b"no avatar at all")
    reported = story("Goes")
    assert reported["state"] == ["Ready first"]
    assert "avatar 2/3   first" in reported["panel"][0]
    assert "broken.muaavatar" in reported["panel"][0].replace("|", "")
    assert "avatar 3/3   second" in reported["on"][0]  # back past the broken one, from the first to the last
    assert "broken" not in reported["on"][0]
    assert len(reported["log"]) == 1


def test_where_all_avatars_fail_the_player_rests(story: Story, folder: Path) -> None:
    for name in ("broken", "other"):
        (folder / "persistent" / "avatars" / f"{name}.muaavatar").write_bytes(b"no avatar at all")
    reported = story("Goes", files=())
    assert reported["state"] == ["Failed "]
    assert "broken.muaavatar" in reported["panel"][0].replace("|", "") or "other.muaavatar" in reported["panel"][
        0
    ].replace("|", "")
    assert len(reported["log"]) == 2


def test_the_player_begins_with_the_avatar_it_is_told(story: Story) -> None:
    assert story("Goes", "-muaAvatar", "second")["state"] == ["Ready second"]
    reported = story("Goes", "-muaAvatar", "third")
    assert reported["state"] == ["Ready first"]
    assert "No avatar is called third." in reported["panel"][0]
