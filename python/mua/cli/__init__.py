"""The commands."""

import os
import sys
from types import TracebackType

# Threads of torch that wait for each other sleep instead of spinning: on a machine that does anything else beside a
# bake, spinning makes short parallel loops many times slower. Read once, when torch is loaded.
os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")


def _report(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Report an error; Ctrl-C while a command is being imported ends it as quietly as later."""
    if not issubclass(kind, KeyboardInterrupt):
        sys.__excepthook__(kind, error, trace)


sys.excepthook = _report
