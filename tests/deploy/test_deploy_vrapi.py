"""Figures come out of the compositor's lines, of either format and with keys missing."""

from fake_headset import unity, vrapi

from mua.deploy.bench import Benched, warnings
from mua.deploy.vrapi import FIGURES, parse

OLDER = (
    "FPS=71,Prd=47ms,Tear=0,Early=0,Stale=3,VSnc=1,CPU4/GPU=3/2,1651/414MHz,PSM=0,PLS=1,Temp=36.0C/0.0C,TW=2.13ms,"
    "App=6.91ms"
)


def benched(samples: list[dict[str, float]], seconds: int) -> Benched:
    return Benched("hero", "A", "Quest 3", 72, seconds, samples)


def test_reads_every_figure() -> None:
    assert parse(vrapi()) == {
        "fps": 72,
        "target": 72,
        "app_ms": 4.49,
        "timewarp_ms": 1.25,
        "stale": 0,
        "gpu_percent": 43,
        "cpu_level": 4,
        "gpu_level": 4,
        "temperature": 32.2,
        "power_state": 0,
    }


def test_reads_the_older_format() -> None:
    found = parse(vrapi(OLDER))
    assert found["fps"] == 71
    assert (found["stale"], found["cpu_level"], found["gpu_level"], found["app_ms"]) == (3, 3, 2, 6.91)
    assert set(FIGURES) - set(found) == {"target", "gpu_percent"}


def test_reads_other_tag_formats_and_cores() -> None:
    assert parse("I VrApi: FPS=60/90,CPU5/GPU=6/5,App=--") == {"fps": 60, "target": 90, "cpu_level": 6, "gpu_level": 5}


def test_ignores_lines_of_others() -> None:
    assert parse(unity("FPS=72/72,App=1ms")) == {}
    assert parse(vrapi("GPU is busy")) == {}
    assert parse("") == {}


def test_figures_are_minimum_median_and_95th_percentile() -> None:
    spreads = benched([{"app_ms": float(ms)} for ms in range(101)] + [{"fps": 72.0}], 102).figures()
    assert set(spreads) == {"app_ms", "fps"}
    assert (spreads["app_ms"].minimum, spreads["app_ms"].median, spreads["app_ms"].high) == (0, 50, 95)


def test_warns_of_throttling_and_of_few_samples() -> None:
    warned = " ".join(warnings(benched([parse(vrapi(OLDER))] * 7, 10)))
    for part in ("only 7 of 10 seconds", "cpu level fell to 3", "gpu level fell to 2", "power state left normal"):
        assert part in warned
    assert warnings(benched([parse(vrapi())] * 8, 10)) == []
