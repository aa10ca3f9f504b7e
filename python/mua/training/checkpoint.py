"""Checkpoints of a training: one file per stage, replaced atomically, ignored if they belong to another run."""

import hashlib
import pickle
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from mua.files.write import remove_leftovers, replacing
from mua.training.processes import ALONE, Processes
from mua.version import __version__


@dataclass(frozen=True)
class Checkpoints:
    """The stages of one run in a directory; `key` identifies the run (see `run_key`)."""

    directory: Path
    key: str
    processes: Processes = ALONE  # the first one writes, reads and broadcasts

    def save(self, stage: str, state: dict[str, Any]) -> None:
        """Replace the checkpoint of `stage`; a kill at any moment leaves the old state or the new.

        Raises InputError where it cannot be written; the old state is kept then too.
        """
        if not self.processes.first:
            return
        with replacing(self._path(stage)) as temporary, temporary.open("wb") as file:
            try:
                torch.save({"key": self.key, "state": state}, file)
            except RuntimeError as error:  # torch's archive hides the system's error as its context
                if isinstance(error.__context__, OSError):
                    raise error.__context__ from None
                raise

    def load(self, stage: str) -> dict[str, Any] | None:
        """The checkpoint of `stage`; None where it is missing, damaged or of another run."""
        return self.processes.broadcast_object(self._read(stage) if self.processes.first else None)

    def _read(self, stage: str) -> dict[str, Any] | None:
        try:
            kept = torch.load(self._path(stage), map_location="cpu", weights_only=True)
        except (FileNotFoundError, RuntimeError, EOFError, pickle.UnpicklingError):
            return None
        if not isinstance(kept, dict) or kept.get("key") != self.key:
            return None
        return dict(kept["state"])

    def finished(self, stage: str) -> bool:
        """Whether the checkpoint of `stage` needs no further step."""
        kept = self.load(stage)
        return kept is not None and bool(kept.get("finished", True))

    def remove_leftovers(self, stages: Iterable[str]) -> None:
        """Remove half-written checkpoints of `stages` that killed runs left."""
        for stage in stages:
            remove_leftovers(self._path(stage))

    def _path(self, stage: str) -> Path:
        return self.directory / f"{stage}.pt"


def run_key(settings: object, tensors: Iterable[Tensor]) -> str:
    """A digest of everything that a run's result depends on: its settings, its training inputs and this version."""
    digest = hashlib.sha256(f"{__version__} {settings!r}".encode())
    for tensor in tensors:
        digest.update(tensor.detach().cpu().contiguous().numpy().tobytes())
    return digest.hexdigest()
