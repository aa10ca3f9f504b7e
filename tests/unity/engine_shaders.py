"""Programs as Unity itself compiles them: by FXC with the engine's own include files, then by its translator HLSLcc.

None of the three is part of the project; tools/README.md says where they come from.
"""

import os
import re
import shlex
import subprocess
from dataclasses import dataclass
from pathlib import Path

import shader_compilers
from shader_compilers import Compiler
from shader_programs import Program

from mua.gpu import glslang

NEEDS = "$MUA_FXC, $MUA_CGINCLUDES and $MUA_HLSLCC (tools/README.md)"
STAGE_WORDS = {"vert": "SHADER_STAGE_VERTEX", "frag": "SHADER_STAGE_FRAGMENT"}
COMMON = ("SHADER_TARGET=45", "UNITY_VERSION=60000000", "UNITY_ENABLE_CBUFFER=1")
VULKAN = ("SHADER_API_VULKAN=1", "SHADER_API_MOBILE=1")  # as on a headset
STEREO = {"mono": (), "instanced": ("STEREO_INSTANCING_ON=1",), "multiview": ("STEREO_MULTIVIEW_ON=1",)}
GAMMA = ("UNITY_COLORSPACE_GAMMA=1",)
DEVICES = {
    ("SHADER_API_D3D11=1",): ("mono", "instanced"),
    VULKAN: ("mono", "instanced", "multiview"),
    ("SHADER_API_METAL=1",): ("mono",),
}
VARIANTS = [  # what a project of either colour space may ask for
    (*device, *STEREO[stereo], *space)
    for device, all_stereo in DEVICES.items()
    for stereo in all_stereo
    for space in ((), GAMMA)
]
# bits that were a float's become a word of parts, or a word made of parts becomes a float's
WORD_AS_FLOAT = re.compile(
    r"^.*(?:\bfloatBitsToU?[iI]nt\([\w.]+\) (?:>>|<<|&)|\bu?intBitsToFloat\(u_xlat[\w.]+ [*+]).*$", re.M
)


@dataclass(frozen=True)
class Engine:
    """The compiler, the engine's CGIncludes and the command that translates a file of bytecode into one of GLSL."""

    fxc: Compiler
    includes: Path
    hlslcc: list[str]

    def write(self, program: Program, folder: Path) -> Path:
        """The program as a file. UnityCG.cginc names the target's semantic otherwise, but heeds capital letters."""
        path = program.write(folder, stand_in=False)
        path.write_text(path.read_text().replace("SV_Target", "SV_TARGET"))
        return path

    def bytecode(self, path: Path, entry: str, stage: str, defines: tuple[str, ...]) -> tuple[Path, list[str]]:
        """What FXC makes of an entry point, and its messages."""
        output = path.with_suffix(f".{entry}.dxbc")
        output.unlink(missing_ok=True)
        command = self.fxc.command(path, entry, stage, output)
        words = [*COMMON, *defines, *([STAGE_WORDS[stage]] if stage in STAGE_WORDS else [])]
        options = ["-Gec", f"-I{self.includes}", *glslang.shared_options(words)]  # globals of the engine are halves
        done = subprocess.run([*command, *options], cwd=path.parent, capture_output=True, text=True, check=False)
        return output, [line for line in (done.stdout + done.stderr).splitlines() if re.search(r"\bX\d{4}\b", line)]

    def glsl(self, path: Path, entry: str, stage: str, defines: tuple[str, ...]) -> str:
        """An entry point as Unity hands it to the compiler of SPIR-V."""
        compiled, printed = self.bytecode(path, entry, stage, defines)
        assert compiled.is_file(), printed
        output = compiled.with_suffix(f".{stage}")
        subprocess.run([*self.hlslcc, str(compiled), str(output)], check=True)
        return output.read_text()


def find() -> Engine | None:
    """What the environment names; None where any of it is absent."""
    fxc = shader_compilers.find("fxc")
    includes, hlslcc = (os.environ.get(name) for name in ("MUA_CGINCLUDES", "MUA_HLSLCC"))
    if fxc is None or includes is None or hlslcc is None:
        return None
    return Engine(fxc, Path(includes).resolve(), shlex.split(hlslcc))


def words_as_floats(glsl: str) -> list[str]:
    """Lines by which a word that is no number has been, or becomes, a float."""
    return [line.strip() for line in WORD_AS_FLOAT.findall(glsl)]
