"""mua-view --web: avatars in a browser, served from this machine."""

import math
import webbrowser
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import typer

from mua.errors import InputError
from mua.files.inputs import require_file
from mua.player.toggles import parse_toggles
from mua.share.poster import front, opening
from mua.share.server import address, serving
from mua.share.site import Shown, player_site, title_of


def check_web(given: Mapping[str, object]) -> None:
    """Raises InputError for an option that would change nothing in a browser; None and False are not given."""
    for option, value in given.items():
        if value is not None and value is not False:
            raise InputError(f"{option}: does not work with --web; the page has controls of its own")


@dataclass(frozen=True)
class Where:
    """From where a page shows avatars when it is opened."""

    azimuth: float  # degrees from the figure's front
    elevation: float  # degrees
    orbit: float | None  # degrees per second
    stereo: bool

    def attributes(self, front: float) -> dict[str, str]:
        """Attributes of the element for one that faces `front` degrees; raises InputError for what is no number."""
        given = {"azimuth": self.azimuth, "elevation": self.elevation, "orbit": self.orbit or 0.0}
        for name, value in given.items():
            if not math.isfinite(value):
                raise InputError(f"--{name} is {value}; expected a finite number of degrees")
        more = {"azimuth": f"{self.azimuth + front:.1f}", "elevation": f"{self.elevation:g}"}
        more |= {} if self.orbit is None else {"orbit": f"{self.orbit:g}"}
        return more | ({"stereo": ""} if self.stereo else {})


def serve(
    files: list[Path],
    where: Where,
    *,
    clip: str | None,
    show: str | None,
    opens: bool,  # a browser
) -> None:
    """Serve the player with avatars until Ctrl-C is pressed.

    Errors: InputError for a file that is damaged or holds no such clip, and for a word that --show does not know.
    """
    for file in files:
        require_file(file)
    started = [opening(file, clip) for file in files]
    more = where.attributes(front(*started[0]))
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
    """The element's attribute `show`."""
    parse_toggles(text)
    return ",".join(word.strip() for word in text.split(","))
