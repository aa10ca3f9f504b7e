"""mua-view writes the frame that it is asked for and refuses what it cannot show in a sentence."""

import dataclasses
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from synthetic_avatar import synthetic_avatar

from mua.asset import write
from mua.cli.view import view
from mua.errors import InputError


@pytest.fixture(scope="module")
def avatar_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("view") / "a.muaavatar"
    write(path, synthetic_avatar())
    return path


def pixels(path: Path) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image)


def test_writes_an_image_of_the_size_and_background_asked_for(avatar_file: Path, tmp_path: Path) -> None:
    view(avatar_file, output=tmp_path / "v.png", size="40x61", background="#204060")
    image = pixels(tmp_path / "v.png")
    assert image.shape == (61, 40, 3)
    np.testing.assert_array_equal(image[0, 0], [0x20, 0x40, 0x60])
    assert (image != image[0, 0]).any()


def test_frames_and_angles_differ(avatar_file: Path, tmp_path: Path) -> None:
    choices = [{}, {"frame": 5}, {"azimuth": 90.0}, {"elevation": 60.0}]
    for i, choice in enumerate(choices):
        view(avatar_file, output=tmp_path / f"{i}.png", size="32", clip="wave", **choice)
    images = {pixels(tmp_path / f"{i}.png").tobytes() for i in range(len(choices))}
    assert len(images) == len(choices)


@pytest.mark.parametrize(
    ("choice", "sentence"),
    [
        ({"clip": "jump"}, "--clip is 'jump'; .* holds wave"),
        ({"frame": 7}, "--frame is 7; clip 'wave' has frames 0 to 6"),
        ({"frame": -1}, "--frame is -1; clip 'wave' has frames 0 to 6"),
        ({"size": "0"}, "--size is '0'"),
        ({"size": "10x20x30"}, "--size is '10x20x30'"),
        ({"size": "9999"}, "--size is '9999'"),
        ({"size": "-5"}, "--size is '-5'"),
        ({"background": "nocolour"}, "--background is 'nocolour'"),
    ],
)
def test_refuses_with_a_sentence_and_writes_nothing(
    avatar_file: Path, tmp_path: Path, choice: dict[str, str | int], sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence):
        view(avatar_file, output=tmp_path / "v.png", **choice)
    assert list(tmp_path.iterdir()) == []


def test_refuses_a_suffix_that_is_no_image(avatar_file: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"-o is .*v\.txt"):
        view(avatar_file, output=tmp_path / "v.txt")


def test_refuses_an_avatar_without_clips(tmp_path: Path) -> None:
    path = tmp_path / "still.muaavatar"
    write(path, dataclasses.replace(synthetic_avatar(), clips=()))
    with pytest.raises(InputError, match="holds no clips"):
        view(path, output=tmp_path / "v.png")


def test_command_exits_with_status_one_and_keeps_an_earlier_image(avatar_file: Path, tmp_path: Path) -> None:
    output = tmp_path / "v.png"
    output.write_bytes(b"earlier")
    command = [sys.executable, "-c", "from mua.cli.view import run; run()", str(avatar_file), "-o", str(output)]
    refused = subprocess.run([*command, "--clip", "jump"], capture_output=True, text=True, check=False)
    assert (refused.returncode, refused.stdout) == (1, "")
    assert refused.stderr.startswith("error: --clip is 'jump'")
    assert output.read_bytes() == b"earlier"
