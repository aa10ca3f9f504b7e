"""The pages: links lead somewhere, named files exist, and commands take the arguments shown."""

import os
import re
import shlex
import tomllib
from collections import Counter
from functools import cache
from pathlib import Path

import pytest
import typer.core
from commands import Commands

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = tomllib.loads((ROOT / "python" / "pyproject.toml").read_text())["project"]["scripts"]
BUILT = ("build", "node_modules", ".")  # prefixes of folders without pages
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"^```.*?^```|^ {4}.*?$|`[^`\n]+`", re.DOTALL | re.MULTILINE)
NAMED = re.compile(r"`((?:ComputeShaders|docs|python|schemas|tests|tools|unity-package)/[\w./~-]*\w)`")
TOOL = re.compile(r"python ((?:tools|tests)/[\w/]+\.py)(.*)")
COMMAND = re.compile(r"(?:^|[\s/\\`])(mua-|-m mua\.cli\.)(\w+)(?=\s|$)(.*)$")
REPLACED = re.compile(r"\.\.\.|\[[^\]]*\]")  # placeholders for the reader's own words


def _pages() -> list[Path]:
    found = []
    for folder, below, files in os.walk(ROOT):
        below[:] = [name for name in below if not name.startswith(BUILT)]
        found += [Path(folder) / name for name in files if name.endswith(".md")]
    return sorted(found)


PAGES = {page.relative_to(ROOT).as_posix(): page for page in _pages()}


@cache
def anchors(page: Path) -> set[str]:
    """Anchors of a page's headings, as GitHub makes them."""
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.DOTALL | re.MULTILINE)
    seen, found = Counter[str](), set()
    for heading in re.findall(r"^#+ (.+?)\s*$", text, re.MULTILINE):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
        slug = re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")
        found.add(slug if not seen[slug] else f"{slug}-{seen[slug]}")
        seen[slug] += 1
    return found


def lost_links(page: Path) -> list[str]:
    """Links of a page that lead nowhere in the repository."""
    lost = []
    for target in LINK.findall(CODE.sub("", page.read_text())):
        path, _, anchor = target.partition("#")
        if path.startswith(("http:", "https:", "mailto:")):
            continue
        other = page.parent / path if path else page
        if not other.exists() or (anchor and anchor not in anchors(other)):
            lost.append(target)
    return lost


def commands(page: Path) -> list[tuple[str, str]]:
    """Names and arguments of the mua- commands in a page's code, continued lines joined."""
    code = [found.group().strip("`") for found in CODE.finditer(page.read_text())]
    lines = re.sub(r"\\\n\s*", " ", "\n".join(code)).splitlines()
    found = [COMMAND.search(line.split(" # ")[0].split(";")[0].rstrip("\\ ")) for line in lines]
    return [(one.group(2), REPLACED.sub("", one.group(3))) for one in found if one]


SHOWN = sorted({(name, words, path) for path, page in PAGES.items() for name, words in commands(page)})


@pytest.mark.parametrize("path", PAGES)
def test_links_lead_somewhere(path: str) -> None:
    assert lost_links(PAGES[path]) == []


@pytest.mark.parametrize("path", PAGES)
def test_files_that_are_named_exist(path: str) -> None:
    text = PAGES[path].read_text()
    names = [*NAMED.findall(text), *(tool for tool, _ in TOOL.findall(text))]
    assert [name for name in names if not (ROOT / name).exists()] == []


def test_pages_show_commands_and_tools_with_options() -> None:
    """Else the tests of them below would ask nothing."""
    assert len(SHOWN) > 20
    shown = [words for page in PAGES.values() for _, words in TOOL.findall(page.read_text())]
    assert any("--" in words for words in shown)


@pytest.mark.parametrize("path", PAGES)
def test_tools_have_the_options_that_are_shown(path: str) -> None:
    """Options of argparse are strings, those of typer parameters."""
    for tool, words in TOOL.findall(PAGES[path].read_text()):
        source = (ROOT / tool).read_text()
        for option in re.findall(r"--([\w-]+)", words):
            assert re.search(rf'"--{option}"|\b{option.replace("-", "_")}: Annotated', source), f"{tool} --{option}"


@pytest.mark.parametrize(("name", "words", "path"), SHOWN, ids=[f"mua-{name}{words}" for name, words, _ in SHOWN])
def test_commands_take_what_is_shown(
    monkeypatch: pytest.MonkeyPatch, command: Commands, name: str, words: str, path: str
) -> None:
    """Options exist and take such values; arguments and a last value may be left out, as in a sentence about one."""
    assert SCRIPTS[f"mua-{name}"] == f"mua.cli.{name}:run"
    monkeypatch.setattr(typer.core.TyperCommand, "invoke", lambda *_: 0)  # arguments are parsed but nothing runs
    ended = command(name, *shlex.split(words))
    printed = " ".join(ended.err.split())
    enough = ended.status == 0 or "Missing " in printed or "requires an argument" in printed
    assert enough, f"{path}: mua-{name}{words}: {printed}"


def test_a_lost_link_and_a_lost_anchor_are_found(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(
        "# A *b*, c\n\n[x](#a-b-c) [x](#b) [x](page.md#a-b-c) [x](other.md) [x](https://host/y)\n\n`[x](z.md)`\n"
    )
    assert lost_links(page) == ["#b", "other.md"]
