"""Which test files see which functions and sources: recorded once by running each test file in a process of its own.

Of Python the functions that were entered are kept, in child processes too; of C# and HLSL the files that were read.
"""

import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

from mutant_sites import Mutant

# They hold that a listed line, or a compiled shader, stands as it stood, so that any change of it fails them.
LEFT_OUT = (
    "tests/parity/test_mutations.py",
    "tests/test_gpu_compiled.py",
    "tests/test_mutant_sites.py",
    "tests/test_run_mutants.py",
)
FAILED = re.compile(r"^(?:FAILED|ERROR) (\S+)", re.MULTILINE)
NOT_COMPILED = re.compile(r"error CS\d{4}|: \w+ does not compile: |^ERROR: .*\d+:\d+: ", re.MULTILINE)
WATCHER = """
import os, sys, threading
root, out = {root!r}, os.open({out!r}, os.O_WRONLY | os.O_APPEND | os.O_CREAT)
suffixes, seen = (".cs", ".hlsl", ".compute", ".shader"), {{}}
def note(line):
    if line not in seen:
        seen[line] = None
        os.write(out, line.encode() + b"\\n")
def entered(frame, event, argument):
    code = frame.f_code
    if id(code) not in seen:
        seen[id(code)] = code
        if code.co_filename.startswith(root):
            is_function = code.co_flags & 1  # not the body of a module or class, which an import runs
            note(code.co_filename[len(root):] + "\\t" + (code.co_qualname if is_function else "<module>"))
def opened(event, arguments):
    if event == "open" and isinstance(arguments[0], (str, os.PathLike)):
        path = os.path.abspath(os.fspath(arguments[0]))
        if isinstance(path, str) and path.endswith(suffixes) and path.startswith(root):
            note(path[len(root):])
sys.addaudithook(opened)
sys.settrace(entered)
threading.settrace(entered)
"""


@dataclass(frozen=True)
class Seen:
    """What one test file sees, and how long it takes."""

    digest: str  # of the test file
    seconds: float
    passes: bool
    functions: dict[str, list[str]]  # of each Python file the functions that were entered, by their qualified names
    files: list[str]  # C# and HLSL that were read


@dataclass(frozen=True)
class Checkout:
    """A copy of the tree that faults are put into, with caches and temporary files of its own."""

    folder: Path

    @property
    def root(self) -> Path:
        return self.folder / "checkout"

    def refresh(self, source: Path) -> None:
        """Make the copy what git knows of the source, changes that are not committed included."""
        listed = subprocess.run(
            ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
            cwd=source, capture_output=True, text=True, check=True,
        ).stdout.split("\0")  # fmt: skip
        names = {name for name in listed if (source / name).is_file()}
        for name in names:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source / name, self.root / name)
        for path in [path for path in self.root.rglob("*") if path.is_file() and "__pycache__" not in path.parts]:
            if path.relative_to(self.root).as_posix() not in names:
                path.unlink()
        (self.folder / "tmp").mkdir(exist_ok=True)
        beside = self.folder / "shared"
        if (source.parent / "shared").is_dir() and not beside.exists():
            beside.symlink_to(source.parent / "shared")

    def pytest(self, tests: list[str], *, seconds: float, before: Path | None = None) -> tuple[int | None, str]:
        """Exit status, None where the time was over, and what was printed."""
        paths = [*([str(before)] if before else []), str(self.root / "python")]
        environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(paths),
            "TMPDIR": str(self.folder / "tmp"),
            "OMP_NUM_THREADS": "1",  # several faults are tried at once
        }
        words = "-m pytest -x -q -rfE --tb=short -p no:cacheprovider -p no:randomly"
        command = [sys.executable, *words.split()]
        process = subprocess.Popen(
            [*command, *tests], cwd=self.root, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, errors="replace", start_new_session=True,
        )  # fmt: skip
        try:
            printed, _ = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return None, process.communicate()[0]
        return process.returncode, printed


def record(checkouts: list[Checkout], kept: Path, *, again: bool = False) -> dict[str, Seen]:
    """What every test file sees; only what is new or changed is run, unless `again`."""
    root = checkouts[0].root
    known = {} if again or not kept.is_file() else json.loads(kept.read_text())
    wanted = {path.relative_to(root).as_posix(): _digest(path) for path in sorted(root.glob("tests/**/test_*.py"))}
    found = {name: Seen(**seen) for name, seen in known.items() if wanted.get(name) == seen["digest"]}
    free, one_at_a_time = list(checkouts), threading.Lock()

    def watched(name: str) -> None:
        checkout = free.pop()
        watching = _watch(checkout, name, wanted[name])
        free.append(checkout)
        print(f"{watching.seconds:6.1f} s  {name}{'' if watching.passes else '  FAILS'}", flush=True)
        with one_at_a_time:
            found[name] = watching
            kept.write_text(json.dumps({name: asdict(found[name]) for name in sorted(found)}))

    with ThreadPoolExecutor(len(checkouts)) as pool:
        list(pool.map(watched, [name for name in wanted if name not in found and name not in LEFT_OUT]))
    return found


def _watch(checkout: Checkout, name: str, digest: str) -> Seen:
    folder = checkout.folder / "watcher"
    folder.mkdir(exist_ok=True)
    out = folder / "seen.txt"
    out.unlink(missing_ok=True)
    (folder / "sitecustomize.py").write_text(WATCHER.format(root=f"{checkout.root}/", out=str(out)))
    start = time.monotonic()
    status, _ = checkout.pytest([name], seconds=1800, before=folder)
    functions: dict[str, set[str]] = {}
    files = set[str]()
    for line in out.read_text().splitlines() if out.is_file() else []:
        path, _, function = line.partition("\t")
        if not path.startswith("tests/"):
            functions.setdefault(path, set()).add(function.split(".<locals>")[0]) if function else files.add(path)
    passes = status in (0, 5)  # none collected, where all are marked, is no failure
    return Seen(digest, time.monotonic() - start, passes, {p: sorted(f) for p, f in functions.items()}, sorted(files))


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


def seeing(mutant: Mutant, seen: dict[str, Seen], caught: Mapping[tuple[str, str], int]) -> list[str]:
    """The test files that can notice a fault, those that are likely to first.

    That is those named after the file, then those that `caught` most in its folder, then the fastest.
    """
    sound = {name: each for name, each in seen.items() if each.passes}
    if not mutant.path.endswith(".py"):
        chosen = [name for name, each in sound.items() if mutant.path in each.files]
    else:
        entered = {name: set(each.functions.get(mutant.path, ())) for name, each in sound.items()}
        chosen = [name for name, functions in entered.items() if mutant.scope in functions]
        chosen = chosen or [name for name, functions in entered.items() if any(f[0] != "<" for f in functions)]
        chosen = chosen or [name for name, functions in entered.items() if functions]
    stem, folder = Path(mutant.path).stem, folder_of(mutant)
    family = stem.split("_")[0]

    def rank(name: str) -> tuple[bool, bool, int, float]:
        own = Path(name).stem
        return stem not in own, family not in own, -caught.get((folder, name), 0), sound[name].seconds

    return sorted(chosen, key=rank)


def folder_of(mutant: Mutant) -> str:
    return str(Path(mutant.path).parent)
