"""Characters from USD."""
from pathlib import Path
from mua.rig.assemble import Surfaces
def read_usd(path: Path) -> Surfaces:
    raise NotImplementedError
