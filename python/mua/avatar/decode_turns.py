"""Which part of which decode a displayed frame makes, so that its time does not grow with the number of avatars.

An avatar that is alone in view shows in time what is due: a clip's next pose is known, and decoded before. Several take
turns: a displayed frame decodes a few parts of one avatar after the other, and poses all of them. In a round each that
waits has one decode. First come those never decoded, then those that have waited LONGEST, then the largest on screen
whose pose changed most.

unity-package/Runtime/DecodeSchedule.cs and web/schedule.js decide alike; tests hold all to it.
"""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field, replace

PARTS = 4  # parts of a decode, which take about as long each
ALONE = 2  # parts in a displayed frame of an avatar that is alone in view: half of a decode
LONGEST = 18  # displayed frames, a quarter of a second at 72 Hz

Moment = Hashable  # the newest pose of a window, with its weights of expressions: a clip and its frame, or a number
Key = int  # tells avatars apart


@dataclass(frozen=True)
class Decode:
    """A decode of one avatar."""

    moment: Moment
    level: int = 0  # level of detail


@dataclass(frozen=True)
class Ask:
    """An avatar in view in a displayed frame."""

    due: Moment
    following: Moment  # to be decoded before it is due; `due` where none is foreseen
    level: int = 0
    rank: float = 0.0  # pixels of its height, times the radians by which its pose changed since the last decode
    spread: bool = True  # whether its decode may be spread over displayed frames
    may_lag: bool = False  # whether what is due may be shown a little later, where it is alone


@dataclass(frozen=True)
class State:
    """The decodes of an avatar."""

    shown: Decode | None = None
    coming: Decode | None = None  # begun, and not shown
    left: int = 0  # parts missing from it
    since: int = 0  # displayed frame in which it began to wait
    served: bool = False  # in this round


@dataclass(frozen=True)
class Turns:
    """The decodes of all avatars."""

    avatars: Mapping[Key, State] = field(default_factory=dict)
    holder: Key | None = None  # whose decode is being made


@dataclass(frozen=True)
class Steps:
    """What a displayed frame does for an avatar, in this order."""

    whole: Decode | None = None  # decode all of it at once, and show it
    finish: int = 0  # parts to complete before what was begun is shown
    show: bool = False  # show what was begun
    begin: Decode | None = None  # begin, in place of what was begun before
    parts: int = 0  # parts to make of what was begun


def take_turns(
    turns: Turns,
    asks: Mapping[Key, Ask],  # avatars in view, in an order that stays
    frame: int,  # number of the displayed frame
    *,
    parts: int = 1,  # parts in this frame where several avatars take turns
    alone: bool | None = None,  # whether no other avatar is in view; None: where there is only one
) -> tuple[Turns, dict[Key, Steps]]:
    """The steps of one displayed frame, and the decodes after it.

    Of n avatars that move, each is decoded anew after max(LONGEST, n * PARTS / parts) displayed frames or sooner, and
    two decodes more. An avatar that rests, or is not in `asks`, takes none.
    """
    alone = len(asks) == 1 if alone is None else alone
    states, steps, taken = dict(turns.avatars), dict.fromkeys(asks, Steps()), 0
    for key, ask in asks.items():
        state = states.get(key, State(since=frame))
        state = state if _waits(ask, state) else replace(state, since=frame)
        show = _show_due if alone or not ask.spread else _show_whole
        states[key], steps[key], spent = show(ask, state)
        taken += spent
    if alone:
        for key, ask in asks.items() if taken == 0 else ():  # a frame that must complete what is due does no more
            states[key], steps[key] = _look_ahead(ask, states[key], steps[key])
        return Turns(states), steps
    return _serve(Turns(states, turns.holder), asks, steps, frame, parts)


def _waits(ask: Ask, state: State) -> bool:
    """Whether another decode is wanted than the one shown, and is not complete either."""
    complete = state.coming is not None and state.left == 0 and state.coming.moment == ask.following
    return state.shown != Decode(ask.following, ask.level) and not complete


def _show_due(ask: Ask, state: State) -> tuple[State, Steps, int]:
    """Shows what is due whatever that takes; how many parts it took."""
    wanted = Decode(ask.due, ask.level)
    made = [decode for decode in (state.shown, state.coming) if decode is not None]
    if ask.spread and ask.may_lag and state.shown is not None:
        wanted = made[-1]
    elif ask.spread and ask.following != ask.due:  # another level comes with the next decode
        wanted = next((decode for decode in made if decode.moment == ask.due), wanted)
    if wanted == state.shown:
        return state, Steps(), 0
    shown = replace(state, shown=wanted, coming=None, left=0)
    if wanted == state.coming:
        return shown, Steps(finish=state.left, show=True), state.left
    return shown, Steps(whole=wanted), PARTS


def _show_whole(ask: Ask, state: State) -> tuple[State, Steps, int]:
    """Shows what is complete, unless it is still to come or what is due is shown already."""
    if state.coming is None or state.left > 0:
        return state, Steps(), 0
    late = state.coming.moment != ask.following and (state.shown is None or state.shown.moment != ask.due)
    if state.coming.moment != ask.due and not late:
        return state, Steps(), 0
    return replace(state, shown=state.coming, coming=None), Steps(show=True), 0


def _look_ahead(ask: Ask, state: State, steps: Steps) -> tuple[State, Steps]:
    following = Decode(ask.following if ask.spread else ask.due, ask.level)
    if not ask.spread or following == state.shown:
        return state, steps
    if state.coming is None or state.coming.moment != ask.following:
        state, steps = _begin(following, state, steps)
    return _make(min(ALONE, state.left), state, steps)


def _serve(
    turns: Turns, asks: Mapping[Key, Ask], steps: dict[Key, Steps], frame: int, parts: int
) -> tuple[Turns, dict[Key, Steps]]:
    """Makes parts of one avatar's decode after the other's; none has two in one frame."""
    states, holder, others = dict(turns.avatars), turns.holder, dict(asks)
    while parts > 0:
        if holder not in others or not asks[holder].spread or states[holder].left == 0:
            holder = _next_holder(others, states, frame)
            if holder is None:
                break
            ask, state = asks[holder], replace(states[holder], served=True, since=frame)
            if state.coming is None or state.left == 0 or state.coming.moment != ask.following:
                state, steps[holder] = _begin(Decode(ask.following, ask.level), state, steps[holder])
            states[holder] = state
        made = min(parts, states[holder].left)
        states[holder], steps[holder] = _make(made, states[holder], steps[holder])
        parts -= made
        if states[holder].left == 0:
            del others[holder]
    return Turns(states, holder), steps


def _next_holder(asks: Mapping[Key, Ask], states: dict[Key, State], frame: int) -> Key | None:
    """The avatar whose turn it is, in this round or, once all that wait were served, in the next."""
    waiting = [key for key, ask in asks.items() if ask.spread and _waits(ask, states[key])]
    if waiting and all(states[key].served for key in waiting):
        for key in states:
            states[key] = replace(states[key], served=False)
    left = [key for key in waiting if not states[key].served]
    return max(left, key=lambda key: _urgency(asks[key], states[key], frame), default=None)


def _urgency(ask: Ask, state: State, frame: int) -> tuple[bool, int, float]:
    waited = frame - state.since
    return state.shown is None, waited if waited >= LONGEST else 0, ask.rank


def _begin(decode: Decode, state: State, steps: Steps) -> tuple[State, Steps]:
    return replace(state, coming=decode, left=PARTS), replace(steps, begin=decode)


def _make(parts: int, state: State, steps: Steps) -> tuple[State, Steps]:
    return replace(state, left=state.left - parts), replace(steps, parts=steps.parts + parts)
