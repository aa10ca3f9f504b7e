"""mua-teach: the images of a capture become a teacher that mua-bake distils."""

import os
from typing import Any

from mua.baking.teach import teach
from mua.cli.console import printer, say
from mua.cli.display import Display
from mua.cli.failure import run_command
from mua.cli.options import command_options, lent_by


@lent_by(teach, command_options(teach))
def main(**options: Any) -> None:
    """Train a teacher on the videos of CAPTURE: how a person's body and clothes look in any motion.

    Images of a camera that is held out are written to the folder 'progress' of the output while it trains. To resume
    an interrupted run, give the same command again. Start it with torchrun to train in several processes.
    """
    first = os.environ.get("RANK", "0") == "0"
    console = printer(quiet=not first)  # of several processes, only the first prints
    with Display(console) as display:
        folder = teach(**options, listener=display)
    say(console, f"{folder}: the teacher; mua-bake --teacher {folder} --motion FILES makes an avatar of it")


def run() -> None:
    """Entry point of the command."""
    run_command(main)


if __name__ == "__main__":
    run()
