"""What the inspector describes is kept in scenes: asked of the compiled assemblies."""

import sys
from pathlib import Path

from csharp import PROGRAMS, CSharp

sys.path.append(str(Path(__file__).parent))

from package_compiler import Compiler, assemblies


def test_every_field_with_a_tooltip_is_kept_in_the_scene(csharp: CSharp) -> None:
    """A private field without SerializeField is neither shown nor saved, and its tooltip is lost without a word."""
    compiler = Compiler(csharp, "editor", packages=True)
    built = [compiler.built(name) for name, assembly in assemblies().items() if compiler.has(assembly)]
    program = csharp.build([PROGRAMS / "InspectorProgram.cs"], references=[compiler.built("UnityEngine")])
    told = [line.split("\t") for line in csharp.run(program, *built).splitlines()]
    assert ["kept", "AvatarRenderer.spreadDecode"] in told
    assert [field for state, field in told if state == "lost"] == []
