"""A real character in motion: its clothes lie on it, and follow it."""

import re

import pytest
from measure_sag import main
from shared_data import SharedData

NEAR = 5.0  # mm; before what hangs was told apart, its coat hung 27 mm off


def test_tight_clothes_and_skin_stay_where_skinning_has_them(
    shared_data: SharedData, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = (shared_data.path(name) for name in ("characters/lumberjack.glb", "motion/jumping.bvh"))
    character, motion = (str(path) for path in paths)
    main([character, "--motion", motion])
    farthest = dict(re.findall(r"lumberjack, (\w+): .*, ([\d.]+) mm", capsys.readouterr().out))
    assert {"head", "arms", "body", "legs"} <= farthest.keys()
    assert all(0 < float(mm) < NEAR for mm in farthest.values())
