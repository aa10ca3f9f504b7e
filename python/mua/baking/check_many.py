"""Many characters checked in one go: what was found of each, worst first."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from mua.baking.check import as_dict, check
from mua.baking.listener import Listener, Nobody
from mua.baking.settings import BakeSettings
from mua.characters.formats import require_scene
from mua.errors import InputError

REFUSED, LOOK, GOOD = "refused", "look", "good"  # worst first
VERDICTS = (REFUSED, LOOK, GOOD)


@dataclass(frozen=True)
class Checked:
    """A character, its figures, and what is wrong with it."""

    path: Path
    verdict: str
    sentences: tuple[str, ...] = ()  # the refusal, or what looks wrong
    iou: float | None = None  # None where splats and source were not compared
    psnr: float | None = None  # decibels
    figures: dict[str, Any] | None = None  # all of them; None where refused


def check_many(settings: BakeSettings, characters: Sequence[Path], listener: Listener) -> list[Checked]:
    """Check every character as `check` does, worst first; a refused one does not end it.

    The pictures lie beside the output under the names of the files.
    """
    listener.stage("characters")
    found = []
    for done, path in enumerate(characters):
        listener.step(done, len(characters), detail=path.name)
        found.append(_checked(replace(settings, character=path, output=settings.output.with_name(f"{path.name}.x"))))
    listener.step(len(characters), len(characters))
    return sorted(found, key=_badness)


def _checked(settings: BakeSettings) -> Checked:
    path = settings.character or Path()
    try:
        require_scene(path)
        found = check(settings, Nobody())
    except InputError as error:
        return Checked(path, REFUSED, (str(error).removeprefix(f"{path}: "),))
    fidelity = found.fidelity
    return Checked(
        path=path,
        verdict=LOOK if found.warnings else GOOD,
        sentences=found.warnings,
        iou=None if fidelity is None else fidelity.iou,
        psnr=None if fidelity is None else fidelity.psnr,
        figures=as_dict(settings, found),
    )


def _badness(one: Checked) -> tuple[int, int, float]:
    return VERDICTS.index(one.verdict), -len(one.sentences), one.iou or 0.0
