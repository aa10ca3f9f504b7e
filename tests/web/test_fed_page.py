"""A page that `mua-view --web --listen` serves, in a headless browser: packets of VMC become poses of its avatar."""

import socket
import time

import numpy as np
import pytest
from people import person
from servers import answering
from vmc_senders import bundle
from web.browser import Browser

from mua.live.live_pose import EASING, Live
from mua.live.receiver import Address, Receiver
from mua.pose.encoding import PoseEncoding
from mua.share.live_feed import PATH, Feed, live_site
from mua.share.server import address, serving
from mua.share.site import Shown, player_site

PATIENCE = 60  # seconds for what takes one, on a busy machine
KEEPING = """
window.poses = [];
const avatar = { setPose: (pose) => window.poses.push(pose) };
Object.defineProperty(document.querySelector("mua-avatar"), "avatars", { value: [avatar] });
"""
LATE = """
const define = customElements.define.bind(customElements);
customElements.define = (...given) => setTimeout(define, 500, ...given);
"""  # as where the player's script comes long after the first poses


@pytest.mark.parametrize("before", ["", LATE], ids=["at once", "late"])
def test_packets_become_poses_of_the_page_and_their_latency_is_measured(browser: Browser, before: str) -> None:
    turned = bundle(
        ("/VMC/Ext/Bone/Pos", "Head", 0.0, 0.1, 0.0, 0.0, 0.6, 0.0, 0.8),
        ("/VMC/Ext/Blend/Val", "Joy", 0.5),
        ("/VMC/Ext/Blend/Apply",),
    )
    target = person()
    with Receiver(Address(0)) as receiver:
        live = Live(receiver.newest, target, PoseEncoding(joints=(1,), rate=30.0), expressions=("happy",))
        feed = Feed([live], receiver.latency)
        site = live_site(player_site([], Shown("live", more={"live": PATH})))
        with (
            serving(site, {PATH: feed}) as server,
            answering(server),
            browser.page(address(server), before=before) as page,
        ):
            page.wait('customElements.get("mua-avatar")')
            page.evaluate(f"(() => {{{KEEPING}}})()")
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as program:
                end = time.monotonic() + 2 * EASING
                while time.monotonic() < end or not page.evaluate("window.poses.at(-1)?.expressions[0] === 0.5"):
                    assert time.monotonic() < end + PATIENCE
                    program.sendto(turned, ("127.0.0.1", receiver.address.port))
                    time.sleep(0.01)
            pose = page.evaluate("window.poses.at(-1)")
            assert page.reported["errors"] == []
        head = target.names.index("Head")
        np.testing.assert_allclose(np.abs(pose["rotations"][4 * head : 4 * head + 4]), [0, 0.6, 0, 0.8], atol=1e-5)
        assert "from packet to picture" in receiver.figures
        print(receiver.figures)
