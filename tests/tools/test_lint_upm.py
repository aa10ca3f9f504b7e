"""The linter finds each fault of a Unity package, and only that; `make check` runs it over those of this checkout."""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gen_meta
import lint_upm
import pytest

MANIFEST = {
    "name": "com.mua.test",
    "version": "0.1.0",
    "displayName": "Test",
    "description": "A package that keeps every rule.",
    "unity": "6000.0",
    "license": "Apache-2.0",
    "dependencies": {"com.mua.other": "0.2.0", "com.unity.modules.xr": "1.0.0"},
    "samples": [{"displayName": "Viewer", "description": "A sample.", "path": "Samples~/Viewer"}],
}
OTHER = {**MANIFEST, "name": "com.mua.other", "version": "0.2.0", "dependencies": {}, "samples": []}
ASSEMBLY = {
    "name": "Mua.Test",
    "references": ["Unity.InputSystem"],
    "versionDefines": [{"name": "com.unity.inputsystem", "expression": "1.8", "define": "MUA_INPUT"}],
}
SOURCE = """#define OWN
#if UNITY_6000_0_OR_NEWER && MUA_INPUT && OWN
class Frame : MonoBehaviour { string quoted = "Animator"; } // AudioSource
#endif
"""
SHADER = '#include "UnityCG.cginc"\n#include "Packages/com.mua.other/kernel.hlsl"\n#include "beside.hlsl"\n'
KERNEL_GUID, SCRIPT_GUID = (
    gen_meta.guid("com.mua.other", "kernel.compute"),
    gen_meta.guid("com.mua.test", "Runtime/Frame.cs"),
)
YAML = f"""  m_Script: {{fileID: 11500000, guid: {SCRIPT_GUID}, type: 3}}
  kernel: {{fileID: 7200000, guid: {KERNEL_GUID}, type: 3}}
  cube: {{fileID: 10202, guid: 0000000000000000e000000000000000, type: 0}}
"""
FILES = {
    "test/package.json": json.dumps(MANIFEST),
    "test/README.md": "# Test\n",
    "test/LICENSE.md": "Apache-2.0\n",
    "test/CHANGELOG.md": "## 0.1.0, unreleased\n",
    "test/Runtime/Mua.Test.asmdef": json.dumps(ASSEMBLY),
    "test/Runtime/Frame.cs": SOURCE,
    "test/Runtime/Frame.shader": SHADER,
    "test/Runtime/Frame.asset": YAML,
    "test/Runtime/beside.hlsl": "",
    "test/Samples~/Viewer/Walk.cs": "class Walk { }\n",
    "test/Samples~/Viewer/Mua.Viewer.asmdef": "{}",
    "other/package.json": json.dumps(OTHER),
    "other/README.md": "# Other\n",
    "other/kernel.compute": '#include "kernel.hlsl"\n',
    "other/kernel.hlsl": "",
}


def put(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


@pytest.fixture
def packages(tmp_path: Path) -> list[Path]:
    """Two small packages that keep every rule."""
    for name, text in FILES.items():
        put(tmp_path / name, text)
    folders = [tmp_path / "test", tmp_path / "other"]
    for folder in folders:
        gen_meta.write(folder)
    return folders


Break = Callable[[Path], object]


def replaced(name: str, old: str, new: str) -> Break:
    def change(root: Path) -> None:
        text = (root / name).read_text()
        assert old in text
        (root / name).write_text(text.replace(old, new))

    return change


def edited(**fields: Any) -> Break:
    """Fields of the manifest that are others."""
    return lambda root: put(root / "package.json", json.dumps({**MANIFEST, **fields}))


def written(name: str, text: str = "") -> Break:
    return lambda root: put(root / name, text)


CASES: dict[str, Break] = {
    f"{'x' * 141}.txt: 145 characters, expected at most 140": written(f"{'x' * 141}.txt"),
    "Größe.txt: name 'Gr\\xf6\\xdfe.txt', expected letters": written("Größe.txt"),
    "aux.txt: name 'aux.txt', expected letters": written("aux.txt"),
    "readme.md: differs from another path in case only": written("readme.md"),
    "link.txt: a link": lambda root: (root / "link.txt").symlink_to(root / "README.md"),
    f'Runtime/Frame.asset: guid "{"0" * 32}" is of no file here': replaced(
        "Runtime/Frame.asset", KERNEL_GUID, "0" * 32
    ),
    "Runtime/Frame.asset: fileID 4800000, expected 7200000 for kernel.compute": replaced(
        "Runtime/Frame.asset", "7200000", "4800000"
    ),
    'Runtime/Frame.shader: include "gone.hlsl", expected a file': replaced("Runtime/Frame.shader", "beside", "gone"),
    'Runtime/Frame.shader: include "Packages/com.mua.other/kernel.hlsl", expected the package in dependencies': edited(
        dependencies={"com.unity.modules.xr": "1.0.0"}
    ),
    "package.json: displayName: not there": edited(displayName=None),
    'package.json: com.mua.other: "0.1.0", expected "0.2.0"': edited(dependencies={"com.mua.other": "0.1.0"}),
    "package.json: org.else: expected only packages of Unity's own registry": edited(
        dependencies={"com.mua.other": "0.2.0", "org.else": "1.0.0"}
    ),
    "package.json: com.unity.modules.vr: gone from Unity 6000.5": edited(
        dependencies={"com.mua.other": "0.2.0", "com.unity.modules.vr": "1.0.0"}
    ),
    "package.json: Samples~/Viewer: listed or there, expected both": edited(samples=[]),
    "LICENSE.md: not there, expected a page": lambda root: (root / "LICENSE.md").unlink(),
    'CHANGELOG.md: no heading "## 0.1.0"': written("CHANGELOG.md", "## 0.0.9\n"),
    "Runtime: references Unity.InputSystem of com.unity.inputsystem, in no dependencies": replaced(
        "Runtime/Mua.Test.asmdef", "com.unity.inputsystem", "com.unity.timeline"
    ),
    "Runtime/Frame.cs: #if MUA_INPUTS: nothing defines it": replaced("Runtime/Frame.cs", "MUA_INPUT", "!(MUA_INPUTS)"),
    "Runtime/Frame.cs: Animator of com.unity.modules.animation": replaced("Runtime/Frame.cs", '"Animator"', "Animator"),
    "Runtime/Frame.cs: type Frames: MonoBehaviour, which Unity looks for in Frames.cs": replaced(
        "Runtime/Frame.cs", "Frame ", "Frames "
    ),
    "Tools/Walk.cs: in no assembly": written("Tools/Walk.cs"),
}


@pytest.mark.parametrize(("fault", "change"), CASES.items(), ids=[fault[-40:] for fault in CASES])
def test_finds_the_fault(packages: list[Path], fault: str, change: Break) -> None:
    change(packages[0])
    assert any(line.startswith(f"com.mua.test/{fault}") for line in lint_upm.faults(packages))


def test_prints_a_line_for_each_fault_and_none_where_there_is_none(packages: list[Path]) -> None:
    command = [sys.executable, lint_upm.__file__, *map(str, packages)]
    assert subprocess.run(command, check=True, capture_output=True).stderr == b""
    (packages[0] / "README.md").unlink()
    (packages[0] / "LICENSE.md").unlink()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.splitlines() == [
        f"com.mua.test/{page}: not there, expected a page beside package.json" for page in ("LICENSE.md", "README.md")
    ]
