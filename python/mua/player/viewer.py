"""A session on a canvas: it draws there, under the panel, and follows the canvas's mouse and keys."""

import time
from collections.abc import Mapping
from typing import Any

from rendercanvas import BaseRenderCanvas
from wgpu.utils.imgui import ImguiRenderer

from mua.gpu import Device
from mua.player.panel import KEYS, draw_panel
from mua.player.played_files import Source
from mua.player.session import Session
from mua.player.shot import Look

EVENTS = ("pointer_down", "pointer_up", "pointer_move", "wheel", "key_down", "key_up", "char", "resize")
SETTLING = 3  # images after an event: the panel answers a click in the one after it
LONGEST_STEP = 0.25  # seconds that a clip goes on at once, so that it does not leap after a pause
SMOOTHING = 0.1  # share of the newest image in the rate
LEFT = 1  # mouse button
NOTCH = 100.0  # units of a wheel event


class Viewer:
    """Draws a session on a canvas and hands the canvas's events to it."""

    def __init__(self, canvas: BaseRenderCanvas, device: Device, source: Source, look: Look) -> None:
        """Start a session. Errors: InputError where Session raises it."""
        self._canvas = canvas
        self._context = canvas.get_wgpu_context()
        # Colours are display-referred: the canvas must not encode them once more.
        color_format = self._context.get_preferred_format(device.wgpu.adapter).removesuffix("-srgb")
        self._context.configure(device=device.wgpu, format=color_format)
        self.session = Session(device, source, look, color_format=color_format)
        self._rate, self._before = 0.0, time.perf_counter()
        self._settling, self._mouse = SETTLING, (0.0, 0.0)
        self._gui = ImguiRenderer(device.wgpu, canvas)
        self._gui.backend.io.set_ini_filename("")  # leave no file behind
        self._gui.set_gui(lambda: draw_panel(self.session, rate=self._rate))
        canvas.add_event_handler(self._on_event, *EVENTS)
        # before the panel, which may keep an event to itself
        canvas.add_event_handler(self._wake, *EVENTS, order=-100)
        canvas.request_draw(self._draw)

    def _draw(self) -> None:
        now = time.perf_counter()
        elapsed, self._before = now - self._before, now
        self._rate += SMOOTHING * (1 / max(elapsed, 1e-3) - self._rate)
        self.session.advance(min(elapsed, LONGEST_STEP))
        self.session.draw(self._context.get_current_texture())
        self._gui.render()
        self._settling -= 1
        if self.session.playing or self._settling > 0:
            self._canvas.request_draw()

    def _wake(self, event: Mapping[str, Any]) -> None:
        self._settling = SETTLING
        self._canvas.request_draw()

    def _on_event(self, event: Mapping[str, Any]) -> None:
        kind, view = event["event_type"], self.session.view
        if kind == "key_down" and event["key"] in KEYS:
            KEYS[event["key"]][2](self.session)
        elif kind == "wheel" and view is not None:
            self.session.view = view.zoomed(-event["dy"] / NOTCH)
        elif kind == "pointer_down":
            self._mouse = (event["x"], event["y"])
        elif kind == "pointer_move" and event["buttons"] and view is not None:
            right, down = event["x"] - self._mouse[0], event["y"] - self._mouse[1]
            self._mouse = (event["x"], event["y"])
            height = int(self._canvas.get_logical_size()[1])
            pans = LEFT not in event["buttons"] or "Shift" in event["modifiers"]
            self.session.view = view.panned(right, down, height=height) if pans else view.turned(right, down)
