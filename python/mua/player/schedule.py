"""Decides which part of which decode a displayed frame makes, so that none has to make all of it.

A display is faster than an avatar: the poses of a clip that come next are known, and are decoded part by part in the
displayed frames before they are due. Poses that nobody saw coming, the first or one that was sought, are decoded at
once. As unity-package/Runtime/DecodeSchedule.cs.
"""

from collections.abc import Callable

from mua.arrays import Array
from mua.gpu import Commands
from mua.player.frame import PARTS, AvatarFrame

Moment = tuple[str, int]  # clip and frame
Window = Callable[[Moment], tuple[Array, Array]]  # rotations [k, J, 4] and translations [k, J, 3], newest first


class DecodeSchedule:
    """The decode of an avatar that is shown, and the one made meanwhile."""

    def __init__(self, frame: AvatarFrame) -> None:
        self._frame = frame
        self._shown: tuple[Moment, int] | None = None  # clip and frame, and its level of detail
        self._coming: tuple[Moment, int] | None = None  # begun and not yet shown

    def record(self, commands: Commands, due: Moment, following: Moment, window: Window, *, level: int = 0) -> bool:
        """Append what one displayed frame decodes; whether other channels are shown than before.

        Where nothing is to be decoded ahead, `following` is `due`; else another level of detail comes with `following`.
        A frame that must complete what is due does no more.
        """
        ahead, wanted = following != due, (due, level)
        if ahead:
            wanted = next((made for made in (self._shown, self._coming) if made and made[0] == due), wanted)
        changed, taken = wanted != self._shown, 0
        if changed:
            taken = self._show(commands, wanted, window)
        if ahead and taken == 0:
            self._look_ahead(commands, (following, level), window)
        return changed

    def _show(self, commands: Commands, wanted: tuple[Moment, int], window: Window) -> int:
        """Show the decode that is due, and return how many parts that took."""
        taken = PARTS
        if wanted == self._coming:
            taken = self._frame.parts_left
            for _ in range(taken):
                self._frame.advance(commands)
            self._frame.show()
        else:
            due, level = wanted
            self._frame.decode_channels(commands, *window(due), level)
        self._shown, self._coming = wanted, None
        return taken

    def _look_ahead(self, commands: Commands, wanted: tuple[Moment, int], window: Window) -> None:
        if self._coming is None or self._coming[0] != wanted[0]:
            following, level = wanted
            self._frame.begin(*window(following), level)
            self._coming = wanted
        if self._frame.parts_left > 0:
            self._frame.advance(commands)
