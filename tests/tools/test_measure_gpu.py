"""The page of a machine's figures."""

import re
from collections.abc import Iterator
from pathlib import Path

import measure_gpu
import pytest


def test_what_fails_says_so_in_its_row(tmp_path: Path) -> None:
    seconds, said, works = measure_gpu.run("-m", "mua.cli.bench", str(tmp_path / "no|ne.muaavatar"))
    assert (works, seconds > 0) == (False, True)
    assert said == f"error: {tmp_path / 'no/ne.muaavatar'}: there is no such file"
    assert measure_gpu.row("play", "cpu", seconds, said).count("|") == 5


def test_nothing_is_taught_from_an_avatar_that_was_not_baked(tmp_path: Path) -> None:
    assert "nothing was baked" in measure_gpu.teach(tmp_path, "cpu", measure_gpu.QUICK)


def test_what_was_measured_stays_where_the_rest_is_stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(folder: Path, sizes: measure_gpu.Sizes) -> Iterator[tuple[str, str]]:
        yield "frames", "| `tiny` | a card | 1.00 |"
        raise KeyboardInterrupt

    monkeypatch.setattr(measure_gpu, "measurements", stopped)
    monkeypatch.setattr("sys.argv", ["measure_gpu.py", "-o", str(tmp_path / "gpu.md")])
    with pytest.raises(KeyboardInterrupt):
        measure_gpu.main()
    assert (tmp_path / "gpu.md").read_text().endswith("| `tiny` | a card | 1.00 |\n")


@pytest.mark.long
def test_the_smallest_sizes_fill_every_row(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = tmp_path / "gpu.md"
    monkeypatch.setattr("sys.argv", ["measure_gpu.py", "--quick", "-o", str(page)])
    measure_gpu.main()
    rows = [line.split("|") for line in page.read_text().splitlines() if re.match(r"\| [^-|]*(,|`|with)", line)]
    assert [row[1].split()[0] for row in rows] == ["bake", "distil", "draw", "teach,", "`tiny`"]
    assert "error" not in page.read_text()
    assert all(float(row[3]) > 0 for row in rows)
