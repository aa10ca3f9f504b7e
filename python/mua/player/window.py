"""The interactive player's window; nothing of a window system is loaded before there is a display."""

import os
import sys
import warnings
from typing import TYPE_CHECKING, Any

from mua.errors import InputError

if TYPE_CHECKING:
    from rendercanvas import BaseRenderCanvas

    from mua.player.played_files import Source
    from mua.player.shot import Look

MISSING = "a window needs a display and there is none; -o writes an image or a video, --web serves a page"


def show(source: "Source", look: "Look", *, device: str | None = None) -> None:
    """Show avatars in a window until it is closed, on the graphics device of that name or number.

    Errors: InputError where there is no display, where the first avatar cannot be shown, or where it has no such clip.
    """
    require_display()
    from mua.gpu import open_device
    from mua.player.viewer import Viewer

    opened = open_device(device)
    width, height = look.shot.screen
    canvas, loop = _open_canvas((width if look.shot.eyes is None else 2 * width, height))
    try:
        Viewer(canvas, opened, source, look)
        loop.run()
    finally:
        canvas.close()


def require_display() -> None:
    """Raise InputError where there is no display, as far as is known without loading anything."""
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise InputError(MISSING)


def _open_canvas(size: tuple[int, int]) -> tuple["BaseRenderCanvas", Any]:
    """A window of this size in logical pixels and the loop that runs it; InputError where there is no display."""
    import glfw  # here: with rendercanvas below it starts GLFW

    with warnings.catch_warnings():
        warnings.simplefilter("error", glfw.GLFWError)
        try:
            glfw.init()
            from rendercanvas.glfw import RenderCanvas, loop

            return RenderCanvas(title="mua-view", size=size, update_mode="ondemand", max_fps=120), loop
        except glfw.GLFWError as error:
            raise InputError(f"{MISSING} ({error})") from error
