"""The decode that an avatar shows and the one made meanwhile, a part in each displayed frame.

`mua.avatar.decode_turns` says which part of which; the desktop player draws one avatar at a time. As
unity-package/Runtime/AvatarInstance.cs.
"""

from collections.abc import Callable

from mua.arrays import Array
from mua.avatar.decode_turns import Ask, Turns, take_turns
from mua.gpu import Commands
from mua.player.frame import AvatarFrame

Moment = tuple[str, int, tuple[tuple[str, float], ...]]  # clip, frame, expressions that are set and their weights
# Rotations [k, J, 4] and translations [k, J, 3], newest first, and weights of expressions [E]; None: all 0.
Window = Callable[[Moment], tuple[Array, Array, Array | None]]


class DecodeSchedule:
    """Makes the decodes of an avatar that is alone in view."""

    def __init__(self, frame: AvatarFrame) -> None:
        self._frame, self._turns, self._displayed = frame, Turns(), 0

    def record(self, commands: Commands, due: Moment, following: Moment, window: Window, *, level: int = 0) -> bool:
        """Append what one displayed frame decodes; whether other channels are shown than before.

        Where nothing is to be decoded ahead, `following` is `due`; else another level of detail comes with `following`.
        """
        self._displayed += 1
        self._turns, steps = take_turns(self._turns, {0: Ask(due, following, level)}, self._displayed)
        step = steps[0]
        if step.whole is not None:
            self._frame.decode_channels(commands, *window(due), level=step.whole.level)
        if step.show:
            self._advance(commands, step.finish)
            self._frame.show()
        if step.begin is not None:
            self._frame.begin(*window(following), level=step.begin.level)
        self._advance(commands, step.parts)
        return step.show or step.whole is not None

    def _advance(self, commands: Commands, parts: int) -> None:
        for _ in range(parts):
            self._frame.advance(commands)
