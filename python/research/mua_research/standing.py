"""How a system stands among those that cost at most as much: who is nearest to the images, and how surely."""

import math
from collections.abc import Sequence

import numpy as np

from mua.evaluation.capture_scores import SPLITS, FilmedEntry, Judged, Standing, mean_of
from mua.evaluation.settings import OURS


def standings(judged: Sequence[Judged], entries: Sequence[FilmedEntry]) -> list[Standing]:
    """Of ours at scale 1 in each split; nothing where it or a rival is missing."""
    own = next((one for one in entries if one.system == OURS and one.scale == 1), None)
    if own is None:
        return []
    rivals = [one for one in entries if one.system not in ("", OURS) and one.cost.within(own.cost)]
    found = (best(judged, [one.name for one in rivals], split) for split in SPLITS)
    return [_standing(judged, own.name, rival, split) for rival, split in zip(found, SPLITS, strict=True) if rival]


def best(judged: Sequence[Judged], names: Sequence[str], split: str) -> str | None:
    """Whose mean PSNR is highest in a split; None where there is nobody or no view."""
    psnr = {name: mean_of(judged, name, split).psnr for name in names}
    scored = {name: value for name, value in psnr.items() if not math.isnan(value)}
    return max(scored, key=scored.__getitem__) if scored else None


def sentences(found: Sequence[Standing]) -> list[str]:
    """Of each split whether ours is first."""
    shown = []
    for one in found:
        place = "is first" if one.difference > 0 else "is NOT first"
        how = f"{one.difference:+.2f} dB, nearer in {one.ahead} of {one.views} images"
        shown.append(f"{one.split}: among systems that cost at most as much, {OURS} {place}: {how}, than {one.rival}.")
    return shown


def _standing(judged: Sequence[Judged], own: str, rival: str, split: str) -> Standing:
    pairs = [(one.scores[own].psnr, one.scores[rival].psnr) for one in judged if one.shot.split == split]
    differences = np.array([mine - other for mine, other in pairs])
    return Standing(split, rival, float(differences.mean()), int((differences > 0).sum()), len(differences))
