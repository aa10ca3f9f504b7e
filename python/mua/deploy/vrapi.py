"""The line that the compositor of a Quest writes to the log each second."""

import re

LINE = re.compile(r"\bVrApi\b.*?\b(FPS=.*)")
PAIR = re.compile(r"([A-Za-z][\w&%/]*)=([^,]*)")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")

# Figure: its key in the line, which number of the value, and the factor to its unit.
FIGURES = {
    "fps": ("FPS", 0, 1),
    "target": ("FPS", 1, 1),
    "app_ms": ("App", 0, 1),
    "timewarp_ms": ("TW", 0, 1),
    "stale": ("Stale", 0, 1),
    "gpu_percent": ("GPU%", 0, 100),
    "cpu_level": ("CPU/GPU", 0, 1),
    "gpu_level": ("CPU/GPU", 1, 1),
    "temperature": ("Temp", 0, 1),
    "power_state": ("PLS", 0, 1),
}


def parse(line: str) -> dict[str, float]:
    """The figures in a line of the log; empty for lines of other programs."""
    found = LINE.search(line)
    if found is None:
        return {}
    # The first key names the CPU core that was measured, which depends on the headset: CPU4/GPU=2/2.
    values = {re.sub(r"^CPU\d+/", "CPU/", key): NUMBER.findall(value) for key, value in PAIR.findall(found[1])}
    return {
        figure: float(values[key][at]) * factor
        for figure, (key, at, factor) in FIGURES.items()
        if len(values.get(key, [])) > at
    }
