"""A C# compiler and a runtime for the tests of the Unity package, which need no Unity."""

import hashlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RUNTIME = ROOT / "unity-package" / "Runtime"
PROGRAMS = Path(__file__).parent / "programs"
STAND_INS = Path(__file__).parent / "stand_ins"
OPTIONS = ("-langversion:7.2", "-warn:4", "-warnaserror", "-optimize+", "-nologo")  # what every Unity 6 understands


class CSharp:
    """Compiles with mcs, runs with mono; what is compiled once is kept by its content under the system's tmp folder."""

    def __init__(self) -> None:
        self._cache = Path(tempfile.gettempdir()) / f"mua-csharp-{os.getuid()}"

    def build(
        self,
        sources: Sequence[Path],  # files, or folders of which all .cs files are meant
        *,
        library: bool = False,
        name: str = "",  # the assembly's; the last source's where there is none
        references: Sequence[Path] = (),
        defines: Sequence[str] = (),
        translated: bool = False,  # to machine code, once: for what runs many times
    ) -> Path:
        """The .exe or .dll of `sources`; a warning is an error, and fails the test with the compiler's words."""
        files = sorted(f for source in sources for f in ([source] if source.is_file() else source.rglob("*.cs")))
        options = [*OPTIONS, *(f"-define:{name}" for name in defines), *(f"-reference:{path}" for path in references)]
        folder = self._cache / _digest([*files, *references], [*options, *["--aot"] * translated])
        built = folder / f"{name or sources[-1].stem}.{'dll' if library else 'exe'}"
        if built.exists():
            return built
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder) as scratch:
            target = Path(scratch) / built.name
            kind = "library" if library else "exe"
            command = ["mcs", *options, f"-target:{kind}", f"-out:{target}", *map(str, files)]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            assert done.returncode == 0, done.stdout + done.stderr
            if translated:  # where the system has what mono needs for that
                subprocess.run(["mono", "--aot", str(target)], capture_output=True, check=False)
            for reference in references:  # mono looks for them beside the program, maybe that of another test run
                for file in (_code_of(reference), reference):
                    if file.exists():
                        copy = Path(shutil.copy(file, scratch))
                        copy.replace(folder / copy.name)
            if _code_of(target).exists():
                _code_of(target).replace(_code_of(built))
            target.replace(built)
        return built

    def engine(self) -> Path:
        """The stand-ins of the engine."""
        return self.build([STAND_INS / "UnityEngine"], library=True, name="UnityEngine", translated=True)

    def timeline(self) -> Path:
        """The stand-ins of com.unity.timeline."""
        return self.build(
            [STAND_INS / "Unity.Timeline"], library=True, name="Unity.Timeline", references=[self.engine()]
        )

    def runtime(
        self, *sources: Path, name: str = "", references: Sequence[Path] = (), defines: Sequence[str] = ()
    ) -> Path:
        """A program in the assembly of the package's runtime, the last of `sources`, over the engine's stand-ins."""
        file = self.build([RUNTIME / "Format"], library=True, name="Mua.Format", translated=True)
        motion = self.build([RUNTIME / "Motion"], library=True, name="Mua.Motion", references=[file], translated=True)
        package = [*sorted(RUNTIME.glob("*.cs")), RUNTIME / "Kernels", *sources]
        references = [self.engine(), *references, file, motion]
        return self.build(package, name=name, references=references, defines=defines, translated=True)

    def run(self, program: Path, *arguments: object, content: bytes = b"") -> str:
        """What the program prints; fails the test with its words where it does not end well."""
        command = ["mono", str(program), *map(str, arguments)]
        done = subprocess.run(command, input=content, capture_output=True, check=False)
        assert done.returncode == 0, (done.stdout[-2000:] + done.stderr[-4000:]).decode(errors="replace")
        return done.stdout.decode()


def _code_of(assembly: Path) -> Path:
    """The machine code that mono takes for an assembly where it lies beside it."""
    return assembly.with_name(f"{assembly.name}.so")


def by_name(printed: str) -> dict[str, list[str]]:
    """The values of lines that are a name, a tab and a value, by the name."""
    found: dict[str, list[str]] = {}
    for line in printed.splitlines():
        name, _, value = line.partition("\t")
        found.setdefault(name, []).append(value)
    return found


def _digest(files: Sequence[Path], options: Sequence[str]) -> str:
    state = hashlib.sha256("\n".join(options).encode())
    for path in files:
        state.update(path.name.encode() + hashlib.sha256(path.read_bytes()).digest())
    return state.hexdigest()[:32]
