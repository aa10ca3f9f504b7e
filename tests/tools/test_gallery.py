"""The gallery's manifest and table; with `-m gallery` the characters themselves, from the folder $GALLERY."""

import os
from pathlib import Path
from typing import Any

import gallery
import pytest
from column_files import column_file
from gallery import Entry, find, good, look_at, read_manifest, sheet, table

ENTRIES = read_manifest()
FOLDER = os.environ.get("GALLERY", "")


def test_the_manifest_says_of_every_file_where_it_is_from() -> None:
    assert len(ENTRIES) >= 24
    assert len({entry.name for entry in ENTRIES}) == len(ENTRIES)
    for entry in ENTRIES:
        assert entry.source, entry.name
        assert entry.licence, entry.name
        assert all(not Path(name).is_absolute() for name in entry.files()), entry.name


def test_a_failure_is_one_row_and_nothing_is_done_twice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder, out = tmp_path / "files", tmp_path / "out"
    folder.mkdir()
    out.mkdir()
    column_file(folder)
    (folder / "broken.glb").write_bytes(b"not a model")
    names = ("column.glb", "broken.glb", "absent.glb")
    entries = [Entry(name=Path(name).stem, file=name, source="here", licence="CC0") for name in names]
    monkeypatch.setattr(gallery, "TEXELS", 64)
    rows = [look_at(entry, folder, out, bake=False) for entry in entries]
    assert rows[0]["failed"] == ""
    assert 0.8 < rows[0]["iou"] < 1
    assert "broken.glb" in rows[1]["failed"]
    assert rows[2]["failed"] == "not in the folder: absent.glb"
    monkeypatch.setattr(gallery, "run", lambda *_: pytest.fail("was run again"))
    assert look_at(entries[0], folder, out, bake=False) == rows[0]
    text = table(entries, rows)
    assert "| column | own (1) |" in text
    assert "- absent: not in the folder" in text
    picture = sheet(entries, rows, out)
    assert picture.height == 3 * (gallery.STRIP[1] // 2 + 20)


@pytest.mark.parametrize(("figures", "expected"), [((0.98, 31.0), True), ((0.96, 31.0), False), ((0.98, 29.0), False)])
def test_good_means_silhouette_and_colours(figures: tuple[float, float], expected: bool) -> None:
    row: dict[str, Any] = {"iou": figures[0], "psnr": figures[1], "failed": ""}
    assert good(row) == expected
    assert not good(row | {"failed": "it stopped"})


@pytest.mark.gallery
@pytest.mark.parametrize("entry", ENTRIES, ids=[entry.name for entry in ENTRIES])
def test_a_character_looks_like_its_source_or_it_is_known_why_not(entry: Entry, tmp_path: Path) -> None:
    missing = [name for name in entry.files() if find(Path(FOLDER), name) is None]
    if not FOLDER or missing:
        pytest.skip(f"needs {', '.join(missing) or 'the files'} in the folder $GALLERY ({FOLDER or 'not set'})")
    row = look_at(entry, Path(FOLDER), tmp_path, bake=False)
    assert not row["failed"]
    assert good(row) or entry.expected, row["warnings"]
