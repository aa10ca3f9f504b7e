"""Every option of mua-view acts in the window as in files, or is refused in a sentence before anything is loaded."""

from pathlib import Path
from typing import Any

import pytest

from mua.cli.option_values import parse_listen
from mua.cli.view import view
from mua.cli.view_options import Asked, look_of
from mua.errors import InputError
from mua.live.receiver import Address

NOWHERE = Path("nowhere.muaavatar")  # an option is refused although there is no such file


@pytest.mark.parametrize(
    ("output", "choice", "sentence"),
    [
        (None, {"frames": "0:3"}, "--frames: works only with a video; no -o is given"),
        (None, {"reference": True}, "--reference: works only with an image, a video or a turntable; no -o is given"),
        (None, {"turntable": True}, "--turntable: no -o is given; expected -o with a name that ends in .mp4"),
        (None, {"background": "transparent"}, "--background is transparent, but the window cannot be"),
        (None, {"show": "hat"}, "--show is 'hat'"),
        (None, {"level": "low"}, "--level is 'low'; expected auto, full or a number of texels such as 384"),
        (None, {"level": "0"}, "--level is '0'"),
        (None, {"expressions": "jawOpen"}, "--expressions has 'jawOpen'; expected a name and a weight"),
        (None, {"expressions": "a=1,=0.5"}, "--expressions has '=0.5'; expected a name and a weight"),
        ("v.png", {"expressions": "a=nan"}, "--expressions has 'a=nan'; expected a name and a weight"),
        ("v.png", {"level": "192", "show": "splats,geometry"}, "--level is 192 and --show has geometry"),
        *[(None, {"size": size}, f"--size is '{size}'") for size in ("0", "10x20x30", "9999", "-5")],
        (None, {"background": "nocolour"}, "--background is 'nocolour'"),
        (None, {"zoom": 0.0}, "--zoom is 0; expected 0.03 to 100"),
        (None, {"zoom": float("nan")}, "--zoom is nan"),
        (None, {"azimuth": float("inf")}, "--azimuth is inf; expected a finite number of degrees"),
        (None, {"ipd": float("inf"), "stereo": True}, "--ipd is inf; expected a distance in metres"),
        (None, {"ipd": 0.06}, "--ipd: works only with --stereo, which is not given"),
        (None, {"mapping": Path("m.json")}, "--mapping: works only with --motion or --listen, which is not given"),
        *[
            (None, {"listen": port}, f"--listen is {port!r}; expected a port from 1 to 65535, or ADDRESS:PORT")
            for port in ("", "0", "65536", "vmc", ":39539", "127.0.0.1:", "-1", "3²")
        ],
        ("v.png", {"listen": "39539"}, "--listen: works only with the window; -o is v.png, an image"),
        (None, {"listen": "39539", "motion": Path("m.bvh")}, "--motion: works only without --listen"),
        (None, {"listen": "39539", "clip": "walk"}, "--clip: works only without --listen"),
        (None, {"listen": "39539", "frame": 3}, "--frame: works only without --listen"),
        ("v.png", {"frames": "0:3"}, "--frames: works only with a video; -o is v.png, an image"),
        ("v.png", {"orbit": 45.0}, "--orbit: works only with the window, a video or a turntable; -o is v.png"),
        ("v.png", {"turntable": True}, "--turntable: -o is v.png; expected -o with a name that ends in .mp4"),
        ("v.mp4", {"frame": 3}, "--frame: works only with the window, an image or a turntable; -o is v.mp4, a video"),
        ("v.mp4", {"frames": "0:3", "turntable": True}, "--frames: works only with a video; -o is v.mp4, a turntable"),
        ("v.mp4", {"background": "transparent"}, "--background is transparent, but v.mp4 cannot be"),
        ("v.jpg", {"background": "transparent"}, "but v.jpg cannot be; expected -o with .webm, .gif, .png"),
        ("v.webm", {"size": "33x32"}, "--size is '33x32'; a video needs an even width and height"),
        ("v.png", {"reference": True, "device": "0"}, "--device and --reference are both given"),
        ("v.docx", {}, "expected a name that ends like an image, such as .png, or in .mp4, .webm or .gif"),
        ("v.psd", {}, "-o is v.psd; expected a name that ends like an image"),  # which can be read alone
        ("v.png", {"motion": Path("nowhere.bvh")}, "nowhere.muaavatar: there is no such file"),
    ],
)
def test_refuses_before_anything_is_loaded(output: str | None, choice: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InputError) as refused:
        view(files=[NOWHERE], output=None if output is None else Path(output), **choice)
    assert sentence in str(refused.value)


@pytest.mark.parametrize(
    ("text", "address"),
    [
        ("39539", Address(39539, "127.0.0.1")),
        ("0.0.0.0:39540", Address(39540, "0.0.0.0")),
        ("localhost:1", Address(1, "localhost")),
    ],
)
def test_a_port_alone_is_of_this_machine(text: str, address: Address) -> None:
    assert parse_listen(text) == address


def test_an_animation_may_have_any_size() -> None:
    assert look_of(Asked(size="33x31"), Path("v.gif")).shot.screen == (33, 31)


def test_a_close_up_is_near_unless_said_otherwise() -> None:
    assert look_of(Asked(look_at="head"), None).shot.zoom > 1
    assert look_of(Asked(look_at="head", zoom=1.0), None).shot.zoom == 1


@pytest.mark.parametrize("output", [None, Path("v.mp4")])
def test_a_close_up_follows_unless_said_otherwise(output: Path | None) -> None:
    assert look_of(Asked(look_at="head"), output).shot.follow
    assert not look_of(Asked(look_at="head", follow=False), output).shot.follow


@pytest.mark.parametrize(
    "option", ["frame", "frames", "ipd", "level", "reference", "device", "motion", "size", "zoom", "look_at",
               "follow", "turntable", "background", "output"],
)  # fmt: skip
def test_refuses_in_a_browser_what_its_page_does_not_follow(option: str) -> None:
    flag = "-o" if option == "output" else f"--{option.replace('_', '-')}"
    with pytest.raises(InputError, match=f"^{flag}: does not work with --web"):
        view(files=[NOWHERE], web=True, **{option: True})
