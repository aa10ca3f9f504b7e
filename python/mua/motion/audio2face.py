"""Faces that NVIDIA's Audio2Face exports as JSON: a row of weights for each frame, at a steady rate.

Its keys, as https://github.com/NVIDIA/Audio2Face-3D describes them: exportFps, facsNames and weightMat.
"""

import json
from pathlib import Path

import numpy as np

from mua.arguments import describe, finite_array
from mua.arrays import Array
from mua.errors import InputError
from mua.limits import LARGEST_RATE, LEAST_RATE

KEYS = RATE, NAMES, WEIGHTS = ("exportFps", "facsNames", "weightMat")


def read_audio2face(path: Path) -> tuple[float, tuple[str, ...], Array]:
    """The rate, the names of the expressions and their weights [F, S], held to 0 to 1.

    Errors: InputError that names the key where something else is written.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as JSON: {error}") from error
    for key in KEYS:
        if not isinstance(content, dict) or key not in content:
            raise InputError(f"{path}: holds no {key}; expected a face of Audio2Face with {', '.join(KEYS)}")
    names = content[NAMES]
    if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
        raise InputError(f"{path}: {NAMES} is {describe(names)}, expected a list of names")
    rate = float(finite_array(content[RATE], f"{path}: {RATE}", ()))
    if not LEAST_RATE <= rate <= LARGEST_RATE:
        raise InputError(f"{path}: {RATE} is {rate:g}, expected {LEAST_RATE:g} to {LARGEST_RATE:g} frames per second")
    weights = finite_array(content[WEIGHTS], f"{path}: {WEIGHTS}", (None, len(names)))
    if not len(weights):
        raise InputError(f"{path}: {WEIGHTS} holds no frame")
    return rate, tuple(names), np.clip(weights, 0, 1)
