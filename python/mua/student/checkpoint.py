"""Checkpoints of a distillation: one file per stage, replaced atomically, ignored where they belong to another run."""

import hashlib
import pickle
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from mua.files import replacing


@dataclass(frozen=True)
class Checkpoints:
    """The stages of one run in a directory; `key` says which run (see `run_key`)."""

    directory: Path
    key: str

    def save(self, stage: str, state: dict[str, Any]) -> None:
        """Replace what is kept of `stage`; a kill at any moment leaves the old state or the new."""
        with replacing(self._path(stage)) as temporary:
            torch.save({"key": self.key, "state": state}, temporary)

    def load(self, stage: str) -> dict[str, Any] | None:
        """What was kept of `stage`; None where there is nothing, or it is damaged or of another run."""
        try:
            kept = torch.load(self._path(stage), map_location="cpu", weights_only=True)
        except (FileNotFoundError, RuntimeError, EOFError, pickle.UnpicklingError):
            return None
        if not isinstance(kept, dict) or kept.get("key") != self.key:
            return None
        return dict(kept["state"])

    def _path(self, stage: str) -> Path:
        return self.directory / f"{stage}.pt"


def run_key(settings: object, tensors: Iterable[Tensor]) -> str:
    """A digest of everything that a run's result depends on: its settings and its training inputs."""
    digest = hashlib.sha256(repr(settings).encode())
    for tensor in tensors:
        digest.update(tensor.detach().cpu().contiguous().numpy().tobytes())
    return digest.hexdigest()
