"""What pages show."""

import re
from pathlib import Path


def python_blocks(page: Path) -> list[str]:
    """The Python code that a page shows."""
    return re.findall(r"^```python\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE)
