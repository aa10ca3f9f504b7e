"""What `mua-bake --check` prints."""

from collections.abc import Sequence
from pathlib import Path

import typer
from rich.console import Console
from rich.table import Table

from mua.arguments import amount
from mua.baking.check import Check, as_dict, check, write_json
from mua.baking.check_many import GOOD, LOOK, REFUSED, Checked, check_many
from mua.baking.settings import BakeSettings
from mua.cli.console import brief, printer, say
from mua.cli.display import Display
from mua.fidelity.compare import Fidelity
from mua.fidelity.faces import FaceFidelity
from mua.files.write import require_writable
from mua.motion.quality import MotionQuality

FEW = 5  # joints that are named
SCREEN = 8  # sentences and clips that are shown, unless all are asked for
LOOKS_WRONG = 3  # exit status where something looks wrong


def check_and_show(settings: BakeSettings, json: Path | None, *, verbose: bool = False) -> None:
    """Check a character and its motion and print what was found; status LOOKS_WRONG where something looks wrong."""
    if json is not None:
        require_writable(json)
    console = printer()
    with Display(console, verbose=verbose) as display:
        found = check(settings, display, every_face=verbose)
    if json is not None:
        write_json(json, as_dict(settings, found))
    show(console, found, verbose=verbose)
    if json is not None:
        say(console, str(json))
    if found.warnings:
        raise typer.Exit(LOOKS_WRONG)


def check_many_and_show(settings: BakeSettings, characters: Sequence[Path], json: Path | None) -> None:
    """Check many characters and print a line for each, worst first.

    Ends the command with status 1 where one is refused, else with LOOKS_WRONG where one looks wrong.
    """
    if json is not None:
        require_writable(json)
    console = printer()
    with Display(console) as display:
        found = check_many(settings, characters, display)
    if json is not None:
        write_json(json, [one.figures or {"character": str(one.path), "refused": one.sentences[0]} for one in found])
    for one in found:
        say(console, line_of(one))
    counts = [sum(one.verdict == verdict for one in found) for verdict in (GOOD, LOOK, REFUSED)]
    say(console, "{} characters: {} good, {} to look at, {} refused".format(len(found), *counts))
    say(console, f"pictures: {settings.output.with_name('*_check.png')}")
    if counts[2] or counts[1]:
        raise typer.Exit(1 if counts[2] else LOOKS_WRONG)


def line_of(one: Checked) -> str:
    """A character in a line: the verdict, the file, its figures, and the first sentence of what is wrong."""
    figures = "" if one.iou is None else f" overlap {100 * one.iou:.1f} %, inside {one.psnr:.1f} dB."
    said = "" if not one.sentences else f" {one.sentences[0]}"
    more = "" if len(one.sentences) < 2 else f" (and {len(one.sentences) - 1} more)"
    return f"{one.verdict:<8}{one.path}:{figures}{said}{more}"


def show(console: Console, found: Check, *, verbose: bool = False) -> None:
    """Print what looks wrong, then the figures, what readers changed, how many joints move, and the files written.

    Unless `verbose`, long lists are cut so that all fits on a screen.
    """
    shown = len(found.warnings) if verbose else SCREEN
    for sentence in found.warnings[:shown]:
        say(console, f"Look at this: {sentence}")
    if len(found.warnings) > shown:
        say(console, f"{amount(len(found.warnings) - shown, 'more sentence')} like these (--verbose prints them).")
    if not found.warnings:
        say(console, "Nothing looks wrong.")
    if found.fidelity is not None:
        console.print(_fidelity_table(found.fidelity))
        if found.fidelity.face is not None:
            say(console, _face(found.fidelity.face))
    if any(motion.limbs for motion in found.motions):
        motions = found.motions if verbose else sorted(found.motions, key=lambda motion: -len(motion.flaws))[:SCREEN]
        console.print(_motion_table(tuple(motions)))
        if len(found.motions) > len(motions):
            say(console, f"{amount(len(found.motions) - len(motions), 'more clip')} (--verbose prints them).")
    elif found.motions:
        brought = found.matched or found.unmatched  # by a motion file
        whose = (
            "Clips of the motion (it moves no arm or leg, so nothing is measured)"
            if brought
            else "The character's own clips"
        )
        say(console, f"{whose}: {', '.join(motion.name for motion in found.motions)}")
    for sentence in found.notes:
        say(console, sentence if verbose else brief(sentence))
    if found.matched or found.unmatched:
        say(console, _joints(found))
    if verbose and found.matched:
        say(console, "Pairs: " + ", ".join(f"{pair.target} by {pair.source}" for pair in found.matched))
        say(console, "Nothing moves: " + (", ".join(found.unmatched) or "no joint with skin") + ".")
    for path in found.written:
        say(console, str(path))


def _face(face: FaceFidelity) -> str:
    """How many expressions there are, and how like the source the face is in them."""
    rest = face.rest.agreement.psnr
    decibels = sorted(shot.agreement.psnr for shot in face.expressions)
    few = len(face.least_like)
    shown = f" The picture has the {few} least like it (--verbose: all)." if few < len(decibels) else ""
    return (
        f"Face: {amount(len(decibels), 'expression')} at weight 1 compared with the source: least {decibels[0]:.1f} dB "
        f"({face.worst.name}), median {decibels[len(decibels) // 2]:.1f} dB, at rest {rest:.1f} dB.{shown}"
    )


def _fidelity_table(fidelity: Fidelity) -> Table:
    table = Table("pose", "overlap", "inside", "worst at", "seen from", title="Splats compared with the source, unlit")
    for pose in fidelity.poses:
        seen, worst = pose.agreement, pose.worst
        table.add_row(pose.pose, f"{100 * seen.iou:.1f} %", f"{seen.psnr:.1f} dB", worst.joint, worst.view)
    return table


def _motion_table(motions: tuple[MotionQuality, ...]) -> Table:
    table = Table(
        "clip",
        "limbs",
        "hands, feet",
        "palms",
        "head",
        "facing",
        "feet",
        "slide",
        title="Motion compared with its source",
    )
    for motion in motions:
        cells = (
            f"{motion.limb_degrees:.1f}°",
            _measured(motion.worst_reach, "{:.0%}"),
            _measured(motion.worst_hand, "{:.0f}°"),
            _measured(motion.head_degrees, "{:+.0f}°"),
            _measured(motion.facing_degrees, "{:.0f}°"),
            _measured(motion.feet_height, "{:+.3f} m"),
            _measured(motion.slide, "{:.2f} m/s"),
        )
        table.add_row(motion.name, *cells)
    return table


def _joints(found: Check) -> str:
    """How many joints the motion moves, and the first of those that it leaves still; the mapping file has all."""
    moved = f"The motion moves {amount(len(found.matched), 'joint')}"
    if not found.unmatched:
        return f"{moved}, all that have skin."
    few = ", ".join(found.unmatched[:FEW])
    more = len(found.unmatched) - FEW
    others = amount(more, "other")
    return f"{moved}, and not {few}{f' and {others}' if more > 0 else ''}; the mapping file names all."


def _measured(value: float | None, shape: str) -> str:
    return "" if value is None else shape.format(value)
