"""mua-view --web: avatars in a browser, served from this machine."""

import webbrowser
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path

import typer

from mua.cli.listening import listening
from mua.cli.option_values import parse_angle
from mua.cli.view_options import Asked, check_together
from mua.errors import InputError
from mua.files.inputs import require_file
from mua.live.receiver import Address
from mua.motion.mapping import read_mapping
from mua.player.motion import live_of
from mua.player.toggles import parse_toggles
from mua.share.live_feed import PATH, Feed, live_site
from mua.share.poster import front, opening
from mua.share.server import address, serving
from mua.share.site import Shown, player_site, title_of

IN_PAGE = ("--azimuth", "--elevation", "--orbit", "--stereo", "--show", "--clip", "--listen", "--mapping")


def check_web(given: Mapping[str, object]) -> None:
    """Raises InputError for an option that would change nothing in a browser; None and False are not given."""
    for option, value in given.items():
        if value is not None and value is not False and option not in IN_PAGE:
            raise InputError(f"{option}: does not work with --web; the page has controls of its own")
    check_together({option for option, value in given.items() if value is not None and value is not False})


def attributes(asked: Asked, front: float) -> dict[str, str]:
    """Attributes of the page's element for a figure that faces `front` degrees.

    Raises InputError for what is no finite number.
    """
    for name in ("azimuth", "elevation", "orbit"):
        parse_angle(f"--{name}", getattr(asked, name) or 0.0)
    more = {"azimuth": f"{asked.azimuth + front:.1f}", "elevation": f"{asked.elevation:g}"}
    more |= {} if asked.orbit is None else {"orbit": f"{asked.orbit:g}"}
    return more | ({"stereo": ""} if asked.stereo else {})


def serve(
    files: list[Path],
    asked: Asked,
    *,
    clip: str | None,
    opens: bool,  # a browser
    listen: Address | None,
    mapping: Path | None,
) -> None:
    """Serve the player with avatars until Ctrl-C is pressed.

    Errors: InputError for a file that is damaged or holds no such clip, for a word that --show does not know, and where
    `listen` cannot be listened on or no avatar can follow what comes there.
    """
    for file in files:
        require_file(file)
    started = [opening(file, clip) for file in files]
    more = attributes(asked, front(*started[0]))
    more |= {} if listen is None else {"live": PATH}
    shown = Shown(title_of(files), clip, None if asked.show is None else _shown(asked.show), more)
    joints = None if mapping is None else read_mapping(mapping)
    site = player_site(files, shown)
    with ExitStack() as open_now:
        streams = {}
        if (receiver := open_now.enter_context(listening(listen))) is not None:
            followers = [
                live_of(avatar, file, receiver, joints) for file, (avatar, _) in zip(files, started, strict=True)
            ]
            site, streams = live_site(site), {PATH: Feed(followers, receiver.latency)}
        server = open_now.enter_context(serving(site, streams))
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
