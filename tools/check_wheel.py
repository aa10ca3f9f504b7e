"""Build the wheel, install it into an empty environment, and run every command there without any compiler.

Extras are installed one after the other; after each its commands run from another directory, with nothing else on the
PATH and empty caches. Prints what each step brought the environment to. It downloads about 1 GB; `make test-wheel` runs
it. With --lowest all packages but torch have the lowest versions that pyproject.toml allows.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console

ROOT = Path(__file__).resolve().parents[1]
TORCH = "torch==2.13.0"  # the build for the CPU, from an index of its own
SENTENCE = "which is not here: pip install"
AVATAR, SMALL = "a.muaavatar", ("--size", "128")
BAKE = ("mua-bake", "--preset", "tiny", "--frames", "24", "-o", AVATAR)


@dataclass(frozen=True)
class Run:
    """A command, what it is to write, and what it is to print."""

    words: tuple[str, ...]
    writes: str | None = None
    prints: str = ""
    status: int = 0


@dataclass(frozen=True)
class Step:
    """The packages to install, and the commands to run then."""

    name: str
    packages: tuple[str, ...]  # for pip; {wheel} stands for the wheel
    runs: tuple[Run, ...]


STEPS = (
    Step(
        "base",
        ("{wheel}",),
        (
            Run(("mua-inspect", "{avatar}"), prints="GFLOPs"),
            Run(("mua-view", "{avatar}", "--reference", *SMALL, "-o", "cpu.png"), writes="cpu.png"),
            Run(("mua-share", "{avatar}", "--reference", "-o", "shared"), writes="shared/index.html"),
            Run(("mua-view", "{avatar}", *SMALL, "-o", "gpu.png"), prints=f'{SENTENCE} "mua[view]"', status=1),
            Run(("mua-export", "{avatar}", "-o", "a.spz"), writes="a.spz"),
            Run(("mua-export", "{avatar}", "-o", "a.glb"), prints=f'{SENTENCE} "mua[export]"', status=1),
            Run(("mua-bench", "{avatar}"), prints=f'{SENTENCE} "mua[view]"', status=1),
            Run(BAKE, prints=f'{SENTENCE} "mua[bake]"', status=1),
            Run(("mua-deploy", "{avatar}"), prints=f'{SENTENCE} "mua[deploy]"', status=1),
        ),
    ),
    Step(
        "export",
        ("{wheel}[export]",),
        (
            Run(("mua-export", "{avatar}", "-o", "a.glb"), writes="a.glb"),
            Run(("mua-export", "{avatar}", "-o", "a.usdz"), writes="a.usdz"),
            Run(("mua-export", "{avatar}", "-o", "a.bvh"), writes="a.bvh"),
        ),
    ),
    Step(
        "view",
        ("{wheel}[view]",),
        (
            Run(("mua-view", "--list-devices"), prints="0: "),
            Run(("mua-view", "{avatar}", *SMALL, "-o", "gpu.png"), writes="gpu.png"),
            Run(
                ("mua-view", "{avatar}", *SMALL, "--show", "geometry,template,skeleton,shadow", "-o", "all.png"),
                writes="all.png",
            ),
            Run(("mua-view", "{avatar}", *SMALL, "-o", "gpu.mp4"), writes="gpu.mp4"),
            Run(("mua-bench", "{avatar}", *SMALL, "--frames", "2"), prints="splats visible"),
        ),
    ),
    Step("torch", (TORCH,), ()),
    Step("train", ("{wheel}[train]",), (Run(("mua-train", "{avatar}"), prints="expected the directory", status=1),)),
    Step(
        "bake",
        ("{wheel}[bake]",),
        (
            Run(BAKE, writes=AVATAR),
            Run(("mua-inspect", "--verify", AVATAR), prints="sound"),
            Run(("mua-view", AVATAR, *SMALL, "-o", "baked.png"), writes="baked.png"),
            Run(("mua-train", "{recording}", "--preset", "tiny", "-o", "b.muaavatar"), writes="b.muaavatar"),
        ),
    ),
    Step(
        "eval",
        ("{wheel}[eval]",),
        (
            Run(
                ("mua-eval", "{recording}", AVATAR, "--frames", "1", "--views", "1", "--size", "192", "-o", "figures"),
                writes="figures/results.json",
            ),
        ),
    ),
    Step("all", ("{wheel}[all]",), (Run(("mua-deploy", "--doctor"), prints="adb", status=1),)),
)


def build(folder: Path) -> Path:
    """The wheel of this checkout."""
    shutil.rmtree(ROOT / "python" / "build", ignore_errors=True)  # leftovers of an older checkout would go in too
    command = [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", str(folder), str(ROOT / "python")]
    subprocess.run(command, check=True)
    (wheel,) = folder.glob("mua-*.whl")
    return wheel


def left_out(wheel: Path) -> list[str]:
    """Files of the browser player that the wheel lacks."""
    with zipfile.ZipFile(wheel) as packed:
        names = set(packed.namelist())
    package = ROOT / "python"
    files = [path for path in (package / "mua" / "web").rglob("*") if path.is_file()]
    return [name for name in (path.relative_to(package).as_posix() for path in files) if name not in names]


def lowest() -> list[str]:
    """The lowest version of each package but torch that pyproject.toml allows."""
    project = tomllib.loads((ROOT / "python" / "pyproject.toml").read_text())["project"]
    requirements = sum(project["optional-dependencies"].values(), project["dependencies"])
    floored = (re.match(r"([\w-]+)>=([^,]*)", requirement) for requirement in requirements)
    return sorted({f"{found[1]}=={_series(found[2])}" for found in floored if found and found[1] != "torch"})


def _series(version: str) -> str:
    """A version as it stands, or any patch of it where it names none."""
    parts = version.split(".")
    return version if len(parts) > 2 else ".".join([*parts, "0"][:2]) + ".*"


def megabytes(folder: Path) -> float:
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file() and not path.is_symlink()) / 1e6


def fault(run: Run, folder: Path, programs: Path, named: dict[str, str]) -> str | None:
    """Carry out a run in a folder; what is wrong with it, if anything is."""
    words = [word.format(**named) for word in run.words]
    environment = {
        "PATH": str(programs),  # and no compiler
        "HOME": str(folder),
        "COLUMNS": "200",
        **{name: os.environ[name] for name in ("SYSTEMROOT", "VK_ICD_FILENAMES", "TMPDIR") if name in os.environ},
    }
    words[0] = str(programs / words[0])
    ended = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    printed = ended.stdout + ended.stderr
    if ended.returncode != run.status:
        return f"status {ended.returncode}: {printed[-600:]}"
    if run.prints not in printed:
        return f"does not print {run.prints!r}: {printed[-600:]}"
    if run.writes is not None and not (folder / run.writes).is_file():
        return f"does not write {run.writes}: {printed[-600:]}"
    return None


def carry_out(scratch: Path, avatar: Path, constraints: list[str], console: Console) -> list[str]:
    """All steps, one line of figures each; what is wrong, a line each."""
    folder, venv, listed = scratch / "elsewhere", scratch / "venv", scratch / "constraints.txt"
    folder.mkdir()
    listed.write_text("\n".join(constraints))
    wheel = build(scratch)
    subprocess.run([sys.executable, "-m", "venv", str(venv)], check=True)
    programs, empty = venv / ("Scripts" if os.name == "nt" else "bin"), megabytes(venv)
    faults = [f"{name} is not in the wheel" for name in left_out(wheel)]
    for step in STEPS:
        packages = [package.format(wheel=wheel) for package in step.packages]
        subprocess.run([programs / "python", "-I", "-m", "pip", "install", "-q", "-c", listed, *packages], check=True)
        console.print(f"{step.name}: {megabytes(venv) - empty:.0f} MB", highlight=False)
        for run in step.runs:
            recording = next(folder.glob("a.work/recording-*"), Path("none"))
            found = fault(run, folder, programs, {"avatar": str(avatar), "recording": str(recording)})
            console.print(f"  {' '.join(run.words)}: {found or 'as it should'}", highlight=False, markup=False)
            faults += [] if found is None else [found]
    return faults + [f"{path.name} was compiled" for path in folder.rglob("*.spv")]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--avatar", type=Path, default=ROOT / "build" / "demo" / "avatar.muaavatar")
    parser.add_argument("--lowest", action="store_true", help="with the lowest versions of all packages but torch")
    options = parser.parse_args()
    avatar = options.avatar.resolve()
    if not avatar.is_file():
        sys.exit(f"error: {avatar}: there is no such file; make demo bakes one")
    with tempfile.TemporaryDirectory() as scratch:
        faults = carry_out(Path(scratch), avatar, lowest() if options.lowest else [], Console(soft_wrap=True))
    sys.exit(f"{len(faults)} faults" if faults else 0)


if __name__ == "__main__":
    main()
