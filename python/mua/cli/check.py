"""What `mua-bake --check` prints."""

from pathlib import Path

from rich.console import Console
from rich.table import Table

from mua.baking.check import Check, check, write_json
from mua.baking.settings import BakeSettings
from mua.cli.console import printer, say
from mua.cli.display import Display
from mua.fidelity.compare import Fidelity
from mua.files.write import require_writable
from mua.motion.quality import MotionQuality

FEW = 5  # joints that are named


def check_and_show(settings: BakeSettings, json: Path | None) -> None:
    """Check a character and its motion and print what was found."""
    if json is not None:
        require_writable(json)
    console = printer()
    with Display(console) as display:
        found = check(settings, display)
    if json is not None:
        write_json(json, settings, found)
    show(console, found)
    if json is not None:
        say(console, str(json))


def show(console: Console, found: Check) -> None:
    """Print what looks wrong, then the figures, what readers changed, how many joints move, and the files written."""
    for sentence in found.warnings:
        say(console, f"Look at this: {sentence}")
    if not found.warnings:
        say(console, "Nothing looks wrong.")
    if found.fidelity is not None:
        console.print(_fidelity_table(found.fidelity))
    if any(motion.limbs for motion in found.motions):
        console.print(_motion_table(found.motions))
    elif found.motions:
        brought = found.matched or found.unmatched  # by a motion file
        whose = (
            "Clips of the motion (it moves no arm or leg, so nothing is measured)"
            if brought
            else "The character's own clips"
        )
        say(console, f"{whose}: {', '.join(motion.name for motion in found.motions)}")
    for sentence in found.notes:
        say(console, sentence)
    if found.matched or found.unmatched:
        say(console, _joints(found))
    for path in found.written:
        say(console, str(path))


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
    moved = f"The motion moves {len(found.matched)} joints"
    if not found.unmatched:
        return f"{moved}, all that have skin."
    few = ", ".join(found.unmatched[:FEW])
    more = len(found.unmatched) - FEW
    return f"{moved}, and not {few}{f' and {more} others' if more > 0 else ''}; the mapping file names all."


def _measured(value: float | None, shape: str) -> str:
    return "" if value is None else shape.format(value)
