"""Imported first, takes `mua` of this checkout, whichever is installed: generators write beside what they read."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))
