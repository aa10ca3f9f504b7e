"""Reads tests/parity/golden as another runtime would: from its own description alone."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.gpu import Device, Kernel

FOLDER = Path(__file__).parent / "golden"
DTYPES = {"uint": "<u4", "float": "<f4", "half": "<f4"}


@dataclass(frozen=True)
class Golden:
    """One case and the binary that it points into."""

    kernel: str
    case: dict[str, Any]
    binary: bytes

    def __str__(self) -> str:
        return f"{self.case['entry']}: {self.case['name']}"

    def array(self, described: dict[str, Any], words: int, dtype: str) -> Array:
        return np.frombuffer(self.binary, dtype, words, described["offset"])


def read_golden() -> list[Golden]:
    """Every case of every kernel."""
    found = []
    for path in sorted(FOLDER.glob("*.json")):
        document, binary = json.loads(path.read_text()), path.with_suffix(".bin").read_bytes()
        found += [Golden(document["kernel"], case, binary) for case in document["cases"]]
    return found


def replay(device: Device, golden: Golden, kernel: Kernel | None = None) -> dict[str, Array]:
    """Dispatch a case, by another build of its kernel if one is given; the words of its writable buffers afterwards."""
    kernel = kernel or device.kernel(golden.kernel, golden.case["entry"])
    buffers = {}
    for described in golden.case["buffers"]:
        words = described["count"] * words_of(described["element"])
        buffers[described["name"]] = device.buffer(golden.array(described, words, "<u4"), name=described["name"])
    constants = {
        constant["name"]: np.array(constant["values"], DTYPES[constant["scalar"]]).reshape(constant["shape"])
        for constant in golden.case["constants"]
    }
    commands = device.commands()
    commands.dispatch(kernel, tuple(golden.case["groups"]), buffers, **constants)
    commands.submit()
    return {slot.name: buffers[slot.name].read() for slot in kernel.buffers if not slot.read_only}


def words_of(element: str) -> int:
    """Words of one element: 4 of a uint4, 1 of a float."""
    return int(element[-1]) if element[-1].isdigit() else 1


def values_of(described: dict[str, Any], words: Array) -> Array:
    """The values, float64, of the words of a buffer that an expectation is about."""
    count = described["count"] // (2 if described["kind"] == "half" else 1)
    turns = np.arange(count) // described["length"] * described["period"] + np.arange(count) % described["length"]
    chosen = np.ascontiguousarray(words[described["first"] + turns])
    return chosen.view({"uint": "<u4", "float": "<f4", "half": "<f2"}[described["kind"]]).astype(float)
