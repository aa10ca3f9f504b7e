"""Which tests see which functions and sources, recorded once; a copy of the tree that runs those that are asked for.

Of Python the functions that were entered are kept, in child processes too; of C# and HLSL the files that were read.
"""

import hashlib
import json
import math
import os
import re
import shutil
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import TypeVar

from mutant_sites import Mutant

# They hold that a listed line, or a compiled shader, stands as it stood, so that any change of it fails them.
LEFT_OUT = (
    "tests/parity/test_mutations.py",
    "tests/test_gpu_compiled.py",
    "tests/test_mutant_sites.py",
    "tests/test_run_mutants.py",
)
IMPORTED = (  # slow ones of those that tests import; none of this repository, whose files change
    *(
        "numpy",
        "scipy.ndimage",
        "scipy.optimize",
        "scipy.sparse.linalg",
        "scipy.spatial",
        "torch._dynamo",
        "torchmetrics",
    ),
    *("wgpu", "typer", "rich.table", "trimesh", "pygltflib", "pxr.Usd", "PIL.Image", "matplotlib.pyplot", "pywt"),
    *("moderngl", "xatlas", "imgui_bundle"),
)
BOUND = 240  # seconds of CPU that the tests of one fault may take
SLOW = 10  # seconds beyond which a test comes behind others
LEAST_SECONDS = 0.3  # that any test takes
WAITING = 60  # seconds that they may spend without using the CPU
T, R = TypeVar("T"), TypeVar("R")


@dataclass(frozen=True)
class SeenTest:
    """What one test sees, and how long it takes."""

    file: str
    name: str  # as pytest takes it
    seconds: float  # of CPU, without fixtures that it shares
    places: set[str]  # C# and HLSL files that were read; of Python file, tab, a function's qualified name
    fixtures: dict[str, float]  # seconds of those that it shares with other tests of the file

    @property
    def function(self) -> str:
        return self.name.split("[")[0]


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
        self.close()  # its working directory goes
        shutil.rmtree(self.root, ignore_errors=True)
        for name in (name for name in listed if (source / name).is_file()):
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source / name, self.root / name)
        (self.folder / "tmp").mkdir(exist_ok=True)
        beside = self.folder / "shared"
        if (source.parent / "shared").is_dir() and not beside.exists():
            beside.symlink_to(source.parent / "shared")

    @cached_property
    def _worker(self) -> subprocess.Popen[str]:
        environment = {
            **os.environ,
            "PYTHONPATH": str(self.root / "python"),
            "TMPDIR": str(self.folder / "tmp"),
            "OMP_NUM_THREADS": "1",  # several faults are tried at once
        }
        program = [sys.executable, str(Path(__file__).with_name("mutant_worker.py")), *IMPORTED]
        return subprocess.Popen(
            program, cwd=self.root, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def pytest(
        self,
        files: Iterable[str],
        tests: Iterable[str] = (),
        *,
        seconds: float,  # of CPU time
        waiting: float = WAITING,  # seconds without any
        watch: Path | None = None,
    ) -> tuple[list[str] | None, str]:
        """Tests of some files that fail, None where the time was over, and what was printed."""
        printed = self.folder / "printed.txt"
        printed.unlink(missing_ok=True)
        environment = {} if watch is None else self._watching(watch)
        order = {
            **{"files": [*files], "tests": [*tests], "environment": environment, "seconds": seconds},
            **{"waiting": waiting, "watch": watch is not None, "printed": str(printed)},
        }
        stdin, stdout = self._worker.stdin, self._worker.stdout
        assert stdin is not None
        assert stdout is not None
        stdin.write(json.dumps(order) + "\n")
        stdin.flush()
        answer = json.loads(stdout.readline())
        return None if answer["over"] else answer["failed"], printed.read_text(errors="replace")

    def close(self) -> None:
        """End the process that runs tests; the next one starts another."""
        if (worker := self.__dict__.pop("_worker", None)) is not None:
            worker.communicate()

    def _watching(self, out: Path) -> dict[str, str]:
        folder = self.folder / "watcher"
        folder.mkdir(exist_ok=True)
        start = f"import sys; sys.path.append({str(Path(__file__).parent)!r}); import mutant_watcher as w; w.Watcher()"
        (folder / "sitecustomize.py").write_text(start)  # runs first of all in child processes
        paths = os.pathsep.join([str(folder), str(self.root / "python")])
        return {"PYTHONPATH": paths, "MUTANTS_ROOT": f"{self.root}/", "MUTANTS_SEEN": str(out)}


def spread(work: Callable[[Checkout, T], R], items: Iterable[T], checkouts: list[Checkout]) -> Iterator[R]:
    """Results in the order of the items, by as many threads as there are checkouts, each with one to itself."""
    free = list(checkouts)

    def lent(item: T) -> R:
        checkout = free.pop()
        try:
            return work(checkout, item)
        finally:
            free.append(checkout)

    with ThreadPoolExecutor(len(checkouts)) as pool:
        yield from pool.map(lent, items)


def record(checkouts: list[Checkout], kept: Path, *, again: bool = False) -> list[SeenTest]:
    """What every test sees; only files that are new or changed are run, unless `again`."""
    root = checkouts[0].root
    kept.mkdir(parents=True, exist_ok=True)
    names = [path.relative_to(root).as_posix() for path in sorted(root.glob("tests/**/test_*.py"))]

    def watched(checkout: Checkout, name: str) -> list[SeenTest]:
        found, digest = kept / f"{name.replace('/', '.')}.json", _digest(root / name)
        if again or not found.is_file() or json.loads(found.read_text())["digest"] != digest:
            start = time.monotonic()
            contexts, failed = _watch(checkout, name)
            print(f"{time.monotonic() - start:6.1f} s  {name}", *(f"\n    FAILS {test}" for test in failed), flush=True)
            found.write_text(json.dumps({"digest": digest, "failed": failed, "contexts": contexts}))
        return _tests(name, **json.loads(found.read_text()))

    return list(chain(*spread(watched, [name for name in names if name not in LEFT_OUT], checkouts)))


def _watch(checkout: Checkout, name: str) -> tuple[dict[str, list[str]], list[str]]:
    """By test or fixture what it meets, its seconds and the fixtures that it is given; tests that fail."""
    out = checkout.folder / "seen.txt"
    out.unlink(missing_ok=True)
    failed, _ = checkout.pytest([name], seconds=1800, watch=out)
    contexts: dict[str, list[str]] = {}
    for line in out.read_text().splitlines() if out.is_file() else []:
        context, _, what = line.partition("\t")
        if not what.startswith("tests/"):
            contexts.setdefault(context, []).append(what)
    return contexts, [name] if failed is None else failed


def _tests(file: str, digest: str, failed: list[str], contexts: dict[str, list[str]]) -> list[SeenTest]:
    def places(context: str) -> set[str]:
        return {sys.intern(what) for what in contexts.get(context, ()) if what[0] != "\t"}

    def seconds(context: str) -> float:
        told = (what[1:] for what in contexts[context] if what[0] == "\t")
        return sum(float(word) for word in told if word[0].isdigit())

    tests = []
    for name in contexts:
        if "::" in name and not {name, file} & set(failed):
            given = [word for what in contexts[name] if what[0] == "\t" and (word := what[1:]) in contexts]
            seen = places("").union(places(name), *(places(fixture) for fixture in given))
            tests.append(SeenTest(file, name, seconds(name), seen, {fixture: seconds(fixture) for fixture in given}))
    return tests


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


def seeing(mutant: Mutant, tests: list[SeenTest], caught: Mapping[tuple[str, str], int]) -> list[SeenTest]:
    """The tests that can notice a fault, those that are likely to first.

    That is those named after the file, then, slow ones last, those that `caught` most in its folder, then those that
    are fast and see little else; of a parametrised test two, and the others behind all else.
    """
    within, folder = f"{mutant.path}\t", folder_of(mutant)
    scope = within + mutant.scope if mutant.path.endswith(".py") else mutant.path
    chosen = [test for test in tests if scope in test.places]
    chosen = chosen or [test for test in tests if any(p.startswith(within) and p[-1] != ">" for p in test.places)]
    chosen = chosen or [test for test in tests if f"{within}<module>" in test.places]
    chosen = chosen or [test for test in tests if any(p.startswith(f"{folder}/") for p in test.places)]  # a new file
    own = _words(mutant.path)

    def rank(test: SeenTest) -> tuple[float, bool, int, float]:
        words, seconds = _words(test.file), test.seconds + sum(test.fixtures.values())
        alike = len(own & words) / len(own | words)
        cost = max(seconds, LEAST_SECONDS) * math.sqrt(len(test.places))
        return -alike, seconds > SLOW, -caught.get((folder, test.function), 0), cost

    variants = Counter[str]()

    def is_one_more(test: SeenTest) -> bool:
        variants[test.function] += 1
        return variants[test.function] > 2

    return sorted(sorted(chosen, key=rank), key=is_one_more)


def _words(path: str) -> set[str]:
    return {word.lower() for word in re.findall(r"[A-Z]?[a-z0-9]+|[A-Z]+", Path(path).stem)}


def afforded(tests: list[SeenTest]) -> tuple[list[SeenTest], float]:
    """Of tests in order those that together keep within the bound, and their seconds."""
    chosen, paid, spent = [], set[tuple[str, str]](), 0.0
    for test in tests:
        fixtures = {(test.file, name): seconds for name, seconds in test.fixtures.items()}
        seconds = test.seconds + sum(s for fixture, s in fixtures.items() if fixture not in paid)
        if spent + seconds <= BOUND or not chosen:
            chosen.append(test)
            paid.update(fixtures)
            spent += seconds
    return chosen, spent


def folder_of(mutant: Mutant) -> str:
    return str(Path(mutant.path).parent)
