"""Shared pages with unusual names, sizes and scripts."""

import os
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar

from mua.errors import InputError
from mua.motion.facing import front_of
from mua.rotation import from_axis_angle, multiply
from mua.share.folder import write_folder
from mua.share.poster import front
from mua.share.server import RANGE, _Handler
from mua.share.single import _held, _json, require_small
from mua.share.site import PAGE, Shown, player_site


def test_names_that_an_address_cannot_hold_are_quoted_in_the_page() -> None:
    site = player_site([Path("Zoë.muaavatar"), Path("-.-")], Shown("two"))
    page = site[PAGE]
    assert isinstance(page, bytes)
    assert b'src="Zo%C3%AB.muaavatar avatar"' in page
    assert {"Zoë.muaavatar", "avatar"} <= set(site)


def test_names_and_modules_end_no_element_of_a_single_file(tmp_path: Path) -> None:
    assert "<" not in _json("</script>")
    avatar = tmp_path / 'a"><b>.muaavatar'
    avatar.write_bytes(b"content")
    assert 'data-name="a&quot;&gt;&lt;b&gt;.muaavatar"' in _held(avatar)


def test_a_single_file_holds_avatars_of_24_mb(tmp_path: Path) -> None:
    avatar = tmp_path / "a.muaavatar"
    avatar.touch()
    os.truncate(avatar, 24_000_000)
    require_small([avatar])
    os.truncate(avatar, 24_000_001)
    with pytest.raises(InputError, match=r"--single-file: the avatars have 24\.0 MB"):
        require_small([avatar])
    os.truncate(avatar, 13_000_000)
    with pytest.raises(InputError, match=r"--single-file: the avatars have 26\.0 MB"):
        require_small([avatar, avatar])


def test_a_folder_that_cannot_be_put_in_place_leaves_the_old_one_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shared = tmp_path / "shared"
    write_folder(shared, {"page": b"old"})
    replace = Path.replace

    def refusing(self: Path, target: Path) -> Path:
        if self.name.endswith(".part"):
            raise OSError(28, "No space left on device")
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", refusing)
    with pytest.raises(InputError, match="No space left"):
        write_folder(shared, {"page": b"new"})
    assert (shared / "page").read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [shared]


def test_a_page_begins_before_the_front_of_the_first_frame() -> None:
    avatar = synthetic_avatar()
    root, clip = avatar.rig.skeleton.root, avatar.clips[0]
    clip.rotations[0, root] = multiply(from_axis_angle(np.array([0.0, 1, 0]), 1.0), clip.rotations[0, root])
    wanted = front_of(avatar.rig.skeleton, clip.rotations[0], clip.translations[0])
    assert abs(wanted) > 0.5
    assert np.radians(front(avatar, clip)) == pytest.approx(float(wanted))


@pytest.mark.parametrize(("asked", "part"), [("-4", (6, 10)), ("-99", (0, 10)), ("3-99", (3, 10)), ("10-", None)])
def test_a_part_ends_where_the_file_does(asked: str, part: tuple[int, int] | None) -> None:
    request = SimpleNamespace(_asked=lambda: RANGE.fullmatch(f"bytes={asked}"))
    assert _Handler._part(request, 10) == part  # type: ignore[arg-type]
