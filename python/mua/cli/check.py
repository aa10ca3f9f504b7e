"""What `mua-bake --check` prints."""

from pathlib import Path

from rich.console import Console
from rich.table import Table

from mua.baking.check import Check, check, write_json
from mua.baking.order import Order
from mua.cli.console import printer, say
from mua.cli.display import Display
from mua.fidelity.compare import Fidelity
from mua.files import require_writable
from mua.motion.quality import MotionQuality


def check_and_show(order: Order, json: Path | None) -> None:
    """Check a character and its motion and print what was found."""
    if json is not None:
        require_writable(json)
    console = printer()
    with Display(console) as display:
        found = check(order, display)
    if json is not None:
        write_json(json, order, found)
    show(console, found)
    if json is not None:
        say(console, str(json))


def show(console: Console, found: Check) -> None:
    """Print the tables, then notes and warnings, then the files written."""
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
    if found.matched:
        pairs = ", ".join(f"{pair.target} < {pair.source}" for pair in found.matched)
        say(console, f"Joints moved by the motion ({len(found.matched)}): {pairs}")
    if found.unmatched:
        say(
            console,
            f"Skinned joints that the motion does not move ({len(found.unmatched)}): {', '.join(found.unmatched)}",
        )
    for sentence in (*found.notes, *found.warnings):
        say(console, sentence)
    for path in found.written:
        say(console, str(path))


def _fidelity_table(fidelity: Fidelity) -> Table:
    table = Table("pose", "overlap", "inside", "worst at", "seen from", title="Splats compared with the source, unlit")
    for pose in fidelity.poses:
        seen, worst = pose.agreement, pose.worst
        table.add_row(pose.pose, f"{100 * seen.iou:.1f} %", f"{seen.psnr:.1f} dB", worst.joint, worst.view)
    return table


def _motion_table(motions: tuple[MotionQuality, ...]) -> Table:
    table = Table("clip", "limbs", "hands, feet", "facing", "feet", "slide", title="Motion compared with its source")
    for motion in motions:
        cells = (
            f"{motion.limb_degrees:.1f}°",
            _measured(motion.worst_reach, "{:.0%}"),
            _measured(motion.facing_degrees, "{:.0f}°"),
            _measured(motion.feet_height, "{:+.3f} m"),
            _measured(motion.slide, "{:.2f} m/s"),
        )
        table.add_row(motion.name, *cells)
    return table


def _measured(value: float | None, shape: str) -> str:
    return "" if value is None else shape.format(value)
