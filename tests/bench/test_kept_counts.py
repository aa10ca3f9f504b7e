"""What an avatar of each preset costs, beside what it cost when somebody last looked.

Where a change means to move these figures, write them anew and say in its message why:

    mua-bench --preset tiny --counts --json tests/bench/counts/tiny.json

`paper_sizes.json` is of a file with `random_avatar` at the paper's own sizes.
"""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from mua.asset.write import write
from mua.bench.counts import as_json, count
from mua.bench.devices import DEVICES
from mua.bench.frame_model import ENDS, kernels_ms
from mua.bench.random_avatar import random_avatar
from mua.bench.work import DECODING, Work
from mua.gpu import Device
from mua.student.settings import PAPER_SIZES, PRESETS

AVATARS = {**PRESETS, "paper_sizes": replace(PRESETS["paper"], **vars(PAPER_SIZES))}
KEPT = Path(__file__).with_name("counts")
ROUNDED = 0.01  # of a count that depends on which splats a device finds in view


@pytest.mark.parametrize(
    "name", ["tiny", "preview", *(pytest.param(name, marks=pytest.mark.long) for name in ("paper", "paper_sizes"))]
)
def test_an_avatar_costs_what_it_did(device: Device, name: str, tmp_path: Path) -> None:
    kept = json.loads((KEPT / f"{name}.json").read_text())
    path = tmp_path / "random.muaavatar"
    write(path, random_avatar(AVATARS[name]))
    found = json.loads(json.dumps(as_json(count(device, path))))
    assert found.keys() == kept.keys()
    for field in ("file_bytes", "parameters", "splats", "parts", "dispatches", "face"):
        assert found[field] == kept[field]
    for field in ("bytes", "operations"):
        assert found[field]["decode"] == kept[field]["decode"]
        assert found[field] == pytest.approx(kept[field], rel=ROUNDED)
    for field in ("triangles", "fragments"):
        assert found[field] == pytest.approx(kept[field], rel=ROUNDED)
    assert found["kernels"].keys() == kept["kernels"].keys()
    for kernel, work in kept["kernels"].items():
        assert found["kernels"][kernel] == pytest.approx(work, rel=ROUNDED)
    for level, was in zip(found["levels"], kept["levels"], strict=True):
        assert level["bytes"] == pytest.approx(was["bytes"], rel=ROUNDED)
        assert (level["texels"], level["splats"]) == (was["texels"], was["splats"])


@pytest.mark.parametrize("end", ENDS)
def test_a_face_costs_a_quest_at_most_a_twentieth_of_a_decode_of_the_papers_size(end: str) -> None:
    """As large as that of a Ready Player Me figure; all of its expressions move."""
    kept, quest = json.loads((KEPT / "paper_sizes.json").read_text()), DEVICES["quest3"]
    face = Work(**kept["face"])
    decode = {kernel: Work(w["bytes"], w["operations"]) for kernel, w in kept["kernels"].items() if kernel in DECODING}
    assert face.bytes <= 0.05 * kept["bytes"]["decode"]
    assert kernels_ms(quest, {"face": face}, end) <= 0.05 * kernels_ms(quest, decode, end)
