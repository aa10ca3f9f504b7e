"""Motion files whose up axis is not Y, in the browser as in the package."""

from pathlib import Path

from bvh_files import with_x_up
from shared_data import SharedData
from web.test_modules import node, pytestmark  # noqa: F401  needs Node
from web.test_page_retarget import assert_same, browser_clip

from mua.characters.read import read_surfaces
from mua.motion.load import load_motions
from mua.pose.encoding import RATE


def test_motion_with_x_up_is_turned_as_the_package_does(tmp_path: Path) -> None:
    woman = read_surfaces(SharedData().path("characters/White_F_3_Casual.glb")).skeleton
    path = tmp_path / "x_up.bvh"
    path.write_text(with_x_up(SharedData().path("motion/cmu/01_01.bvh").read_text()))
    [loaded] = load_motions(path, woman, mapping=None, rate=RATE, feet="keep")
    found = browser_clip(tmp_path, woman, path)
    assert "X is up; turned to Y up." in found["notes"]
    assert_same(found, loaded.clip)
