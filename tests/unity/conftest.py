"""Fixtures of the Unity package's tests."""

import shutil

import pytest
from csharp import CSharp


@pytest.fixture(scope="session")
def csharp() -> CSharp:
    """mcs and mono."""
    for tool, package in (("mcs", "mono-mcs"), ("mono", "mono-runtime")):
        if shutil.which(tool) is None:
            pytest.skip(f"needs {tool}: Debian's package {package}, which tools/setup.sh installs, runs this test")
    return CSharp()
