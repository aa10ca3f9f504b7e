"""Every rule for assembly definitions finds its fault, and only that."""

from pathlib import Path
from typing import Any

import pytest
import upm_assemblies
from upm_files import ASSEMBLY, edited, faults_after, put

ASMDEF = "Runtime/Mua.Test.asmdef"
EDITOR = "Editor/Mua.Test.Editor.asmdef"
VIEWER = "Samples~/Viewer/Mua.Viewer.asmdef"
RULES = ASSEMBLY["versionDefines"]
RULE = {"name": "com.unity.render-pipelines.universal", "expression": "17.0", "define": "MUA_URP"}
PLATFORMS = ", ".join(sorted(upm_assemblies.PLATFORMS))


def with_rule(**changes: str) -> dict[str, Any]:
    """A field with one more rule of a version, of which some parts may be others."""
    return {"versionDefines": [*RULES, {**RULE, **changes}]}


# The assembly definition, its fields that change, and the one fault that they make.
CASES: list[tuple[str, dict[str, Any], str]] = [
    (VIEWER, {"name": "Mua.Walk"}, 'name: "Mua.Walk", expected the name of the file'),
    (ASMDEF, {"rootNamespace": "Muana"}, 'rootNamespace: "Muana", expected Mua or below it'),
    (ASMDEF, {"reference": []}, "reference: a field that Unity does not know"),
    (ASMDEF, {"includePlatforms": ["Quest"]}, f'includePlatforms: "Quest", expected one of {PLATFORMS}'),
    (EDITOR, {"includePlatforms": []}, 'includePlatforms: [], expected ["Editor"] for what lies below Editor/'),
    (
        ASMDEF,
        {"includePlatforms": ["Editor"]},
        'includePlatforms: ["Editor"], expected no editor only, outside Editor/',
    ),
    (
        ASMDEF,
        {"references": ["Mua.Gone"]},
        'references: "Mua.Gone" is no assembly of these packages, '
        "nor one of Unity's that tools/upm_assemblies.py lists",
    ),
    (
        ASMDEF,
        {"references": ["Unity.XR.OpenXR"]},
        'references: "Unity.XR.OpenXR" of com.unity.xr.openxr, which is neither in dependencies nor in versionDefines',
    ),
    (
        EDITOR,
        {"defineConstraints": []},
        'references: "UnityEngine.TestRunner", expected "UNITY_INCLUDE_TESTS" in defineConstraints',
    ),
    (
        ASMDEF,
        {"references": [], "versionDefines": [*RULES, {"name": "x"}]},
        'versionDefines[1]: {"name": "x"}, expected name, expression and define',
    ),
    (ASMDEF, with_rule(name="URP"), 'versionDefines[1].name: "URP", expected a package'),
    (
        ASMDEF,
        with_rule(expression=">=17"),
        'versionDefines[1].expression: ">=17", expected a version or a range like [1.0,2.0)',
    ),
    (ASMDEF, with_rule(define="MUA-URP"), 'versionDefines[1].define: "MUA-URP", expected a symbol'),
    (
        ASMDEF,
        {"defineConstraints": ["!MUA_INPUT || MUA_GONE"]},
        'defineConstraints: "!MUA_INPUT || MUA_GONE", expected symbols of Unity or of versionDefines',
    ),
]


@pytest.mark.parametrize(("name", "changes", "fault"), CASES, ids=[fault[:30] for _, _, fault in CASES])
def test_finds_one_fault(packages: list[Path], name: str, changes: dict[str, Any], fault: str) -> None:
    found = faults_after(packages, lambda root: edited(root / name, **changes), metas=True)
    assert found == [f"com.mua.test/{name}: {fault}"]


@pytest.mark.parametrize(
    ("name", "text", "fault"),
    [
        ("Samples~/Viewer/Mua.Broken.asmdef", "{", "expected a JSON object"),
        (
            "Tests/Mua.Viewer.asmdef",
            '{"name": "Mua.Viewer", "rootNamespace": "Mua"}',
            f'name: "Mua.Viewer" is also that of com.mua.test/{VIEWER}',
        ),
    ],
)
def test_finds_a_definition_that_cannot_be(packages: list[Path], name: str, text: str, fault: str) -> None:
    found = faults_after(packages, lambda root: put(root / name, text), metas=True)
    assert found == [f"com.mua.test/{name}: {fault}"]


@pytest.mark.parametrize(
    "expression", ["", "17.0", "1.8.1-pre.2", "[1.0]", "[1.0,2.0)", "(1.0,2.0.1]", "[1.0,)", "(,2.0)"]
)
def test_takes_what_unity_takes_as_a_version(packages: list[Path], expression: str) -> None:
    assert faults_after(packages, lambda root: edited(root / ASMDEF, **with_rule(expression=expression))) == []
