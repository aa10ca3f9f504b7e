"""Sends live poses to a page, as python/mua/web/bridge.js reads them."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from time import monotonic

import numpy as np

from mua.live.live_pose import Live
from mua.live.receiver import Latency
from mua.pose.skeleton import Pose
from mua.share.site import BRIDGE, PAGE, PLAYER, SCRIPT, Content, Site
from mua.share.websocket import WebSocket

PATH = "live"
TICK = 1 / 60  # seconds between looks at what has come
AGAIN = 1.0  # seconds after which a pose that stays is sent once more: to avatars that have been loaded since
MOST_UNDRAWN = 60  # poses that a page which is out of sight may owe an answer to
DECIMALS = 6  # of a number: less than the rounding of VMC's own


@dataclass(frozen=True)
class Feed:
    """What a page shows live; each of its sockets is fed in a thread of its own."""

    performers: Sequence[Live]  # in the order of the page's avatars
    latency: Latency

    def feed(self, socket: WebSocket) -> None:
        """Send poses until the page has gone."""
        sent: tuple[int, ...] = ()
        begun = at = monotonic()
        arrivals: dict[str, float] = {}  # of poses that are not drawn yet, by their id
        while (replies := socket.replies(TICK)) is not None:
            now = monotonic()
            for reply in replies:
                if reply in arrivals:
                    self.latency.drawn(arrivals.pop(reply), now)
            poses = [performer.advance(now) for performer in self.performers]
            moments = tuple(performer.moment for performer in self.performers)
            if moments == sent and now - at < AGAIN:
                continue
            sent, at, number = moments, now, str(round((now - begun) * 1e6))
            arrived = self.performers[0].arrived
            arrivals = dict(list(arrivals.items())[-MOST_UNDRAWN:]) | ({} if arrived is None else {number: arrived})
            socket.send(json.dumps({"id": int(number), "avatars": [_written(shown.pose) for shown in poses]}))


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
