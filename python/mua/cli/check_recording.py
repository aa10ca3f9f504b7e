"""What `mua-train --check` prints of a recording."""

from pathlib import Path

from rich.console import Console
from rich.table import Table

from mua.baking.contact_sheet import frames_picture
from mua.baking.recording_check import RecordingCheck, check
from mua.cli.console import printer, say
from mua.errors import InputError
from mua.files.write import replacing, require_writable
from mua.recording import RecordedClip, Recording


def check_recording(recording: Recording, picture: Path) -> None:
    """Print what a recording holds and what in it looks like a mistake, and draw three of its frames.

    Raises InputError where something in it is certainly a mistake: nothing should be trained on it.
    """
    require_writable(picture)
    console = printer()
    found = check(recording)
    console.print(_clips(recording.clips))
    _print(console, found)
    if found.pictured:
        with replacing(picture) as temporary:
            frames_picture(recording.rig, found.pictured).save(temporary, "PNG")
        say(console, str(picture))
    certain = [finding.sentence for finding in found.findings if finding.certain]
    if certain:
        raise InputError(f"recording {recording.directory}: {certain[0]}")


def _clips(clips: tuple[RecordedClip, ...]) -> Table:
    table = Table("clip", "frames", "seconds", "recorded", "held out", "complete")
    for clip in clips:
        seconds = f"{len(clip) / clip.rate:.1f}"
        marks = ("yes" if clip.held_out else "", "yes" if clip.complete else "no")
        table.add_row(clip.name, str(len(clip)), seconds, str(len(clip.recorded)), *marks)
    return table


def _print(console: Console, found: RecordingCheck) -> None:
    for name, figure in found.figures.items():
        say(console, f"{name:<8} {figure}")
    for finding in found.findings:
        say(console, f"{'mistake' if finding.certain else 'warning':<8} {finding.sentence}")
    if not found.findings:
        say(console, "no mistake in units or conventions was found; look at the image all the same")
