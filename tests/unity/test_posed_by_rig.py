"""The sample PosedByRig: an avatar takes the place of a rigged character."""

from csharp import PROGRAMS, CSharp
from package_compiler import Compiler, assemblies


def test_an_avatar_takes_a_rigs_place_and_gives_it_back(csharp: CSharp) -> None:
    compiler = Compiler(csharp, "pc", packages=False)
    references = [compiler.built(name) for name in ("UnityEngine", "Mua.Format", "Mua.Motion", "Mua.Avatar")]
    sources = [*assemblies()["Mua.Samples.PosedByRig"].sources(), PROGRAMS / "PosedByRigProgram.cs"]
    printed = csharp.run(csharp.build(sources, name="PosedByRigProgram", references=references))
    assert dict(line.split("\t") for line in printed.splitlines()) == dict.fromkeys(
        ("posed", "hidden", "head", "follows", "released", "quiet"), "True"
    )
