"""mua-deploy: puts the player and avatars on a headset, and tests and measures there."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from mua.cli.console import figures, printer
from mua.cli.failure import run_command
from mua.deploy.steady import RATES
from mua.deploy.unity import find, project_version
from mua.errors import InputError
from mua.files import write as files
from mua.files.inputs import require_file

if TYPE_CHECKING:  # load adbutils, an optional package
    from mua.deploy.avatars import Checked
    from mua.deploy.bench import Benched
    from mua.deploy.headset import Headset
    from mua.deploy.self_test import Case


def deploy(
    avatars: Annotated[
        list[Path] | None, typer.Argument(metavar="AVATAR", help="Avatar files (.muaavatar) to copy to the headset.")
    ] = None,
    apk: Annotated[Path | None, typer.Option(help="Player APK to install.")] = None,
    project: Annotated[Path | None, typer.Option(help="Unity project to build the player from.")] = None,
    unity: Annotated[
        Path | None,
        typer.Option(
            help="Unity editor program.", show_default="$UNITY_EDITOR, else the editor that Unity Hub installed"
        ),
    ] = None,
    serial: Annotated[
        str | None,
        typer.Option(envvar="ANDROID_SERIAL", help="Serial number of the headset, as 'adb devices' lists it."),
    ] = None,
    test: Annotated[
        bool, typer.Option("--self-test", help="Run every kernel on the headset and compare with stored results.")
    ] = False,
    seconds: Annotated[
        int | None, typer.Option("--bench", min=1, metavar="SECONDS", help="Measure each AVATAR for this many seconds.")
    ] = None,
    rate: Annotated[
        int, typer.Option(help=f"Display refresh rate for --bench in Hz: {', '.join(map(str, RATES))}.")
    ] = 72,
    output: Annotated[Path | None, typer.Option("--json", help="JSON file to write the figures of --bench to.")] = None,
    doctor: Annotated[bool, typer.Option("--doctor", help="Only report what is missing, and how to fix it.")] = False,
) -> None:
    """Install the player on a headset, copy AVATARs to it and start it."""
    given = avatars or []
    console = printer(highlight=False)
    if doctor:
        _examine(console, given, serial=serial, unity=unity, project=project)
        return
    _require_sense(given, apk=apk, project=project, unity=unity, seconds=seconds, rate=rate, output=output)
    for avatar in given:
        require_file(avatar)

    from mua.deploy.avatars import check, push  # here, so that a wrong name fails at once
    from mua.deploy.headset import connect
    from mua.deploy.player import read_apk, start

    checked = check(given)
    if apk is not None:
        read_apk(apk)
    headset = connect(serial)
    _install(console, headset, _built(console, unity, project) if project else apk)
    for sound in checked:
        console.print(f"pushed {sound.name}, {push(headset, sound) / 1e6:.1f} MB")
    if test:
        _self_test(console, headset)
    if seconds is not None:
        _bench(console, headset, checked, seconds=seconds, rate=rate, output=output)
    if not test and seconds is None:
        start(headset, *(("-muaAvatar", checked[0].name) if checked else ()))
        console.print(f"started on {headset.serial}")


def run() -> None:
    """Entry point of the command."""
    run_command(deploy)


def _require_sense(
    avatars: list[Path],
    *,
    apk: Path | None,
    project: Path | None,
    unity: Path | None,
    seconds: int | None,
    rate: int,
    output: Path | None,
) -> None:
    """Refuse options that contradict each other before anything is done."""
    if apk is not None and project is not None:
        raise InputError("--apk and --project are both given; expected one of the two")
    if unity is not None and project is None:
        raise InputError("--unity is given without --project; expected the project to build")
    if project is not None:
        project_version(project)
    if seconds is not None and not avatars:
        raise InputError("--bench measures avatars; expected at least one AVATAR")
    if output is not None and seconds is None:
        raise InputError("--json holds the figures of --bench; expected --bench SECONDS")
    if rate not in RATES:
        raise InputError(f"--rate is {rate}; expected one of {', '.join(map(str, RATES))}")


def _built(console: Console, unity: Path | None, project: Path) -> Path:
    from mua.deploy.build import build

    editor = find(unity, project)
    console.print(f"building with {editor.program}")
    return build(editor, project)


def _install(console: Console, headset: "Headset", apk: Path | None) -> None:
    from mua.deploy.player import install, require_installed

    if apk is None:
        require_installed(headset)
    else:
        install(headset, apk)
        console.print(f"installed {apk}")


def _self_test(console: Console, headset: "Headset") -> None:
    from mua.deploy.self_test import self_test

    cases = self_test(headset)
    console.print(_kernels(cases))
    failed = [case for case in cases if case.what is not None]
    if failed:
        first = failed[0]
        raise InputError(
            f"{len(failed)} of {len(cases)} cases failed on {headset.serial}, the first is "
            f"{first.kernel}/{first.name}: {first.what}"
        )
    console.print(f"{len(cases)} of {len(cases)} cases passed on {headset.serial}")


def _kernels(cases: "list[Case]") -> Table:
    table = Table("kernel", "passed", "failed", box=SIMPLE_HEAD)
    for kernel in dict.fromkeys(case.kernel for case in cases):
        own = [case for case in cases if case.kernel == kernel]
        failed = [f"{case.name}: {case.what}" for case in own if case.what is not None]
        table.add_row(kernel, str(len(own) - len(failed)), "\n".join(failed))
    return table


def _bench(
    console: Console, headset: "Headset", avatars: "list[Checked]", *, seconds: int, rate: int, output: Path | None
) -> None:
    from mua.deploy.bench import as_json, bench, warnings

    benched = []
    for avatar in avatars:
        benched.append(bench(headset, avatar.name, seconds=seconds, rate=rate))
        console.print(_heading(benched[-1]), _figures(benched[-1]))
        for warning in warnings(benched[-1]):
            console.print(f"warning: {warning}")
    if output is not None:
        content = {"benched": [as_json(each) for each in benched]}
        files.write_bytes(output, json.dumps(content, indent=2).encode() + b"\n")
        console.print(output, soft_wrap=True)


def _heading(benched: "Benched") -> str:
    seconds = f"{len(benched.samples)} of {benched.seconds} seconds"
    return f"{benched.avatar} on {benched.model}, {seconds} at {benched.rate} Hz"


def _figures(benched: "Benched") -> Table:
    table = figures("", "min", "median", "95 %", box=SIMPLE_HEAD)
    for name, spread in benched.figures().items():
        row = (f"{value:.2f}".rstrip("0").rstrip(".") for value in (spread.minimum, spread.median, spread.high))
        table.add_row(name.replace("_", " "), *row)
    return table


def _examine(
    console: Console, avatars: list[Path], *, serial: str | None, unity: Path | None, project: Path | None
) -> None:
    from mua.deploy.doctor import examine

    checks = examine(avatars, serial=serial, unity=unity, project=project)
    table = Table("check", "state", "found, and the fix", box=SIMPLE_HEAD)
    for one in checks:
        table.add_row(one.name, one.state, "\n".join(filter(None, (one.found, one.fix))))
    console.print(table)
    wrong = [one.name for one in checks if one.state != "ok"]
    if wrong:
        raise InputError(f"{len(wrong)} of {len(checks)} checks are not ok: {', '.join(wrong)}")


if __name__ == "__main__":
    run()
