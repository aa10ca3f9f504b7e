"""Write tests/parity/golden from the cases beside it; --check says whether it is up to date.

The format is on the page tests/parity/golden/README.md.
"""

import json
import sys
from pathlib import Path
from typing import Any

import checkout  # noqa: F401
import generated
import numpy as np
import shader_source

ROOT = Path(__file__).resolve().parents[1]
KERNELS = ROOT / "ComputeShaders"
GOLDEN = ROOT / "tests" / "parity" / "golden"
sys.path += [str(ROOT / "tests" / name) for name in ("parity", "fixtures", "")]

import golden_decoding  # noqa: E402 their folder is known only now
import golden_sorting  # noqa: E402
from golden_case import Case, Expected  # noqa: E402

from mua.arrays import Array  # noqa: E402

CASES = {
    "mlp_matmul": golden_decoding.mlp_matmul_cases,
    "blend_subbands": golden_decoding.blend_subbands_cases,
    "inverse_dwt": golden_decoding.inverse_dwt_cases,
    "dq_skinning": golden_decoding.dq_skinning_cases,
    "expressions": golden_decoding.expressions_cases,
    "splat_project": golden_sorting.splat_project_cases,
    "splat_sort": golden_sorting.splat_sort_cases,
}


class Blob:
    """Bytes in which equal arrays are kept once."""

    def __init__(self) -> None:
        self.content = b""
        self._offsets: dict[bytes, int] = {}

    def place(self, array: Array) -> int:
        """The offset at which an array's bytes begin."""
        data = np.ascontiguousarray(array).tobytes()
        if data not in self._offsets:
            self._offsets[data] = len(self.content)
            self.content += data
        return self._offsets[data]


def document(stem: str, listed: list[Case]) -> tuple[str, bytes]:
    """The JSON text and the binary of one kernel's cases."""
    declared = shader_source.read(KERNELS / f"{stem}.compute", KERNELS).buffers
    blob = Blob()
    found = [
        {
            "name": case.name,
            "entry": case.entry,
            "groups": list(case.groups),
            "constants": [_constant(name, value) for name, value in case.constants.items()],
            "buffers": [_buffer(name, declared[name].element, array, blob) for name, array in case.buffers.items()],
            "expected": [_expected(expected, blob) for expected in case.expected],
        }
        for case in listed
    ]
    return _text({"kernel": f"{stem}.compute", "cases": found}) + "\n", blob.content


def _text(value: Any, margin: str = "\n") -> str:
    """JSON with a line for each record that holds no other."""
    inner = list(value.values()) if isinstance(value, dict) else value
    if not isinstance(inner, list) or not any(isinstance(one, dict | list) and "{" in json.dumps(one) for one in inner):
        return json.dumps(value, allow_nan=False)
    deeper = margin + " "
    keys = [f"{json.dumps(key)}: " for key in value] if isinstance(value, dict) else [""] * len(inner)
    rows = [key + _text(one, deeper) for key, one in zip(keys, inner, strict=True)]
    first, last = "{}" if isinstance(value, dict) else "[]"
    return first + deeper + f",{deeper}".join(rows) + margin + last


def generate() -> dict[Path, bytes]:
    """Path and content of every golden file."""
    found: dict[Path, bytes] = {}
    for stem, cases in CASES.items():
        text, content = document(stem, cases())
        found |= {GOLDEN / f"{stem}.json": text.encode(), GOLDEN / f"{stem}.bin": content}
    return found


def _constant(name: str, value: Any) -> dict[str, Any]:
    array = np.asarray(value)
    scalar = "float" if array.dtype.kind == "f" else "uint"
    return {"name": name, "scalar": scalar, "shape": list(array.shape), "values": array.ravel().tolist()}


def _buffer(name: str, element: str, array: Array, blob: Blob) -> dict[str, Any]:
    width = int(element[-1]) if element[-1].isdigit() else 1
    words = np.ascontiguousarray(array, array.dtype.newbyteorder("<")).view("<u4")
    return {"name": name, "element": element, "count": words.size // width, "offset": blob.place(words)}


def _expected(expected: Expected, blob: Blob) -> dict[str, Any]:
    values = np.asarray(expected.values, "<u4" if expected.kind == "uint" else "<f4")
    return {
        "buffer": expected.buffer,
        "kind": expected.kind,
        "first": expected.first,
        "length": expected.length,
        "period": expected.period,
        "count": values.size,
        "offset": blob.place(values),
        "absolute": _rounded_up(expected.absolute),
        "relative": _rounded_up(expected.relative),
    }


def _rounded_up(bound: float) -> float:
    """Three digits, so that the text does not depend on a machine's last bit."""
    return float(f"{1.005 * bound:.2e}")


if __name__ == "__main__":
    generated.run("gen_golden.py", __doc__, generate())
