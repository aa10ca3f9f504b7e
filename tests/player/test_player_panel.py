"""The panel of the interactive player: what it says, and what its boxes, sliders and buttons do."""

import time
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from driven_window import COLOR, EMPTY, LOOK, SIZE, Driven
from imgui_bundle import imgui
from rendercanvas.offscreen import RenderCanvas
from vmc_senders import Program, bundle

from mua.gpu import Device
from mua.live.live_pose import EASING
from mua.live.receiver import Address, Receiver
from mua.live.vmc import QUIET
from mua.player.panel import WIDTH
from mua.player.played_files import Source
from mua.player.toggles import Toggles
from mua.player.viewer import Viewer


def test_draws_panel_and_figure_over_the_background(window: Driven) -> None:
    image = window.picture()
    assert image.shape == (SIZE[1], SIZE[0], 3)
    np.testing.assert_array_equal(np.unique(image[EMPTY].reshape(-1, 3), axis=0), [COLOR])
    assert (image[:40, :WIDTH] != COLOR).any(axis=2).mean() > 0.9
    assert (image[:, WIDTH:] != COLOR).any(axis=2).sum() > 100


def test_the_panel_says_of_how_many_splats_the_figure_is(window: Driven, monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    monkeypatch.setattr("mua.player.panel.imgui.text_disabled", said.append)
    window.picture()
    assert f"{window.session.splats:,} splats, {window.session.level}" in said
    assert f"outside of training: {window.session.outside:.0%}" in said


def test_the_panel_says_what_comes_from_another_program(
    device: Device, avatar_files: tuple[Path, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    said: list[str] = []
    bars: dict[str, float] = {}
    canvas = RenderCanvas(size=SIZE)
    with Receiver(Address(0)) as receiver, Program(receiver) as program:
        source = Source(avatar_files, receiver=receiver, mapping={"root": "Hips", "tip": "Head"})
        viewer = Viewer(canvas, device, source, LOOK)
        monkeypatch.setattr("mua.player.panel.imgui.text_wrapped", said.append)
        monkeypatch.setattr("mua.player.panel.imgui.progress_bar", lambda weight, _, name: bars.update({name: weight}))
        viewer.session.playing = False
        program.send(bundle(("/VMC/Ext/Blend/Val", "Joy", 0.5), ("/VMC/Ext/Blend/Val", "Sorrow", 0.0)), b"nonsense")
        frame = receiver.newest(time.monotonic() + QUIET)
        assert frame is not None
        assert viewer.session.live is not None
        for later in (0.0, 1.5 * EASING):
            viewer.session.live.advance(frame.time + later)
        canvas.draw()
        assert bars["Joy"] == pytest.approx(0.5)
        assert "Sorrow" not in bars
        assert any("1 packets are no OSC and were dropped" in sentence for sentence in said)
    canvas.close()


def test_keeps_the_view_while_the_mouse_is_on_the_panel(window: Driven) -> None:
    before = window.session.view
    window.drag((100, 8), (100, 8), button=1)
    window.send({"event_type": "wheel", "dx": 0, "dy": 300, "x": 100, "y": 60, "buttons": (), "modifiers": ()})
    assert window.session.view is before


def test_shows_and_hides_by_the_boxes_of_the_panel(window: Driven) -> None:
    changed: set[str] = set()
    for y in range(140, 300, 5):  # wherever the boxes lie: down the column in which they stand
        before = window.session.toggles
        window.click(16, y)
        after = window.session.toggles
        changed |= {
            field.name for field in fields(Toggles) if getattr(before, field.name) != getattr(after, field.name)
        }
    assert changed == {field.name for field in fields(Toggles)}


def test_sliders_move_the_face_until_the_clip_does(
    device: Device, avatar_files: tuple[Path, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(imgui, "collapsing_header", lambda label: label.startswith("Expressions"))
    window = Driven(device, avatar_files[1:2])
    moved: set[str] = set()
    ended = False
    before = window.picture()[:, WIDTH + 20 :]
    for y in range(140, 324, 8):  # wherever the sliders lie, and the button below them
        window.click(90, y)
        if window.session.weights:
            shown = window.session.expressions
            assert all(0 <= weight <= 1 for weight in shown.values())
            moved |= {name for name, weight in shown.items() if weight > 0}
        ended |= bool(moved) and not window.session.weights
        if moved == {"jawOpen"}:
            assert (window.picture()[:, WIDTH + 20 :] != before).any()
    assert moved == {"jawOpen", "eyeBlinkLeft", "nothing", "Mund auf"}
    assert ended
    window.canvas.close()


def test_the_list_of_expressions_is_narrowed_by_a_search(
    device: Device, avatar_files: tuple[Path, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    listed: list[str] = []
    slider = imgui.slider_float

    def noting(label: str, *given: Any) -> Any:
        listed.append(label)
        return slider(label, *given)

    monkeypatch.setattr(imgui, "collapsing_header", lambda label: label.startswith("Expressions"))
    monkeypatch.setattr(imgui, "slider_float", noting)
    window = Driven(device, avatar_files[1:2])
    for search, found in (("", 4), ("EYE", 1), ("a", 2)):
        window.session.search = search
        listed.clear()
        window.picture()
        assert len(set(listed) - {"speed"}) == found
    window.canvas.close()


def test_the_buttons_of_the_panel_go_a_frame_back_and_on(window: Driven, monkeypatch: pytest.MonkeyPatch) -> None:
    for label, frames in (("<", -1), (">", 1)):
        window.session.step(3 - window.session.index)
        with monkeypatch.context() as pressed:
            pressed.setattr("mua.player.panel.imgui.button", lambda name, *_, label=label: name == label)
            window.picture()
        assert window.session.index == 3 + frames
