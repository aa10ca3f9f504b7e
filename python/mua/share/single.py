"""One HTML file that holds the player and its avatars, to be opened from a disk or sent by mail.

Its policy allows the one script that begins it, by its hash, and what that script makes of the modules in the file:
blobs, one a module, each imported by others under its own address.
"""

import base64
import hashlib
import html
import json
import re
from collections.abc import Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

from mua.errors import InputError
from mua.share.site import STATIC, Shown, below, page, player_files

LARGEST = 24_000_000  # bytes of avatars; a third more as text, which browsers hold twice while they read it
DYNAMIC = re.compile(r'await import\("(\.[^"]+)"\)')
WORKER = re.compile(r'new URL\("(\.[^"]+)", import\.meta\.url\)')
BOOT = Path(__file__).with_name("single.js")
LINES = re.compile(r"^<(?:meta http-equiv|link|script)\b.*\n", re.MULTILINE)  # tags that refer to other files


def require_small(avatars: Sequence[Path]) -> None:
    """Raise InputError for more bytes than a page should hold."""
    total = sum(avatar.stat().st_size for avatar in avatars)
    if total > LARGEST:
        raise InputError(
            f"--single-file: the avatars have {total / 1e6:.1f} MB; expected at most {LARGEST / 1e6:.0f} MB, because a "
            "browser reads the whole file before it shows anything; a folder has no such limit"
        )


def single_page(avatars: Sequence[Path], shown: Shown, *, poster: bytes | None = None) -> str:
    """The page with everything that it needs in it."""
    files = player_files()
    style = files["style.css"].read_text(encoding="utf-8")
    boot = BOOT.read_text(encoding="utf-8")
    attributes = {} if poster is None else {"poster": data_url("image/png", poster)}
    text = LINES.sub("", page(shown, attributes))
    head = [
        f'<meta http-equiv="Content-Security-Policy" content="{html.escape(_policy(boot, style))}">',
        f'<link rel="icon" href="{data_url("image/svg+xml", files["icon.svg"].read_bytes())}">',
        f"<style>{style}</style>",
    ]
    tail = [
        f'<script type="application/json" id="modules">{_json(_modules(files))}</script>',
        *(_held(avatar) for avatar in avatars),
        f"<script>{boot}</script>",
    ]
    opened = text.replace("<meta name=", "\n".join(head) + "\n<meta name=", 1)
    return opened.replace("</body>", "\n".join(tail) + "\n</body>", 1)


def in_order(sources: Mapping[str, str]) -> list[str]:
    """Modules by path, each after those that it imports when it begins."""
    needed = {path: [below(path, each[2]) for each in STATIC.finditer(text)] for path, text in sources.items()}
    try:
        return list(TopologicalSorter(needed).static_order())
    except CycleError as error:
        raise ValueError(f"modules import each other in a circle: {error.args[1]}") from error


def _modules(files: Mapping[str, Path]) -> list[tuple[str, str]]:
    """Path and text of every module in order of their imports, with paths in place of addresses."""
    sources = {path: file.read_text(encoding="utf-8") for path, file in files.items() if file.suffix == ".js"}
    return [(path, _rewritten(path, sources[path])) for path in in_order(sources)]


def _rewritten(path: str, text: str) -> str:
    """A module whose static imports are `mua:` and a path, and whose dynamic imports are looked up when they run."""
    text = STATIC.sub(lambda found: f'{found[1]}"mua:{below(path, found[2])}"', text)
    text = DYNAMIC.sub(lambda found: f'await import(muaModules["{below(path, found[1])}"])', text)
    return WORKER.sub(lambda found: f'muaModules["{below(path, found[1])}"]', text)


def _policy(boot: str, style: str) -> str:
    return (
        f"default-src 'none'; script-src {_hash(boot)} blob:; style-src {_hash(style)}; img-src data: blob:; "
        "worker-src blob:; base-uri 'none'; form-action 'none'"
    )


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def data_url(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def _json(value: object) -> str:
    """JSON that may stand in a script element."""
    return json.dumps(value).replace("<", "\\u003c")


def _held(avatar: Path) -> str:
    content = base64.b64encode(avatar.read_bytes()).decode()
    return f'<script type="application/octet-stream" data-name="{html.escape(avatar.name)}">{content}</script>'
