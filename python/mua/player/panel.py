"""The controls of the window: what to show, how it plays, how long each kernel takes."""

from collections.abc import Callable
from dataclasses import fields

from imgui_bundle import imgui

from mua.player.session import Session
from mua.player.toggles import Toggles

WIDTH = 300  # logical pixels
ROWS = 8  # expressions that the list shows at once
SLOWEST, FASTEST = 0.1, 2.0  # factors of the clip's own speed
WARNING = imgui.ImVec4(1.0, 0.55, 0.4, 1.0)
VISIBLE = 0.01  # weight of an expression that is listed
SHOWN = {
    "splats": "Splats",
    "geometry": "Detailed geometry",
    "template": "Template mesh",
    "skeleton": "Skeleton",
    "shadow": "Shadow",
}
MOUSE = (("drag", "orbit"), ("right drag", "pan"), ("wheel", "zoom"))


def _toggle(name: str) -> Callable[[Session], None]:
    return lambda session: session.toggle(name)


def _flip(name: str) -> Callable[[Session], None]:
    return lambda session: setattr(session, name, not getattr(session, name))


def _reframe(session: Session) -> None:
    session.view = None


def _next_file(session: Session) -> None:
    session.choose_file(session.files[(session.files.index(session.file) + 1) % len(session.files)])


def _next_clip(session: Session) -> None:
    names = [clip.name for clip in session.clips]
    session.choose_clip(session.clips[(names.index(session.clip.name) + 1) % len(names)])


# Key by its rendercanvas name: its label, its description and its action.
KEYS: dict[str, tuple[str, str, Callable[[Session], None]]] = {
    " ": ("space", "play or pause", _flip("playing")),
    "ArrowLeft": ("left", "one frame back", lambda session: session.step(-1)),
    "ArrowRight": ("right", "one frame on", lambda session: session.step(1)),
    **{str(i + 1): (str(i + 1), SHOWN[f.name], _toggle(f.name)) for i, f in enumerate(fields(Toggles))},
    "a": ("a", "next avatar", _next_file),
    "c": ("c", "next clip", _next_clip),
    "s": ("s", "stereo", _flip("stereo")),
    "f": ("f", "follow", _flip("follow")),
    "l": ("l", "next level of detail", lambda session: session.next_level()),
    "r": ("r", "reset the view", _reframe),
    "t": ("t", "time the kernels", _flip("timed")),
}


def draw_panel(session: Session, *, rate: float) -> None:
    """Lay out all controls; `rate` is in frames per second."""
    imgui.set_next_window_pos((0, 0), imgui.Cond_.first_use_ever)
    imgui.set_next_window_size((WIDTH, 0), imgui.Cond_.always)
    imgui.begin("mua-view", None, imgui.WindowFlags_.no_resize)
    imgui.push_item_width(-70)
    _sources(session)
    _transport(session)
    _live(session)
    _face(session)
    _shown(session)
    _times(session, rate)
    _keys()
    imgui.pop_item_width()
    imgui.end()


def _sources(session: Session) -> None:
    files, names = session.files, [clip.name for clip in session.clips]
    changed, chosen = imgui.combo("avatar", files.index(session.file), [file.stem for file in files])
    if changed:
        session.choose_file(files[chosen])
    changed, chosen = imgui.combo("clip", names.index(session.clip.name), names)
    if changed:
        session.choose_clip(session.clips[chosen])
    imgui.text_disabled(f"{session.splats:,} splats, {session.level}")
    imgui.text_disabled(f"outside of training: {session.outside:.0%}")
    for sentence in filter(None, (session.failure, *session.notes)):
        imgui.push_style_color(imgui.Col_.text, WARNING)
        imgui.text_wrapped(sentence)
        imgui.pop_style_color()


def _transport(session: Session) -> None:
    imgui.separator()
    if imgui.button("pause" if session.playing else "play", (60, 0)):
        session.playing = not session.playing
    for label, frames in (("<", -1), (">", 1)):
        imgui.same_line()
        if imgui.button(label):
            session.step(frames)
    last = len(session.clip) - 1
    changed, index = imgui.slider_int("frame", session.index, 0, last)
    if changed:
        session.step(min(max(index, 0), last) - session.index)
    _, session.speed = imgui.slider_float("speed", session.speed, SLOWEST, FASTEST, "%.2f x")


def _live(session: Session) -> None:
    """What comes from another program, where that is shown."""
    if session.receiver is None or session.live is None:
        return
    imgui.separator()
    imgui.text_disabled(f"listens on {session.receiver.address}")
    imgui.text_wrapped(session.receiver.figures)
    for name, weight in session.live.now.expressions.items():
        if weight >= VISIBLE:
            imgui.progress_bar(weight, (0, 0), name)


def _face(session: Session) -> None:
    """A slider for each expression, in a list that scrolls and can be searched."""
    held = session.expressions
    if not held or not imgui.collapsing_header(f"Expressions ({len(held)})"):
        return
    _, session.search = imgui.input_text("search", session.search)
    found = [name for name in held if session.search.lower() in name.lower()]
    height = min(len(found), ROWS) * imgui.get_frame_height_with_spacing()
    imgui.begin_child("expressions", (0, height))
    for name in found:
        imgui.set_next_item_width(WIDTH / 2.5)
        changed, weight = imgui.slider_float(name, held[name], 0.0, 1.0, "%.2f", imgui.SliderFlags_.always_clamp)
        if changed:
            session.weights[name] = weight
    imgui.end_child()
    if imgui.button("as the clip has them"):
        session.weights.clear()


def _shown(session: Session) -> None:
    imgui.separator()
    for name, label in SHOWN.items():
        changed, _ = imgui.checkbox(label, getattr(session.toggles, name))
        if changed:
            session.toggle(name)
    imgui.separator()
    _, session.stereo = imgui.checkbox("Stereo, side by side", session.stereo)
    _, session.follow = imgui.checkbox("Follow the figure", session.follow)
    if imgui.button("reset the view"):
        session.view = None


def _times(session: Session, rate: float) -> None:
    imgui.separator()
    imgui.text(f"{rate:.1f} frames per second")
    _, session.timed = imgui.checkbox("Time the kernels", session.timed)
    if not session.timed:
        return
    if not session.can_time:
        imgui.text_disabled("this device has no timestamps")
        return
    flags = imgui.TableFlags_.row_bg
    if imgui.begin_table("times", 2, flags):
        total = sum(session.milliseconds.values())
        for name, spent in [*session.milliseconds.items(), ("all kernels", total)]:
            imgui.table_next_column()
            imgui.text(name)
            imgui.table_next_column()
            imgui.text(f"{spent:8.3f} ms")
        imgui.end_table()


def _keys() -> None:
    if imgui.collapsing_header("Mouse and keys"):
        for key, does in (*MOUSE, *((key, does) for key, does, _ in KEYS.values())):
            imgui.text(f"{key:10} {does}")
