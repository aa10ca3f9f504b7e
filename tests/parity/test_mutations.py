"""The parity tests can fail: every fault of mutations.py, put into a copy of the shaders, is caught."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import mutate
import pytest
from fault import Fault
from mutations import FAULTS

from mua import kernels
from mua.gpu import sources

SECONDS = 1200  # a command that hangs; shaders alone take a minute on idle cores


def test_every_kernel_has_faults() -> None:
    references = {path.stem for path in Path(kernels.__file__).parent.glob("*.py")} - {"__init__"}
    assert set(FAULTS) == references


@pytest.mark.parametrize("kernel", FAULTS)
def test_faults_of_a_kernel_have_names_of_their_own(kernel: str) -> None:
    assert len({fault.breaks for fault in FAULTS[kernel]}) == len(FAULTS[kernel])


@pytest.mark.parametrize(
    ("kernel", "fault"), [pytest.param(k, f, id=f"{k}: {f.breaks}") for k, faults in FAULTS.items() for f in faults]
)
def test_fault_is_not_stale(kernel: str, fault: Fault) -> None:
    assert mutate.path_of(fault, kernel).read_text().count(fault.original) == 1


@pytest.mark.parametrize("kernel", FAULTS)
@pytest.mark.long
def test_every_fault_fails_the_parity_test(kernel: str, tmp_path: Path) -> None:
    copy = shutil.copytree(sources.directory(), tmp_path / "shaders")
    environment = {**os.environ, "MUA_SHADERS": str(copy)}
    command = [sys.executable, mutate.__file__, kernel]
    ran = subprocess.run(command, capture_output=True, text=True, check=True, timeout=SECONDS, env=environment)
    found = json.loads(ran.stdout)
    assert found.pop(mutate.UNMUTATED) == mutate.PASSED
    assert {breaks: outcome for breaks, outcome in found.items() if outcome != mutate.CAUGHT} == {}
