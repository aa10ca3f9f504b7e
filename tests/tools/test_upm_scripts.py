"""Every rule for C# sources finds its fault, and only that."""

from pathlib import Path

import pytest
from upm_files import Break, faults_after, put, replaced

FRAME = "Runtime/Frame.cs"

CASES: dict[str, tuple[Break, str]] = {
    "symbol nobody defines": (
        lambda root: replaced(root / FRAME, "&& MUA_INPUT", "&& !(MUA_INPUTS)"),
        f"{FRAME}: #if MUA_INPUTS: nothing defines it, expected a symbol of Unity or of versionDefines",
    ),
    "name of a type": (
        lambda root: replaced(root / FRAME, "class Frame", "class Frames"),
        f"{FRAME}: no type Frame, expected one of the file's name",
    ),
    "component beside another type": (
        lambda root: replaced(
            root / FRAME,
            "    public sealed",
            "    enum Kind { A }\n    class Walk : MonoBehaviour { }\n    public sealed",
        ),
        f"{FRAME}: type Walk: MonoBehaviour, which Unity looks for in Walk.cs",
    ),
    "no type": (
        lambda root: put(root / FRAME, "// namespace Mua { class Frame }\n"),
        f"{FRAME}: no type Frame, expected one of the file's name",
    ),
    "foreign namespace": (
        lambda root: replaced(root / FRAME, "namespace Mua.Frames", "namespace Frames"),
        f'{FRAME}: type Frame: namespace "Frames", expected Mua or below it',
    ),
    "module": (
        lambda root: replaced(
            root / FRAME, "private enum", "private Animator rig; // AudioSource\n        private enum"
        ),
        f"{FRAME}: Animator of com.unity.modules.animation, which is not in dependencies",
    ),
    "no assembly": (
        lambda root: put(root / "Tools/Walk.cs", "namespace Mua { interface Walk { } }"),
        "Tools/Walk.cs: in no assembly, expected an .asmdef in its folder or above",
    ),
}


@pytest.mark.parametrize(("change", "fault"), CASES.values(), ids=list(CASES))
def test_finds_one_fault(packages: list[Path], change: Break, fault: str) -> None:
    assert faults_after(packages, change, metas=True) == [f"com.mua.test/{fault}"]


def test_a_file_may_hold_a_small_type_beside_its_own(packages: list[Path]) -> None:
    assert (
        faults_after(
            packages, lambda root: replaced(root / FRAME, "    public sealed", "    enum Kind { A }\n    public sealed")
        )
        == []
    )
