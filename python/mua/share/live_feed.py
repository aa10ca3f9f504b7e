"""Sends live poses to a page, as python/mua/web/bridge.js reads them."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from time import monotonic, sleep

import numpy as np

from mua.live.live_pose import Live
from mua.live.receiver import Latency
from mua.pose.skeleton import Pose
from mua.share.site import BRIDGE, PAGE, PLAYER, SCRIPT, Content, Site

PATH = "live"
TICK = 1 / 60  # seconds between looks at what has come
AGAIN = 1.0  # seconds after which a pose that stays is sent once more: to avatars that have been loaded since
MOST_UNDRAWN = 60  # poses that a page which is out of sight may owe an answer to
DECIMALS = 6  # of a number: less than the rounding of VMC's own


@dataclass(frozen=True)
class Feed:
    """What a page shows live."""

    performers: Sequence[Live]  # in the order of the page's avatars
    latency: Latency
    _arrivals: dict[str, float] = field(default_factory=dict)  # of poses that are not drawn yet, by their id

    def texts(self) -> Iterator[str]:
        """The poses of every avatar whenever one changes, as JSON."""
        sent: tuple[int, ...] = ()
        at = 0.0
        while True:
            now = monotonic()
            poses = [performer.advance(now) for performer in self.performers]
            moments = tuple(performer.moment for performer in self.performers)
            if moments != sent or now - at >= AGAIN:
                sent, at, number = moments, now, round(now * 1e6)
                self._note(str(number))
                yield json.dumps({"id": number, "avatars": [_written(shown.pose) for shown in poses]})
            sleep(TICK)

    def replied(self, text: str) -> None:
        """Take the id of poses that a page has drawn."""
        if (arrived := self._arrivals.pop(text, None)) is not None:
            self.latency.drawn(arrived, monotonic())

    def _note(self, number: str) -> None:
        for old in list(self._arrivals)[:-MOST_UNDRAWN]:
            self._arrivals.pop(old, None)
        if (arrived := self.performers[0].arrived) is not None:
            self._arrivals[number] = arrived


def live_site(site: Site) -> dict[str, Content]:
    """A site whose page listens to PATH."""
    page = site[PAGE]
    assert isinstance(page, bytes)
    script = f'<script type="module" src="{BRIDGE}"></script>\n'.encode()
    listening = page.replace(SCRIPT.encode(), script + SCRIPT.encode(), 1)
    return {**site, BRIDGE: PLAYER / BRIDGE, PAGE: listening}


def _written(pose: Pose) -> dict[str, list[float]]:
    """What setPose() of a page takes: quaternions as x, y, z, w."""
    numbers = {"rotations": np.roll(pose.rotations, -1, axis=-1), "translations": pose.translations}
    numbers |= {} if pose.expressions is None else {"expressions": pose.expressions}
    return {name: values.round(DECIMALS).ravel().tolist() for name, values in numbers.items()}
