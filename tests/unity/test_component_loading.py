"""AvatarRenderer in a player loop of stand-ins: how it loads files and assets, and what it says where that fails."""

from dataclasses import replace
from pathlib import Path

import pytest
from component import Story, counts
from synthetic_avatar import synthetic_avatar

from mua.asset import write


def test_a_load_asks_once_for_the_packages_resources(story: Story) -> None:
    assert story("Plays", "first")["asked"] == ["1"]


def test_an_avatar_destroyed_while_it_uploads_leaves_nothing(story: Story) -> None:
    reported = story("GoesMidUpload", "wide")
    assert (reported["state"], reported["progress"], reported["held"]) == (["Loading"], ["1"], ["1"])


def test_progress_rises_from_nothing_to_all(story: Story) -> None:
    """Of a file whose upload takes three frames; before it, reading takes any number of them."""
    found = [float(number) for number in story("MakesProgress", "wide")["progress"]]
    assert (found[0], found[-1], found) == (0, 1, sorted(found))
    uploading = sorted({number for number in found if 0 < number < 1})
    assert len(uploading) >= 2
    assert uploading[-1] > 0.8


def test_an_avatar_destroyed_while_it_is_read_leaves_nothing(story: Story) -> None:
    assert story("GoesMidRead", "first")["log"] == []


def test_a_file_is_found_in_both_folders_and_in_an_asset(story: Story, folder: Path) -> None:
    """Persistent data before what came with the application."""
    (folder / "others").mkdir()
    write(folder / "others" / "first.muaavatar", replace(synthetic_avatar(2), name="another"), storage="f16")
    reported = story("FindsFiles", "first")
    assert reported["state"] == ["Ready"] * 3
    assert reported["of both"] == [synthetic_avatar(1).name]


def test_a_file_inside_an_android_package_is_requested(story: Story) -> None:
    reported = story("Streams", "first")
    assert reported["state"] == ["Ready", "Failed"]
    assert len(reported["log"]) == 1
    assert "404" in reported["log"][0]


def test_as_many_buffers_as_a_kernel_and_a_draw_take_are_enough(story: Story) -> None:
    reported = story("HasJustEnoughBuffers", "first")
    assert (reported["state"], reported["log"]) == (["Ready"], [])


@pytest.mark.parametrize(
    ("name", "file", "words"),
    [
        ("Fails", "damaged", "crc32"),
        ("Fails", "absent", "absent.muaavatar"),
        ("FailsAtAddress", "first", "https:// is no address: "),
        ("FailsInEditor", "damaged", "crc32"),
        ("FailsInEditor", "absent", "absent.muaavatar"),
        ("LacksKernel", "first", "splat_sort.compute"),
        ("LacksResources", "first", "MuaAvatarResources"),
        ("LacksCompute", "first", "compute shaders"),
        ("LacksThreads", "first", "no threads"),
        ("LacksBuffers", "first", "4 buffers in a compute kernel"),
        ("LacksVertexBuffers", "first", "2 buffers in a vertex shader"),
        ("LacksMemory", "first", "4096"),
    ],
)
def test_what_is_wrong_is_said_once(story: Story, name: str, file: str, words: str) -> None:
    reported = story(name, file)
    assert reported["state"] == ["Failed"]
    assert reported["held"] == ["0"]
    assert len(reported["log"]) == 1, reported["log"]
    assert reported["log"][0].startswith("Error MUA: ")
    assert words in reported["log"][0]
    assert "One or more errors" not in reported["log"][0]
    assert reported["log"][0].endswith(reported["message"][0])


def test_a_server_without_graphics_is_told_nothing(story: Story) -> None:
    """Unity's -nographics; who asks the component learns why it shows nothing."""
    reported = story("LacksGraphics", "first")
    assert (reported["state"], reported["held"], reported["log"]) == (["Failed"], ["0"], [])
    assert "no graphics device" in reported["message"][0]


def test_an_avatar_that_has_no_room_beside_others_goes_alone(story: Story) -> None:
    reported = story("LacksMemoryForTwo", "first")
    assert reported["state"] == ["Ready Failed"]
    assert reported["shown"] == ["1"]
    assert len(reported["log"]) == 1, reported["log"]
    assert "splats" in reported["message"][0]


def test_one_avatar_takes_the_place_of_another(story: Story) -> None:
    reported, first, second = story("ShowsOneAfterAnother", "first", "second"), counts(1)[0], counts(2)[0]
    assert reported["shown"] == [
        f"Ready {first} False",
        f"Ready {second} True",
        f"Ready {first} False",
        "Failed 0 False",
        f"Ready {first} False",
        "Empty 0 False",
        f"Ready {second} True",
    ]
    assert reported["message"][0].endswith("it is no avatar.")


def test_a_scene_keeps_every_setting_of_a_component(story: Story) -> None:
    assert story("IsCopied", "first")["copy"] == ["Ready 0.5 Template Half False True"]


def test_bytes_load_as_their_file_does(story: Story) -> None:
    reported = story("LoadsBytes", "first", "second", "damaged")
    name = synthetic_avatar(2).name
    ready, failed, empty = f"Ready {name}", "Failed ", "Empty"
    assert reported["state"] == [ready, empty, ready, failed, failed, empty, failed, ready]
    of_bytes, of_file = reported["message"]
    assert of_bytes.startswith("downloaded: ")
    assert of_bytes.partition(": ")[2] == of_file.partition(".muaavatar: ")[2] != ""


def test_clones_of_an_avatar_of_bytes_show_it_until_the_last_is_gone(story: Story) -> None:
    reported = story("IsClonedFromBytes", "first", "second")
    first, second = (f"Ready {synthetic_avatar(seed).name}" for seed in (1, 2))
    assert (reported["state"], reported["kept"]) == ([second, first, second], ["False"])


def test_a_component_that_is_off_loads_once_it_is_on(story: Story) -> None:
    assert story("LoadsWhileDisabled", "first")["state"] == ["Empty", "Ready", "Empty"]
