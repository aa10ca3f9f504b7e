"""What an entry of a comparison costs: the paper's right-hand columns."""

from dataclasses import dataclass
from pathlib import Path

from mua.asset.avatar import Avatar
from mua.asset.count import flops, parameters
from mua.asset.read import load
from mua.asset.summary import storage_of

FLOAT = 4  # bytes of a system's number; avatar files count as stored


@dataclass(frozen=True)
class Cost:
    """None where a column does not apply."""

    parameters: int | None = None
    flops: int | None = None  # of a frame; posing and drawing excluded
    bytes: int | None = None  # of the file, or 4 a parameter
    fps: float | None = None  # of the player on this device; decoding, posing and drawing included
    storage: str = ""  # f32, f16, i8 or packed, of a file

    def within(self, other: "Cost") -> bool:
        """Whether neither parameters nor operations are more than another's; what is not known is not within."""
        known = (self.parameters, self.flops, other.parameters, other.flops)
        if None in known:
            return False
        own_parameters, own_flops, most_parameters, most_flops = (count or 0 for count in known)
        return own_parameters <= most_parameters and own_flops <= most_flops


def file_cost(path: Path, avatar: Avatar, *, fps: float | None = None) -> Cost:
    """Of an avatar file."""
    return Cost(
        parameters=sum(parameters(avatar).values()),
        flops=sum(flops(avatar).values()),
        bytes=path.stat().st_size,
        fps=fps,
        storage=storage_of(load(path)),
    )


def learnt_cost(parameters: int, flops: int) -> Cost:
    """Of what was trained and is in no file."""
    return Cost(parameters=parameters, flops=flops, bytes=FLOAT * parameters)
