"""The files of a site that plays avatars: the player's own, a page, the avatars and their image."""

import html
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import TypeAlias
from urllib.parse import quote

PLAYER = Path(__file__).parents[1] / "web"  # plain files, served as they are
PAGE = "index.html"
SERVED = (".js", ".css", ".wgsl", ".svg")  # of the player's files; the others are for builders
POSTER = "poster.png"
SCRIPT = '<script type="module"'  # of the page
WORKER = "worker.js"  # begins a module graph of its own
ELEMENT = "<mua-avatar "
UNSAFE = re.compile(r"[^\w.-]+")  # in a file name, for some web host

Content: TypeAlias = bytes | Path
Site: TypeAlias = Mapping[str, Content]  # by path below the site's address


@dataclass(frozen=True)
class Shown:
    """What a page shows and how it begins."""

    title: str
    clip: str | None = None  # the first one if None
    show: str | None = None  # as the element's attribute; splats and shadow if None
    more: Mapping[str, str] = field(default_factory=dict)  # further attributes of the element


def player_files() -> dict[str, Path]:
    """The player's own files but its page, by path."""
    paths = [path for path in sorted(PLAYER.rglob("*")) if path.is_file() and path.suffix in SERVED]
    return {path.relative_to(PLAYER).as_posix(): path for path in paths}


def player_site(avatars: Sequence[Path], shown: Shown, *, poster: bytes | None = None) -> dict[str, Content]:
    """A whole site. An avatar has the path of its file's name, with a number where two have the same."""
    names = _names(avatars)
    site: dict[str, Content] = {**player_files(), **dict(zip(names, avatars, strict=True))}
    attributes = {"src": " ".join(map(quote, names))}
    if poster is not None:
        site[POSTER] = poster
        attributes["poster"] = POSTER
    site[PAGE] = page(shown, attributes).encode()
    return site


def page(shown: Shown, attributes: Mapping[str, str]) -> str:
    """The player's page with so many attributes of its element, and with a title of its own."""
    given = {"clip": shown.clip, "show": shown.show, **shown.more, **attributes}
    written = "".join(f'{name}="{html.escape(value)}" ' for name, value in given.items() if value is not None)
    text = (PLAYER / PAGE).read_text(encoding="utf-8")
    titled = re.sub(r"<title>.*?</title>", lambda _: f"<title>{html.escape(shown.title)}</title>", text, count=1)
    return titled.replace(ELEMENT, ELEMENT + written, 1).replace(SCRIPT, _preloads() + SCRIPT, 1)


def _preloads() -> str:
    """Lines by which a browser fetches all modules at once, before it has read which of them imports which."""
    modules = [path for path in player_files() if path.endswith(".js") and path != WORKER]
    return "".join(f'<link rel="modulepreload" href="{path}">\n' for path in modules)


def title_of(avatars: Sequence[Path]) -> str:
    """What a page of these is called where nobody says."""
    return ", ".join(path.stem for path in avatars)


def _names(avatars: Sequence[Path]) -> list[str]:
    """File names that any web host takes, each once."""
    names: list[str] = []
    for avatar in avatars:
        plain = PurePosixPath(UNSAFE.sub("-", avatar.name).lstrip(".-") or "avatar")
        free = (f"{plain.stem}{f'-{count}' if count else ''}{plain.suffix}" for count in range(len(avatars)))
        names.append(next(name for name in free if name not in names))
    return names
