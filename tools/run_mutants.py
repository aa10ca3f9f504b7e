"""Puts faults into a copy of the tree one at a time and says which of them the tests catch.

    python tools/run_mutants.py                                # 200 faults, a third of each language
    python tools/run_mutants.py --seed 7 --language hlsl --number 40
    python tools/run_mutants.py --file python/mua/rotation.py

Each fault meets only tests that see its place, up to the first failure or some CPU time. Which these are is recorded
once in build/mutants and then kept; `--record` does it anew. Faults that do not compile count apart, and so do those
that tools/mutants.toml names, with a reason, as no change of behaviour.
"""

import argparse
import fnmatch
import os
import random
import re
import subprocess
import tomllib
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing
from dataclasses import dataclass, replace
from itertools import chain, cycle, islice
from pathlib import Path

from mutant_sites import Mutant, mutants
from mutant_tests import BOUND, Checkout, SeenTest, afforded, folder_of, record, seeing, spread

ROOT = Path(__file__).resolve().parents[1]
WORK = ROOT / "build" / "mutants"
EQUIVALENT = ROOT / "tools" / "mutants.toml"
TOOLS = ("gallery", "gen_*", "*upm*", "shader_*", "check_*", "csharp_*", "engine_use")  # those that tests run
LANGUAGES = {
    "python": ("python/mua/**/*.py", *(f"tools/{name}.py" for name in TOOLS)),
    "hlsl": (
        *("ComputeShaders/*.hlsl", "ComputeShaders/*.compute", "python/mua/player/shaders/*.hlsl"),
        *("unity-package/**/*.hlsl", "unity-package/**/*.shader"),
    ),
    "csharp": ("unity-package/Runtime/**/*.cs", "unity-package/Editor/**/*.cs", "unity-package/Samples~/**/*.cs"),
}
ROUNDS = 8
NOT_COMPILED = re.compile(r"error CS\d{4}|: \w+ does not compile: |^ERROR: .*\d+:\d+: ", re.MULTILINE)
WAITED = re.compile(r"\btimed out\b|\bTimeout", re.IGNORECASE)
CAUGHT, TIMED_OUT, SURVIVED, EQUAL, UNCOMPILED = "caught", "timed out", "survived", "equivalent", "does not compile"


@dataclass(frozen=True)
class Outcome:
    """What came of one fault."""

    mutant: Mutant
    result: str
    by: str  # the test that failed; what ran where none did

    def __str__(self) -> str:
        line, before, after = self.mutant.lines((ROOT / self.mutant.path).read_text())
        shown = f"{self.result:9} {self.mutant.path}:{line} {self.mutant.operator}"
        if self.result in (CAUGHT, TIMED_OUT):
            return f"{shown}, by {self.by}"
        return f"{shown}\n    {before}\n    {after}" + (f"\n    {self.by}" if self.by else "")


def drawn(language: str, seed: int, only: str = "") -> Iterator[Mutant]:
    """Faults in an order that the seed decides: every line as likely as any other, then every fault of the line."""
    files = sorted({path for pattern in LANGUAGES[language] for path in ROOT.glob(pattern)})
    lines: dict[tuple[str, int], list[Mutant]] = {}
    for path in files:
        if not only or path == ROOT / only:
            text = path.read_text(encoding="utf-8")
            for mutant in mutants(path, ROOT):
                lines.setdefault((mutant.path, mutant.lines(text)[0]), []).append(mutant)
    rng = random.Random(f"{seed} {language}")
    for _, found in rng.sample(sorted(lines.items()), len(lines)):
        yield rng.choice(found)


def reason(mutant: Mutant, text: str, known: list[dict[str, str]]) -> str:
    """Why a fault changes no behaviour, where the list says so."""
    before, after = (uncommented(line) for line in mutant.lines(text)[1:])
    for entry in known:
        said = {key: uncommented(value) for key, value in entry.items() if key in ("line", "starts", "becomes")}
        same = fnmatch.fnmatchcase(mutant.path, entry["file"]) and mutant.operator == entry["operator"]
        same = same and before.startswith(said.get("starts", "")) and said.get("line", before) == before
        if same and said.get("becomes", after) == after:
            return entry["reason"]
    return ""


def uncommented(line: str) -> str:
    """A line without the comment that ends it."""
    return re.sub(r"(?:^|\s+)(?:# |//\s?).*", "", line)


def tried(mutant: Mutant, checkout: Checkout, tests: list[SeenTest], caught: Counter[tuple[str, str]]) -> Outcome:
    """Put a fault in, run the tests that see it, take it out."""
    path, all_tests = checkout.root / mutant.path, seeing(mutant, tests, caught)
    text, times = path.read_text(encoding="utf-8"), path.stat()
    mutated = mutant.apply(text)
    if path.suffix == ".py":
        try:
            compile(mutated, str(path), "exec")
        except SyntaxError as error:
            return Outcome(mutant, UNCOMPILED, str(error))
    if not all_tests:
        return Outcome(mutant, SURVIVED, "no test sees it")
    outcome, waited = Outcome(mutant, SURVIVED, ""), True
    while waited and all_tests:
        path.write_text(mutated, encoding="utf-8")
        os.utime(path, (mutant.start + 1, mutant.start + 1))  # of its own, or Python might take the compiled former one
        try:
            outcome, waited = _judged(mutant, checkout, all_tests)
        finally:
            path.write_text(text, encoding="utf-8")
            os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
        if waited and checkout.pytest([outcome.by.split("::")[0]], [outcome.by], seconds=BOUND)[0] == []:
            return outcome  # only with the fault
        all_tests = [test for test in all_tests if test.name != outcome.by]
    return replace(outcome, result=SURVIVED) if waited else outcome


def _judged(mutant: Mutant, checkout: Checkout, tests: list[SeenTest]) -> tuple[Outcome, bool]:
    """What comes of a fault, and whether a test failed that waited too long, as on a busy machine it may without it."""
    chosen, seconds = afforded(tests)
    files = dict.fromkeys(test.file for test in chosen)
    failed, printed = checkout.pytest(files, [test.name for test in chosen], seconds=60 + 4 * seconds)
    if failed is None:
        return Outcome(mutant, TIMED_OUT, f"in {len(chosen)} tests"), False
    if not failed:
        left = f"; {len(tests) - len(chosen)} slower ones were not run" if len(chosen) < len(tests) else ""
        return Outcome(mutant, SURVIVED, f"{len(chosen)} tests pass{left}"), False
    if not mutant.path.endswith(".py") and (error := NOT_COMPILED.search(printed)):
        return Outcome(mutant, UNCOMPILED, printed[error.start() :].splitlines()[0]), False
    return Outcome(mutant, CAUGHT, failed[0]), "::" in failed[0] and bool(WAITED.search(printed))


def run(
    waiting: Iterator[Mutant],
    number: int,
    checkouts: list[Checkout],
    tests: list[SeenTest],
    caught: Counter[tuple[str, str]],  # by folder of the fault and test; counts on
) -> list[Outcome]:
    """Outcomes until `number` of the faults, taken in order, compiled and are not known as equivalent."""
    known = tomllib.loads(EQUIVALENT.read_text())["equivalent"]

    def outcome(checkout: Checkout, mutant: Mutant) -> Outcome:
        if why := reason(mutant, (ROOT / mutant.path).read_text(encoding="utf-8"), known):
            return Outcome(mutant, EQUAL, why)
        done = tried(mutant, checkout, tests, caught)
        caught[folder_of(mutant), done.by.split("[")[0]] += done.result == CAUGHT
        return done

    outcomes: list[Outcome] = []
    while missing := number - sum(each.result in (CAUGHT, TIMED_OUT, SURVIVED) for each in outcomes):
        batch = [mutant for mutant, _ in zip(waiting, range(missing), strict=False)]
        for done in spread(outcome, batch, checkouts):
            outcomes.append(done)
            print(done, flush=True)
        if len(batch) < missing:
            break
    return outcomes


def table(outcomes: dict[str, list[Outcome]]) -> str:
    """The share caught by language and in all, then every survivor."""
    lines = [f"{'':10}{'faults':>8}{'caught':>8}{'share':>8}{'equivalent':>12}{'do not compile':>16}"]
    everything = list(chain.from_iterable(outcomes.values()))
    for name, found in {**outcomes, "all": everything}.items():
        count: Callable[..., int] = lambda *results: sum(each.result in results for each in found)  # noqa: B023, E731
        caught, meant = count(CAUGHT, TIMED_OUT), count(CAUGHT, TIMED_OUT, SURVIVED)
        share = f"{100 * caught / meant:.1f} %" if meant else "none"
        lines.append(f"{name:10}{meant:8}{caught:8}{share:>8}{count(EQUAL):12}{count(UNCOMPILED):16}")
    return "\n".join(["", *(str(each) for each in everything if each.result == SURVIVED), "", *lines])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--number", type=int, default=200, help="faults in all, shared evenly by the languages")
    parser.add_argument("--seed", type=int, default=1, help="another seed draws other faults")
    parser.add_argument("--language", choices=LANGUAGES, action="append", help="only this one; may be repeated")
    parser.add_argument("--file", default="", help="only faults of this file")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="faults tried at once")
    parser.add_argument("--record", action="store_true", help="find out anew which tests see what")
    given = parser.parse_args()
    with ExitStack() as opened:
        checkouts = [opened.enter_context(closing(Checkout(WORK / f"job-{k}"))) for k in range(given.jobs)]
        for checkout in checkouts:
            checkout.refresh(ROOT)
        tests = record(checkouts, WORK / "seen", again=given.record)
        languages = given.language or list(LANGUAGES)
        waiting = {language: drawn(language, given.seed, given.file) for language in languages}
        outcomes = {language: list[Outcome]() for language in languages}
        turns = list(islice(cycle(languages), ROUNDS * len(languages)))  # who breaks off has seen a part of each
        caught = Counter[tuple[str, str]]()
        for k, language in enumerate(turns):
            number = (given.number + k) // len(turns)
            outcomes[language] += run(waiting[language], number, checkouts, tests, caught)
    commit = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    print(table(outcomes), f"\nseed {given.seed}, commit {commit.stdout.strip()}")


if __name__ == "__main__":
    main()
