"""The site that `make docs` builds: no warning, every guide and image in it, every public name in the reference."""

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import mua

ROOT = Path(__file__).resolve().parents[1]


@pytest.mark.long
def test_the_site_builds_without_a_warning(tmp_path: Path) -> None:
    if find_spec("mkdocs") is None:
        pytest.skip('mkdocs is not installed: pip install -e "./python[docs]"')
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path)]
    built = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    for page in ROOT.glob("docs/**/*.md"):
        name = page.relative_to(ROOT).with_name("index.md" if page.name == "README.md" else page.name)
        assert (tmp_path / name.with_suffix(".html")).is_file()
    for picture in ROOT.glob("docs/images/*"):
        assert (tmp_path / picture.relative_to(ROOT)).is_file()
    reference = (tmp_path / "docs" / "reference.html").read_text()
    assert [name for name in mua.__all__ if f'id="mua.{name}"' not in reference] == []
    assert "[N, 23] at the valid texels" in reference  # the comment beside an argument
