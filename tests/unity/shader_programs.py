"""The HLSL programs of the package's .shader files, as text that a compiler takes with Unity's include replaced."""

import re
from dataclasses import dataclass
from pathlib import Path

from csharp import RUNTIME

SHADERS = sorted(RUNTIME.rglob("*.shader"))
SAMPLES = sorted((RUNTIME.parent / "Samples~").rglob("*.shader"))
STAND_IN = Path(__file__).parent / "stand_ins" / "shader"
ENGINE = frozenset(  # what a program is given by Unity, or in its place by a test
    {"glstate_matrix_projection", "unity_StereoMatrixP", "unity_MatrixVP", "unity_StereoEyeIndex"}
    | {"replayed_layer", "replayed_view"}
)
KERNELS_PACKAGE = "Packages/com.mua.kernels/"  # whose files the compilers find by their names
HALVES = tuple(f"half{count} min16float{count}" for count in ("", 2, 3, 4))  # as Unity says it for mobile devices
VARIANTS = {
    "mono": (),
    "instanced": ("STEREO_INSTANCING_ON",),
    "multiview": ("STEREO_MULTIVIEW_ON",),
    "mobile": ("STEREO_MULTIVIEW_ON", *HALVES),
}

COMMENT = re.compile(r"//[^\n]*")
NAME = re.compile(r'^Shader\s+"([^"]+)"', re.MULTILINE)
SHARED = re.compile(r"\bHLSLINCLUDE\b(.*?)\bENDHLSL\b", re.DOTALL)
PASS = re.compile(r'\bPass\s*\{\s*Name\s+"(\w+)"(.*?)\bHLSLPROGRAM\b(.*?)\bENDHLSL\b', re.DOTALL)
STATE = re.compile(r"^\s*(Blend|ZTest|ZWrite|Cull|ColorMask)\s+([\w ]+?)\s*$", re.MULTILINE)
STAGE = re.compile(r"#pragma\s+(vertex|fragment)\s+(\w+)")
PRAGMA = re.compile(r"^\s*#pragma\b.*\n", re.MULTILINE)


@dataclass(frozen=True)
class Program:
    """One pass of a .shader file."""

    shader: str
    name: str  # the pass's name
    index: int  # among the passes, from 0
    state: dict[str, str]  # fixed-function settings by their words
    text: str  # HLSL, with what the passes share before it
    vertex: str
    fragment: str

    def __str__(self) -> str:
        return f"{self.shader.split('/')[-1]} {self.name}"

    def write(self, folder: Path, *defines: str, stand_in: bool = True) -> Path:
        """The program as a file in a folder, with what it includes beside it and with definitions before it."""
        for source in (*RUNTIME.joinpath("Shaders").glob("*.hlsl"), *(STAND_IN.iterdir() if stand_in else ())):
            folder.joinpath(source.name).write_text(source.read_text().replace(KERNELS_PACKAGE, ""))
        path = folder / f"{self.name}.hlsl"
        path.write_text("".join(f"#define {define}\n" for define in defines) + self.text)
        return path


def programs(path: Path) -> list[Program]:
    """The passes of a .shader file; each has a name, and is written in HLSL."""
    text = COMMENT.sub("", path.read_text())
    name, shared = NAME.search(text), "".join(SHARED.findall(text))
    assert name is not None, f"{path.name} names no shader"
    common = dict(STATE.findall(re.split(r"\bHLSLINCLUDE\b|\bPass\b", text)[0]))
    found = []
    for index, (title, state, own) in enumerate(PASS.findall(text)):
        stages = dict(STAGE.findall(shared + own))
        code = PRAGMA.sub("", shared + own).replace(KERNELS_PACKAGE, "")
        settings = common | dict(STATE.findall(state))
        found.append(Program(name[1], title, index, settings, code, stages["vertex"], stages["fragment"]))
    count = len(re.findall(r"\bHLSLPROGRAM\b", text))
    assert len(found) == count, f"{path.name}: {len(found)} of {count} passes begin with a Name"
    return found
