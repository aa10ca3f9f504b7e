"""The contact sheet of a training shows motion that the student has not seen, where there is any."""

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from PIL import Image

from mua.baking import distillation


def shown(monkeypatch: pytest.MonkeyPatch, path: Path, *, seen: int, unseen: int) -> list[str]:
    """The frames on the sheet of a recording with this many whole frames."""
    found: list[str] = []

    def whole_frames(*, held_out: bool) -> Iterator[str]:
        return iter([f"{'unseen' if held_out else 'seen'} {i}" for i in range(unseen if held_out else seen)])

    def sheet(_: object, frames: Iterator[str], *, compared: object) -> Image.Image:
        found.extend(frames)
        return Image.new("RGB", (2, 2))

    monkeypatch.setattr(distillation, "contact_sheet", sheet)
    recording: Any = SimpleNamespace(whole_count=seen + unseen, whole_frames=whole_frames)
    avatar: Any = None
    distillation._picture(path, avatar, recording, ())
    return found


@pytest.mark.parametrize(
    ("seen", "unseen", "frames"),
    [
        (60, 12, [f"unseen {i}" for i in (1, 3, 5, 7, 9, 11)]),
        (60, 2, ["unseen 0", "unseen 1"]),
        (12, 0, [f"seen {i}" for i in (1, 3, 5, 7, 9, 11)]),
        (1, 0, ["seen 0"]),
    ],
)
def test_a_sheet_shows_held_out_frames_or_else_those_trained_on(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, seen: int, unseen: int, frames: list[str]
) -> None:
    assert shown(monkeypatch, tmp_path / "a.png", seen=seen, unseen=unseen) == frames
