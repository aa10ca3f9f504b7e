"""Images of a camera: every kind of file gives the same colours, and one of another size is refused."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import ExifTags, Image, ImageOps

from mua.atlas.pictures import decode_image
from mua.capture.pictures import picture_size, read_mask, read_picture
from mua.errors import InputError

GREY = np.array([[0, 1, 100], [128, 254, 255]], np.uint8)
SIZE = (3, 2)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_greys_of_any_depth_are_the_same(tmp_path: Path, dtype: type) -> None:
    file = tmp_path / "mask.png"
    Image.fromarray(GREY.astype(dtype) * dtype(1 if dtype == np.uint8 else 257)).save(file)
    np.testing.assert_array_equal(read_mask(file, number=0, size=SIZE)[..., 0], GREY)
    np.testing.assert_array_equal(decode_image(file.read_bytes())[..., 0], GREY)


def test_a_mask_that_is_painted_in_labels_covers_all_of_them(tmp_path: Path) -> None:
    """Segmentation tools paint the first person dark red, the next dark green."""
    file, painted = tmp_path / "mask.png", Image.fromarray(np.array([[0, 1, 1], [2, 0, 0]], np.uint8))
    painted.putpalette([0, 0, 0, 128, 0, 0, 0, 128, 0])
    painted.save(file)
    np.testing.assert_array_equal(read_mask(file, number=0, size=SIZE)[..., 0], [[0, 255, 255], [255, 0, 0]])


@pytest.mark.parametrize("labels", [1, 20])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_a_mask_of_numbers_covers_all_but_0(tmp_path: Path, dtype: type, labels: int) -> None:
    """Human parsing (LIP, CIHP) writes the number of a part of the body, other tools 0 and 1."""
    file = tmp_path / "mask.png"
    Image.fromarray(np.array([[0, 1, 1], [labels, 0, 0]], dtype)).save(file)
    np.testing.assert_array_equal(read_mask(file, number=0, size=SIZE)[..., 0], [[0, 255, 255], [255, 0, 0]])


@pytest.mark.parametrize("mode", ["RGB", "RGBA", "P"])
def test_colours_are_read_with_the_alpha_that_the_file_has(tmp_path: Path, mode: str) -> None:
    file, colours = tmp_path / "a.png", np.stack([GREY, GREY[:, ::-1], GREY // 2], axis=2)
    image = Image.fromarray(colours)
    image.putalpha(Image.fromarray(GREY)) if mode == "RGBA" else None
    image = image.quantize(8) if mode == "P" else image
    options: dict[str, Any] = {"transparency": 0} if mode == "P" else {}
    image.save(file, **options)
    found = read_picture(file, number=0, size=SIZE)
    assert found.shape == (2, 3, 3 if mode == "RGB" else 4)
    if mode != "P":
        np.testing.assert_array_equal(found[..., :3], colours)
        np.testing.assert_array_equal(found[..., 3:], GREY[..., None] if mode == "RGBA" else np.zeros((2, 3, 0)))


def test_a_picture_that_lies_on_its_side_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "a.png"
    Image.fromarray(GREY).save(file)
    with pytest.raises(InputError, match=r"the image is 3 x 2 pixels; capture\.json gives its camera 2 x 3"):
        read_picture(file, number=0, size=(2, 3))


@pytest.mark.parametrize(("colour", "clear"), [(255, 0), (60, 0), (0, 255)])
def test_a_cut_out_is_the_mask_of_its_alpha_whatever_its_colours(tmp_path: Path, colour: int, clear: int) -> None:
    """Also where what is clear is white; an alpha that is the same everywhere says nothing."""
    file, image = tmp_path / "cut.png", Image.new("RGB", SIZE, (colour, colour, colour))
    image.putalpha(Image.fromarray(GREY))
    image.save(file)
    np.testing.assert_array_equal(read_mask(file, number=0, size=SIZE)[..., 0], GREY)
    grey = Image.fromarray(np.stack([GREY] * 3, axis=2))
    grey.putalpha(clear)
    grey.save(file)
    np.testing.assert_array_equal(read_mask(file, number=0, size=SIZE)[..., 0], GREY)


@pytest.mark.parametrize("orientation", [5, 6, 7, 8])
def test_a_picture_on_its_side_lies_as_its_camera_was_calibrated(tmp_path: Path, orientation: int) -> None:
    """OpenCV turns pictures as EXIF says before it calibrates, COLMAP does not."""
    file, exif = tmp_path / "a.png", Image.Exif()
    exif[ExifTags.Base.Orientation] = orientation
    Image.fromarray(GREY).save(file, exif=exif)
    with Image.open(file) as opened:
        turned = np.asarray(ImageOps.exif_transpose(opened))
    assert turned.shape == GREY.T.shape
    assert picture_size(file, like=None) == picture_size(file, like=(20, 30)) == SIZE[::-1]
    assert picture_size(file, like=(30, 20)) == SIZE
    np.testing.assert_array_equal(read_picture(file, number=0, size=SIZE[::-1])[..., 0], turned)
    np.testing.assert_array_equal(read_picture(file, number=0, size=SIZE)[..., 0], GREY)
    with pytest.raises(InputError, match=r"the image is 3 x 2 pixels; capture\.json gives its camera 6 x 4"):
        read_picture(file, number=0, size=(6, 4))


@pytest.mark.parametrize(("orientation", "sides"), [(3, SIZE), (2, SIZE), (6, (2, 2))])
def test_pictures_whose_sides_do_not_tell_how_they_lie_are_refused(
    tmp_path: Path, orientation: int, sides: tuple[int, int]
) -> None:
    file, exif = tmp_path / "a.jpg", Image.Exif()
    exif[ExifTags.Base.Orientation] = orientation
    Image.new("L", sides).save(file, exif=exif)
    with pytest.raises(InputError, match=rf"a\.jpg: EXIF orientation is {orientation}, by which some programs turn"):
        read_picture(file, number=0, size=sides)
