"""Every rule for assembly definitions finds its fault, and only that."""

from pathlib import Path

import pytest
import upm_assemblies
import upm_files
from upm_files import ASSEMBLY, Break, edited, faults_after, put

ASMDEF = "Runtime/Mua.Test.asmdef"
RULES = ASSEMBLY["versionDefines"]
IN_EDITOR = '["Editor"] for what lies below Editor/'

CASES: dict[str, tuple[Break, str]] = {
    "no JSON": (
        lambda root: put(root / "Samples~/Viewer/Mua.Broken.asmdef", "{"),
        "Samples~/Viewer/Mua.Broken.asmdef: expected a JSON object",
    ),
    "name of an assembly": (
        lambda root: edited(root / "Samples~/Viewer/Mua.Viewer.asmdef", name="Mua.Walk"),
        'Samples~/Viewer/Mua.Viewer.asmdef: name: "Mua.Walk", expected the name of the file',
    ),
    "name taken": (
        lambda root: put(root / "Tests/Mua.Viewer.asmdef", '{"name": "Mua.Viewer", "rootNamespace": "Mua"}'),
        'Tests/Mua.Viewer.asmdef: name: "Mua.Viewer" is also that of com.mua.test/Samples~/Viewer/Mua.Viewer.asmdef',
    ),
    "namespace of an assembly": (
        lambda root: edited(root / ASMDEF, rootNamespace="Muana"),
        f'{ASMDEF}: rootNamespace: "Muana", expected Mua or below it',
    ),
    "field of an assembly": (
        lambda root: edited(root / ASMDEF, reference=[]),
        f"{ASMDEF}: reference: a field that Unity does not know",
    ),
    "platform": (
        lambda root: edited(root / ASMDEF, includePlatforms=["Quest"]),
        f'{ASMDEF}: includePlatforms: "Quest", expected one of {", ".join(sorted(upm_assemblies.PLATFORMS))}',
    ),
    "editor code in players": (
        lambda root: edited(root / "Editor/Mua.Test.Editor.asmdef", includePlatforms=[]),
        f"Editor/Mua.Test.Editor.asmdef: includePlatforms: [], expected {IN_EDITOR}",
    ),
    "player code in the editor": (
        lambda root: edited(root / ASMDEF, includePlatforms=["Editor"]),
        f'{ASMDEF}: includePlatforms: ["Editor"], expected no editor only, outside Editor/',
    ),
    "library": (
        lambda root: edited(root / ASMDEF, precompiledReferences=["nunit.framework.dll"]),
        f'{ASMDEF}: precompiledReferences: "nunit.framework.dll", expected nunit.framework.dll, and overrideReferences',
    ),
    "reference of an assembly": (
        lambda root: edited(root / ASMDEF, references=["Mua.Gone"]),
        f'{ASMDEF}: references: "Mua.Gone" is no assembly of these packages, '
        "nor one of Unity's that tools/upm_assemblies.py lists",
    ),
    "package not asked for": (
        lambda root: edited(root / ASMDEF, references=["Unity.XR.OpenXR"]),
        f'{ASMDEF}: references: "Unity.XR.OpenXR" of com.unity.xr.openxr, '
        "which is neither in dependencies nor in versionDefines",
    ),
    "tests in players": (
        lambda root: edited(root / "Editor/Mua.Test.Editor.asmdef", defineConstraints=[]),
        'Editor/Mua.Test.Editor.asmdef: references: "UnityEngine.TestRunner", '
        'expected "UNITY_INCLUDE_TESTS" in defineConstraints',
    ),
    "rule of a version": (
        lambda root: edited(root / ASMDEF, references=[], versionDefines=[*RULES, {"name": "x"}]),
        f'{ASMDEF}: versionDefines[1]: {{"name": "x"}}, expected name, expression and define',
    ),
    "package of a version": (
        lambda root: version(root, name="URP"),
        f'{ASMDEF}: versionDefines[1].name: "URP", expected a package',
    ),
    "expression": (
        lambda root: version(root, expression=">=17"),
        f'{ASMDEF}: versionDefines[1].expression: ">=17", expected a version or a range like [1.0,2.0)',
    ),
    "symbol of a version": (
        lambda root: version(root, define="MUA-URP"),
        f'{ASMDEF}: versionDefines[1].define: "MUA-URP", expected a symbol',
    ),
    "constraint": (
        lambda root: edited(root / ASMDEF, defineConstraints=["!MUA_INPUT || MUA_GONE"]),
        f'{ASMDEF}: defineConstraints: "!MUA_INPUT || MUA_GONE", expected symbols of Unity or of versionDefines',
    ),
}


def version(root: Path, **changes: str) -> None:
    """Add a rule of a version that is wrong in one field."""
    rule = {"name": "com.unity.render-pipelines.universal", "expression": "17.0", "define": "MUA_URP", **changes}
    edited(root / ASMDEF, versionDefines=[*RULES, rule])


@pytest.fixture
def packages(tmp_path: Path) -> list[Path]:
    return upm_files.write(tmp_path)


@pytest.mark.parametrize(("change", "fault"), CASES.values(), ids=list(CASES))
def test_finds_one_fault(packages: list[Path], change: Break, fault: str) -> None:
    assert faults_after(packages, change, metas=True) == [f"com.mua.test/{fault}"]


def test_finds_assemblies_that_refer_to_each_other(packages: list[Path]) -> None:
    third = '{"name": "Mua.Third", "rootNamespace": "Mua", "references": ["Mua.Test"]}'
    put(packages[0] / "Third/Mua.Third.asmdef", third)
    found = faults_after(packages, lambda root: edited(root / ASMDEF, references=["Mua.Third"]), metas=True)
    assert found == [
        "com.mua.test/Runtime/Mua.Test.asmdef: references: lead back to Mua.Test",
        "com.mua.test/Third/Mua.Third.asmdef: references: lead back to Mua.Third",
    ]


def test_finds_two_assemblies_in_a_folder(packages: list[Path]) -> None:
    definition = '{"name": "Mua.Second", "rootNamespace": "Mua"}'
    found = faults_after(packages, lambda root: put(root / "Runtime/Mua.Second.asmdef", definition), metas=True)
    assert found == [
        f"com.mua.test/Runtime/{name}.asmdef: not the only assembly definition of its folder"
        for name in ("Mua.Second", "Mua.Test")
    ]


@pytest.mark.parametrize(
    "expression", ["", "17.0", "1.8.1-pre.2", "[1.0]", "[1.0,2.0)", "(1.0,2.0.1]", "[1.0,)", "(,2.0)"]
)
def test_takes_what_unity_takes_as_a_version(packages: list[Path], expression: str) -> None:
    assert faults_after(packages, lambda root: version(root, expression=expression)) == []
