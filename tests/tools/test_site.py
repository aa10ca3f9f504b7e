"""The site that `make docs` builds: no warning, every guide and image in it, every public name in the reference."""

import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import mua

PROGRAMS = ("chromium-headless-shell", "chromium", "google-chrome")
ROOT = Path(__file__).resolve().parents[2]


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
    _check_links(tmp_path)
    _check_search(tmp_path)


def _check_links(site: Path) -> None:
    """Pages fetch nothing from elsewhere, and the sidebar has every name once."""
    fetched = re.compile(r'<(?:script|link)[^>]* (?:src|href)="https?://[^"]*')
    assert [found for page in site.rglob("*.html") for found in fetched.findall(page.read_text())] == []
    sidebar = (site / "docs" / "glossary.html").read_text().partition("md-sidebar--secondary")[0]
    links = re.findall(r'<a href="[^"#]*" class="md-nav__link[^"]*">(.*?)</a>', sidebar, re.DOTALL)
    names = [re.sub(r"<[^>]*>|\s+", " ", link).strip() for link in links]
    assert len(names) > 30
    assert sorted(names) == sorted(set(names))


def _check_search(site: Path) -> None:
    """A browser that opened a page from the disk finds pages by a word."""
    program = next(filter(None, map(shutil.which, PROGRAMS)), None)
    if program is None:
        pytest.skip("the rest needs a browser: apt-get install chromium-headless-shell")
    options = ("--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=20000", "--dump-dom")
    shown = subprocess.run(
        [program, *options, f"file://{site}/docs/recording.html?q=wavelet"], capture_output=True, text=True, check=False
    )
    assert re.search(r'md-search-result__meta">\d+ matching documents<', shown.stdout)
