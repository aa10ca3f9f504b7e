"""Two small UPM packages that keep every rule, for tests that break one."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gen_meta
import lint_upm

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
OTHER = {
    "name": "com.mua.other",
    "version": "0.2.0",
    "displayName": "Other",
    "description": "Kernels.",
    "unity": "6000.0",
}
ASSEMBLY = {
    "name": "Mua.Test",
    "rootNamespace": "Mua",
    "references": ["Unity.InputSystem"],
    "versionDefines": [{"name": "com.unity.inputsystem", "expression": "[1.8,2.0)", "define": "MUA_INPUT"}],
}
EDITOR = {
    "name": "Mua.Test.Editor",
    "rootNamespace": "Mua.Editor",
    "references": ["Mua.Test", "UnityEngine.TestRunner"],
    "includePlatforms": ["Editor"],
    "defineConstraints": ["UNITY_INCLUDE_TESTS"],
}
SOURCE = """using System; // class Comment
#if UNITY_6000_0_OR_NEWER && MUA_INPUT
namespace Mua.Frames
{
    public sealed class Frame<T> where T : struct
    {
        private enum Inner { A, B }
        private const string Text = "class Quoted {";
        public delegate void Told(int x);
    }
}
#endif
"""
SHADER = '#include "UnityCG.cginc"\n#include "Packages/com.mua.other/kernel.hlsl"\n#include "beside.hlsl"\n'
KERNEL_GUID = gen_meta.guid("com.mua.other", "kernel.compute")
ASSET = f"""%YAML 1.1
MonoBehaviour:
  m_Script: {{fileID: 11500000, guid: {gen_meta.guid("com.mua.test", "Runtime/Frame.cs")}, type: 3}}
  kernel: {{fileID: 7200000, guid: {KERNEL_GUID}, type: 3}}
  cube: {{fileID: 10202, guid: 0000000000000000e000000000000000, type: 0}}
"""
FILES = {
    "test/package.json": json.dumps(MANIFEST),
    "test/README.md": "# Test\n",
    "test/LICENSE.md": "Apache-2.0\n",
    "test/CHANGELOG.md": "## 0.1.0, unreleased\n",
    "test/Runtime/Mua.Test.asmdef": json.dumps(ASSEMBLY),
    "test/Runtime/AssemblyInfo.cs": "[assembly: Mua.Known]\n",
    "test/Runtime/Frame.cs": SOURCE,
    "test/Runtime/Frame.shader": SHADER,
    "test/Runtime/beside.hlsl": "",
    "test/Runtime/Resources/Frame.asset": ASSET,
    "test/Editor/Mua.Test.Editor.asmdef": json.dumps(EDITOR),
    "test/Editor/Menus.cs": "namespace Mua { namespace Editor { class Menus { } } }\n",
    "test/Samples~/Viewer/Mua.Viewer.asmdef": '{"name": "Mua.Viewer", "rootNamespace": "Mua.Viewer"}',
    "test/Samples~/Viewer/Walk.cs": "namespace Mua.Viewer\n{\n    internal delegate T Walk<T>(T x);\n}\n",
    "test/Documentation~/com.mua.test.md": "# Test\n",
    "other/package.json": json.dumps({**OTHER, "license": "Apache-2.0"}),
    "other/README.md": "# Other\n",
    "other/kernel.compute": '#include "kernel.hlsl"\n',
    "other/kernel.hlsl": "",
}


def write(folder: Path) -> list[Path]:
    """The two packages below a folder, with their .meta files."""
    for name, text in FILES.items():
        put(folder / name, text)
    folders = [folder / "test", folder / "other"]
    for package in folders:
        gen_meta.write(package)
    return folders


def put(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def edited(path: Path, **changes: Any) -> None:
    """Set fields of a JSON file; None takes one away."""
    fields = {**json.loads(path.read_text()), **changes}
    path.write_text(json.dumps({key: value for key, value in fields.items() if value is not None}))


def replaced(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


Break = Callable[[Path], object]


def faults_after(packages: list[Path], change: Break, *, metas: bool = False) -> list[str]:
    """What is found in the first package once it was changed, its .meta files written again or not."""
    change(packages[0])
    if metas:
        gen_meta.write(packages[0])
    return lint_upm.faults(packages)
