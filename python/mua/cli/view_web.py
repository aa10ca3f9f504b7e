"""mua-view --web: avatars in a browser, served from this machine."""

import math
import webbrowser
from collections.abc import Mapping
from pathlib import Path

import typer

from mua.errors import InputError
from mua.inputs import require_file
from mua.player.toggles import parse_toggles
from mua.share.poster import front, opening
from mua.share.server import address, serving
from mua.share.site import Shown, player_site, title_of

MESH = {"template": "mesh"}  # what the element calls differently


def check_web(given: Mapping[str, object]) -> None:
    """Raises InputError for an option that would change nothing in a browser; None and False are not given."""
    for option, value in given.items():
        if value is not None and value is not False:
            raise InputError(f"{option}: does not work with --web; the page has controls of its own")


def serve(
    files: list[Path],
    *,
    clip: str | None,
    show: str | None,
    azimuth: float,  # degrees from the figure's front
    elevation: float,  # degrees
    orbit: float | None,  # degrees per second
    opens: bool,  # a browser
) -> None:
    """Serve the player with avatars until Ctrl-C is pressed.

    Errors: InputError for a file that is damaged or holds no such clip, and for a word that --show does not know.
    """
    for file in files:
        require_file(file)
    for option, value in {"--azimuth": azimuth, "--elevation": elevation, "--orbit": orbit or 0.0}.items():
        if not math.isfinite(value):
            raise InputError(f"{option} is {value}; expected a finite number of degrees")
    started = [opening(file, clip) for file in files]
    more = {"azimuth": f"{azimuth + front(*started[0]):.1f}", "elevation": f"{elevation:g}"}
    more |= {} if orbit is None else {"orbit": f"{orbit:g}"}
    shown = Shown(title_of(files), clip, None if show is None else _shown(show), more)
    with serving(player_site(files, shown)) as server:
        typer.echo(f"{shown.title}: {address(server)} (Ctrl-C ends)")
        if opens:
            webbrowser.open(address(server))
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            typer.echo("")


def _shown(text: str) -> str:
    """As the element's attribute."""
    parse_toggles(text)
    return ",".join(MESH.get(word.strip(), word.strip()) for word in text.split(","))
