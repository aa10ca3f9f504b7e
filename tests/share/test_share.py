"""A shared folder and a single file: content and errors."""

import base64
import hashlib
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from commands import Commands
from page_tags import Tags
from PIL import Image
from synthetic_avatar import synthetic_avatar

from mua.asset import write
from mua.avatar.camera import FILL
from mua.rig.bounds import root_positions
from mua.rotation import multiply
from mua.share import folder, single, site
from mua.share.poster import front, opening, view
from mua.share.single import in_order

ON_DEMAND = (  # modules that no page needs before it shows an avatar
    *(
        "names/",
        "retarget/",
        "worker.js",
        "expressing.js",
        "rules.js",
        "wgsl/expressions.js",
        "vr.js",
        "headset.js",
        "picture.js",
    ),
    *("anatomy.js", "surface_mesh.js", "wgsl/skeleton.js", "wgsl/surface.js"),
)


def share(command: Commands, *arguments: object) -> str:
    """The printed output of mua-share."""
    ended = command("share", "--reference", *arguments)
    assert ended.status == 0, ended.err
    return ended.out


def test_a_folder_holds_player_avatar_poster_and_page(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    printed = share(command, avatar_file, "-o", tmp_path / "out", "--title", 'A <"hero">', "--clip", "wave")
    files = {path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*") if path.is_file()}
    assert {"index.html", "page.js", "style.css", "player.js", "poster.png", "a.muaavatar"} <= files
    assert printed.startswith(f"{tmp_path / 'out'}: {len(files)} files, ")
    assert (tmp_path / "out" / "a.muaavatar").read_bytes() == avatar_file.read_bytes()
    element = Tags((tmp_path / "out" / "index.html").read_text()).one("mua-avatar")
    assert (element["src"], element["poster"], element["clip"]) == ("a.muaavatar", "poster.png", "wave")
    assert {"autoplay", "controls", "azimuth"} <= set(element)
    assert "<title>A &lt;&quot;hero&quot;&gt;</title>" in (tmp_path / "out" / "index.html").read_text()


def test_the_poster_shows_the_figure_on_nothing(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    share(command, avatar_file, "-o", tmp_path / "out")
    with Image.open(tmp_path / "out" / "poster.png") as poster:
        assert (poster.mode, poster.size[1]) == ("RGBA", 960)
        alpha = np.asarray(poster.getchannel("A"))
        assert (alpha.min(), alpha.max() > 200) == (0, True)


def test_the_box_of_the_figure_fills_width_and_height_of_the_poster(avatar_file: Path) -> None:
    avatar, clip = opening(avatar_file, None)
    gone = np.array([5, 0.5, -3], np.float32)
    translations = clip.translations.copy()
    translations[:, avatar.rig.skeleton.root] += gone
    for wide in (1, 3):
        bounds = avatar.bounds * [wide, 1, 1]
        camera = view(replace(avatar, bounds=bounds), replace(clip, translations=translations))
        box = bounds + root_positions(avatar.rig, clip)[0] + gone
        corners = np.array(np.meshgrid(*box.T, [1.0])).reshape(4, -1)
        x, y, _, w = camera.projection @ camera.view @ corners
        assert [np.abs(x / w).max(), np.abs(y / w).max()] == pytest.approx([FILL, FILL], rel=0.01)


def test_poster_and_page_show_the_front_that_the_first_frame_has() -> None:
    avatar = synthetic_avatar()
    first = avatar.clips[0].cut(np.zeros(1, int))
    turned = first.rotations.copy()
    turned[:, 0] = multiply(np.array([np.sqrt(0.5), 0, np.sqrt(0.5), 0]), turned[:, 0])
    turning = first.then(replace(first, rotations=turned))
    assert front(avatar, turning) == front(avatar, first)
    assert np.array_equal(view(avatar, turning).view, view(avatar, first).view)


def test_poster_and_page_begin_with_the_clip_asked_for(command: Commands, tmp_path: Path) -> None:
    avatar = synthetic_avatar()
    clip, root = avatar.clips[0], avatar.rig.skeleton.root
    rotations = clip.rotations.copy()
    rotations[:, root] = multiply(np.array([0.6, 0, 0.8, 0]), rotations[:, root])  # about the vertical
    backward = replace(clip, name="turned", rotations=rotations[::-1])
    write(tmp_path / "a.muaavatar", replace(avatar, clips=(clip, backward)))
    begins = {}
    for name in ("wave", "turned"):
        share(command, tmp_path / "a.muaavatar", "-o", tmp_path / "out", "--clip", name)
        element = Tags((tmp_path / "out" / "index.html").read_text()).one("mua-avatar")
        fronts = front(*opening(tmp_path / "a.muaavatar", name))
        assert float(element["azimuth"] or 0) == pytest.approx(fronts, abs=0.06)
        begins[name] = element["azimuth"], (tmp_path / "out" / "poster.png").read_bytes()
    assert all(one != other for one, other in zip(begins["wave"], begins["turned"], strict=True))


def test_everything_that_the_page_names_is_in_the_folder(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    share(command, avatar_file, "-o", tmp_path / "out")
    tags = Tags((tmp_path / "out" / "index.html").read_text()).found
    modules = [path for path in site.player_files() if path.endswith(".js") and not path.startswith(ON_DEMAND)]
    assert [given["href"] for _, given in tags if given.get("rel") == "modulepreload"] == modules
    named = [value for _, given in tags for name, value in given.items() if name in ("src", "href", "poster")]
    assert len(named) == 5 + len(modules)
    assert all((tmp_path / "out" / str(name)).is_file() for name in named)


def test_avatars_of_one_name_and_of_odd_names_all_have_a_place(avatar_file: Path, tmp_path: Path) -> None:
    odd = tmp_path / "my hero & co.muaavatar"
    odd.write_bytes(avatar_file.read_bytes())
    found = site.player_site([avatar_file, odd, avatar_file], site.Shown("three"))
    paths = [path for path in found if path.endswith(".muaavatar")]
    assert paths == ["a.muaavatar", "my-hero-co.muaavatar", "a-1.muaavatar"]


def test_a_shared_folder_is_replaced_whole(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    share(command, avatar_file, "-o", tmp_path / "out")
    (tmp_path / "out" / "stale.js").touch()
    share(command, avatar_file, "-o", tmp_path / "out", "--title", "again")
    assert not (tmp_path / "out" / "stale.js").exists()
    assert "<title>again</title>" in (tmp_path / "out" / "index.html").read_text()
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_folder_with_other_files_is_left_alone(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "index.html").write_text("<p>mine</p>")
    ended = command("share", avatar_file, "-o", tmp_path / "own")
    assert ended.sentence == (
        f"error: -o {tmp_path / 'own'}: holds other files, which would be lost; expected a new folder or a shared one"
    )
    assert (tmp_path / "own" / "index.html").read_text() == "<p>mine</p>"


def test_a_folder_that_cannot_be_finished_leaves_the_old_one(tmp_path: Path) -> None:
    out = tmp_path / "out"
    folder.write_folder(out, {"index.html": b"old"})
    with pytest.raises(folder.InputError, match="cannot be written"):
        folder.write_folder(out, {"index.html": b"new", "gone.muaavatar": tmp_path / "gone"})
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
    assert (out / "index.html").read_bytes() == b"old"


def test_a_damaged_avatar_is_not_shared(command: Commands, tmp_path: Path) -> None:
    (tmp_path / "bad.muaavatar").write_bytes(b"not an avatar")
    ended = command("share", tmp_path / "bad.muaavatar", "-o", tmp_path / "out")
    assert "bad.muaavatar" in ended.sentence
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("more", [(), ("--single-file",)])
def test_an_avatar_that_is_damaged_beside_a_sound_one_is_named(
    command: Commands, avatar_file: Path, tmp_path: Path, more: tuple[str, ...]
) -> None:
    (tmp_path / "bad.muaavatar").write_bytes(b"not an avatar")
    output = tmp_path / ("out.html" if more else "out")
    assert "bad.muaavatar" in command("share", avatar_file, tmp_path / "bad.muaavatar", *more, "-o", output).sentence
    assert not output.exists()


def test_rejects_an_unknown_clip_before_anything_is_written(
    command: Commands, avatar_file: Path, tmp_path: Path
) -> None:
    assert "'jump'" in command("share", avatar_file, "--clip", "jump", "-o", tmp_path / "out").sentence
    assert not (tmp_path / "out").exists()


def test_a_single_file_holds_the_avatar_and_allows_only_its_own_script(
    command: Commands, avatar_file: Path, tmp_path: Path
) -> None:
    share(command, avatar_file, "--single-file", "-o", tmp_path / "one.html")
    page = (tmp_path / "one.html").read_text()
    held = re.search(r'data-name="a\.muaavatar">([^<]*)<', page)
    assert held
    assert base64.b64decode(held[1]) == avatar_file.read_bytes()
    (script,) = re.findall(r"<script>(.*?)</script>", page, re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    (meta,) = [given for tag, given in Tags(page).found if tag == "meta" and "http-equiv" in given]
    assert f"script-src 'sha256-{digest}' blob:;" in str(meta["content"])
    assert [
        given for _, given in Tags(page).found if str(given.get("src") or given.get("href") or "data:")[:5] != "data:"
    ] == []


def test_every_module_of_the_single_file_finds_those_that_it_imports(avatar_file: Path) -> None:
    page = single.single_page([avatar_file], site.Shown("one"))
    found = re.search(r'id="modules">(.*?)</script>', page, re.DOTALL)
    assert found
    made: set[str] = set()
    for path, text in json.loads(found[1]):
        assert set(re.findall(r'"mua:([^"]+)"', text)) <= made, path
        code = re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.DOTALL)
        assert not re.search(r'(?:from|import|import\()\s*"\.', code), path
        assert "import.meta" not in code, path
        made.add(path)
    assert "page.js" in made


def test_modules_that_import_each_other_in_a_circle_are_refused() -> None:
    assert in_order({"a.js": 'import { b } from "./b.js";', "b.js": ""}) == ["b.js", "a.js"]
    with pytest.raises(ValueError, match="in a circle"):
        in_order({"a.js": 'import { b } from "./b.js";', "b.js": 'export { a } from "./a.js";'})


def test_avatars_too_large_for_a_single_file_are_refused(
    command: Commands, avatar_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(single, "LARGEST", 1000)
    sentence = command("share", avatar_file, "--single-file", "-o", tmp_path / "one.html").sentence
    assert "expected at most" in sentence
    assert not (tmp_path / "one.html").exists()


def test_a_single_file_is_an_html_file(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    sentence = command("share", avatar_file, "--single-file", "-o", tmp_path / "one").sentence
    assert sentence == f"error: -o is {tmp_path / 'one'}; expected a name that ends in .html with --single-file"
