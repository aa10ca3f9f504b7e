"""Draws every entry and the teacher, frame by frame, and scores the images."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from mua.arrays import Array
from mua.evaluation.entries import Entry, sentence
from mua.evaluation.images import Studio
from mua.evaluation.metrics import Scores, compare, mean
from mua.recording import Recording, WholeFrame
from mua.splatting.perceptual import Lpips

DARKEST = 1 / 255  # of what counts as the figure
KINDS = {"training": False, "held out": True}


@dataclass(frozen=True)
class Sample:
    """The scores of one image."""

    clip: str
    frame: int  # of the clip
    held_out: bool
    view: int
    covered: float  # share of the image that the teacher's figure covers
    scores: Scores


@dataclass
class Result:
    """What one entry has come to; its failure ends it, what was scored before stays."""

    entry: Entry
    samples: list[Sample] = field(default_factory=list)
    failure: str = ""

    def of(self, held_out: bool) -> Scores:
        """The mean over images of a kind, nan over none."""
        return mean([sample.scores for sample in self.samples if sample.held_out == held_out])


def choose_frames(recording: Recording, most: int | None) -> list[WholeFrame]:
    """The frames that the recording keeps whole, training frames first; at most so many of a kind, evenly."""
    chosen: list[WholeFrame] = []
    for held_out in KINDS.values():
        frames = list(recording.whole_frames(held_out=held_out))
        wanted = len(frames) if most is None else min(most, len(frames))
        chosen += [frames[i] for i in ((np.arange(wanted) + 0.5) * len(frames) / max(wanted, 1)).astype(int)]
    return chosen


def score(
    studio: Studio,
    frames: Sequence[WholeFrame],
    entries: Sequence[Entry],
    *,
    lpips: Lpips | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> list[Result]:
    """Results in the order of the entries."""
    results = [Result(entry, failure=entry.failure) for entry in entries]
    for done, frame in enumerate(frames, start=1):
        truth = studio.draw(frame, frame.texture)
        for result in results:
            if not result.failure:
                _judge_frame(result, studio, frame, truth, lpips)
        progress(done, len(frames))
    return results


def _judge_frame(
    result: Result, studio: Studio, frame: WholeFrame, truth: Sequence[Array], lpips: Lpips | None
) -> None:
    assert result.entry.picture is not None  # it would have a failure
    try:
        shown = result.entry.picture(frame)
        pictures = studio.draw(frame, shown.texture, mesh=shown.mesh)
    except Exception as error:  # whatever one entry stumbles over, the others go on
        result.failure = sentence(error)
        return
    for view, (picture, teacher) in enumerate(zip(pictures, truth, strict=True)):
        scores, _ = compare(picture, teacher, lpips=lpips)
        covered = float((teacher.max(axis=2) > DARKEST).mean())
        result.samples.append(Sample(frame.clip.name, frame.index, frame.clip.held_out, view, covered, scores))
