"""The interactive player's window; nothing of a window system is loaded before there is a display."""

import os
import sys
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mua.errors import InputError
from mua.gpu import Device

if TYPE_CHECKING:
    from rendercanvas import BaseRenderCanvas

SIZE = (1280, 860)  # logical pixels


def show(
    files: Sequence[Path],
    device: Device,
    *,
    clip: str | None = None,
    motion: Path | None = None,
    mapping: Mapping[str, str] | None = None,
) -> None:
    """Show avatars in a window until it is closed; clips are the files' own, or those of `motion`.

    Errors: InputError where there is no display, where the first avatar cannot be shown, or where it has no such clip.
    """
    canvas, loop = _open_canvas()
    from mua.player.session import Source
    from mua.player.viewer import Viewer

    try:
        Viewer(canvas, device, Source(tuple(files), motion, mapping), clip=clip)
        loop.run()
    finally:
        canvas.close()


def _open_canvas() -> tuple["BaseRenderCanvas", Any]:
    """A window and the loop that runs it; InputError where there is no display."""
    missing = "a window needs a display and there is none; -o writes a picture or a video instead"
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise InputError(missing)
    import glfw  # here: with rendercanvas below it starts GLFW

    with warnings.catch_warnings():
        warnings.simplefilter("error", glfw.GLFWError)
        try:
            glfw.init()
            from rendercanvas.glfw import RenderCanvas, loop

            return RenderCanvas(title="mua-view", size=SIZE, update_mode="ondemand", max_fps=120), loop
        except glfw.GLFWError as error:
            raise InputError(f"{missing} ({error})") from error
