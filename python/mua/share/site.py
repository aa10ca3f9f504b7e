"""The files of a site that plays avatars: the player's own, a page, the avatars and their image."""

import html
import posixpath
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import TypeAlias
from urllib.parse import quote

PLAYER = Path(__file__).parents[1] / "web"  # plain files, served as they are
PAGE = "index.html"
SERVED = (".js", ".css", ".wgsl", ".svg")  # ending of the player's files; others are for bundlers
POSTER = "poster.png"
SCRIPT = '<script type="module"'  # how the page's script begins
BRIDGE = "bridge.js"  # of pages that a program of this machine feeds
FIRST = ("page.js", "engine.js")  # roots of what every page needs; player.js imports the engine where there is WebGPU
STATIC = re.compile(r'^((?:import|export)\s+(?:[\w\s{},*]+\sfrom\s+)?)"(\.[^"]+)"', re.MULTILINE)
ELEMENT = "<mua-avatar "
UNSAFE = re.compile(r"[^\w.-]+")  # characters of a file name that some web hosts do not take

Content: TypeAlias = bytes | Path
Site: TypeAlias = Mapping[str, Content]  # by path below the site's address


@dataclass(frozen=True)
class Shown:
    """The content of a page and how it begins."""

    title: str
    clip: str | None = None  # the first one if None
    show: str | None = None  # the element's attribute; splats and shadow if None
    more: Mapping[str, str] = field(default_factory=dict)  # further attributes of the element


def player_files() -> dict[str, Path]:
    """The player's own files but its page and BRIDGE, by path."""
    paths = [path for path in sorted(PLAYER.rglob("*")) if path.suffix in SERVED and path.name != BRIDGE]
    return {path.relative_to(PLAYER).as_posix(): path for path in paths}


def player_site(avatars: Sequence[Path], shown: Shown, *, poster: bytes | None = None) -> dict[str, Content]:
    """The files of a site. An avatar's path is its file's name, with a number where two are equal."""
    names = _names(avatars)
    site: dict[str, Content] = {**player_files(), **dict(zip(names, avatars, strict=True))}
    attributes = {"src": " ".join(map(quote, names))}
    if poster is not None:
        site[POSTER] = poster
        attributes["poster"] = POSTER
    site[PAGE] = page(shown, attributes).encode()
    return site


def page(shown: Shown, attributes: Mapping[str, str]) -> str:
    """The player's page with these attributes of its element and this title."""
    given = {"clip": shown.clip, "show": shown.show, **shown.more, **attributes}
    written = "".join(f'{name}="{html.escape(value)}" ' for name, value in given.items() if value is not None)
    text = (PLAYER / PAGE).read_text(encoding="utf-8")
    titled = re.sub(r"<title>.*?</title>", lambda _: f"<title>{html.escape(shown.title)}</title>", text, count=1)
    return titled.replace(ELEMENT, ELEMENT + written, 1).replace(SCRIPT, _preloads() + SCRIPT, 1)


def _preloads() -> str:
    """Lines by which a browser fetches all modules that it needs at once, before it has read their imports."""
    return "".join(f'<link rel="modulepreload" href="{path}">\n' for path in sorted(needed(*FIRST)))


def needed(*roots: str) -> set[str]:
    """The player's modules that these import, and they themselves, by path; without what is imported on demand."""
    found: set[str] = set()
    left = list(roots)
    while left:
        path = left.pop()
        if path not in found:
            found.add(path)
            text = (PLAYER / path).read_text(encoding="utf-8")
            left += [below(path, each[2]) for each in STATIC.finditer(text)]
    return found


def below(path: str, target: str) -> str:
    """The path that a module's relative address leads to."""
    return posixpath.normpath(posixpath.join(posixpath.dirname(path), target))


def title_of(avatars: Sequence[Path]) -> str:
    """The default title of a page of these avatars."""
    return ", ".join(path.stem for path in avatars)


def _names(avatars: Sequence[Path]) -> list[str]:
    """Distinct file names that any web host takes."""
    names: list[str] = []
    for avatar in avatars:
        plain = PurePosixPath(UNSAFE.sub("-", avatar.name).lstrip(".-") or "avatar")
        free = (f"{plain.stem}{f'-{count}' if count else ''}{plain.suffix}" for count in range(len(avatars)))
        names.append(next(name for name in free if name not in names))
    return names
