"""What the training of all systems of a comparison begins with: their frames, their budget, where results are kept."""

from pathlib import Path

import torch

from mua.cli.display import Display
from mua.evaluation.settings import EvaluationSettings
from mua.recording import Recording
from mua.student.settings import Settings
from mua.training.checkpoint import Checkpoints, run_key
from mua.training.optimise import Progress, Run
from mua_research.motion import training_frames
from mua_research.system import Budget, Training


def prepare(
    evaluation: EvaluationSettings, recording: Recording, settings: Settings, work: Path, display: Display
) -> Training:
    """Train the coarse mesh that all systems share, or take it from the work directory."""
    budget = Budget(seconds=evaluation.seconds) if evaluation.steps is None else Budget(steps=evaluation.steps)
    checkpoints = Checkpoints(work, run_key((settings, recording.fingerprint(), budget.seconds, budget.steps), []))
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    generator = torch.Generator().manual_seed(settings.seed)

    def report(progress: Progress) -> None:
        display.step(progress.step, progress.steps, detail="" if progress.loss is None else f"loss {progress.loss:.4f}")

    display.stage("coarse mesh")
    frames = training_frames(recording, settings, run=Run(generator, checkpoints, report, device))
    return Training(frames, budget, checkpoints, report)
