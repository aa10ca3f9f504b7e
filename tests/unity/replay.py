"""Replays on a device what the stand-ins recorded of the Unity package: its buffers, uploads and dispatches, in order.

A recording is NAME.json, one event in a line, and NAME.bin, the uploaded bytes. Events: `buffer` (count, stride,
target), `name`, `upload` (start in the buffer; offset in the binary, bytes), `copy` (source), `dispatch` (shader,
kernel, groups or indirect, buffers and constants bound by name then), `draw` (shader, pass, counts or indirect, what
was bound), `keep` (a label for what a buffer holds), `release`, `note`. A draw is kept with what its buffers held, for
who knows the target.
"""

import base64
import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.gpu import Buffer, Commands, Device
from mua.gpu.kernel import Kernel
from mua.gpu.reflect import Constant

INDIRECT_ARGUMENTS, STRUCTURED = 256, 16  # GraphicsBuffer.Target
MOST_GROUPS = 65535  # the most groups of a dispatch along an axis
KINDS = {"Int": np.int32, "Float": np.float32, "Vector": np.float32, "Matrix": np.float32}
SCALARS = {"Int": ("uint", "int"), "Float": ("float",), "Vector": ("float",), "Matrix": ("float",)}


@dataclass(frozen=True)
class Drawn:
    """A draw of triangles, with what its buffers held."""

    shader: str
    pass_index: int
    arguments: tuple[int, int]  # vertices or indices, instances
    indirect: bool  # whether the device was to take them from a buffer
    buffers: dict[str, Array]  # by name, words
    strides: dict[str, int]  # by name, bytes of an element
    constants: dict[str, tuple[str, str]]  # by name, kind and content
    indices: Array | None = None  # corners of triangles, where the draw is indexed

    @property
    def corners(self) -> int:
        """Vertices of a splat."""
        return int(np.frombuffer(base64.b64decode(self.constants["corners"][1]), KINDS["Int"])[0])


@dataclass
class Replayed:
    """What a recording did."""

    kept: dict[str, Array] = field(default_factory=dict)  # by label, words
    kernels: list[str] = field(default_factory=list)  # in order
    draws: list[Drawn] = field(default_factory=list)


class _Player:
    def __init__(self, device: Device, content: bytes) -> None:
        self.device, self.content, self.result = device, content, Replayed()
        self.buffers: dict[int, Buffer] = {}
        self.targets: dict[int, int] = {}
        self.strides: dict[int, int] = {}
        self.commands: Commands | None = None

    def flush(self) -> None:
        """Run what was dispatched so far: uploads and reads come after it."""
        if self.commands is not None:
            self.commands.submit()
            self.commands = None

    def buffer(self, event: dict[str, Any]) -> None:
        size, indirect = event["count"] * event["stride"], bool(event["target"] & INDIRECT_ARGUMENTS)
        garbage = np.full(-(-size // 4), 0x7FC12345, np.uint32)  # Unity clears nothing; as a float it is no number
        self.buffers[event["buffer"]] = self.device.buffer(garbage, name=str(event["buffer"]), indirect=indirect)
        self.strides[event["buffer"]], self.targets[event["buffer"]] = event["stride"], event["target"]
        assert not (indirect and event["target"] & STRUCTURED), "Direct3D 11 refuses structured arguments"

    def name(self, event: dict[str, Any]) -> None:
        self.buffers[event["buffer"]].name = event["name"]

    def upload(self, event: dict[str, Any]) -> None:
        self.flush()
        data = np.frombuffer(self.content, np.uint8, event["bytes"], event["offset"])
        self.buffers[event["buffer"]].write(data, event["start"])

    def copy(self, event: dict[str, Any]) -> None:
        self.flush()
        self.buffers[event["buffer"]].write(self.buffers[event["source"]].read())

    def dispatch(self, event: dict[str, Any]) -> None:
        kernel = self.device.kernel(event["shader"], event["kernel"])
        self.result.kernels.append(kernel.name)
        bound = {slot.name: self._bound(kernel, event, slot.name, slot.stride) for slot in kernel.buffers}
        constants = {
            name: value(kernel.name, constant, *event["constants"][name])
            for name, constant in kernel.constants.items()
            if constant.used and name in event["constants"]
        }
        groups = self._groups(kernel, *event["indirect"]) if "indirect" in event else tuple(event["groups"])
        self.commands = self.commands or self.device.commands()
        self.commands.dispatch(kernel, groups, bound, **constants)

    def draw(self, event: dict[str, Any]) -> None:
        self.flush()
        numbers = {**event["buffers"], **event.get("block_buffers", {})}
        counts: Any = event.get("vertices"), event.get("instances")
        if "indirect" in event:
            number, offset = event["indirect"]
            counts = self.buffers[number].read()[offset // 4 :][:2].tolist()
        self.result.draws.append(
            Drawn(
                shader=event["shader"],
                pass_index=event["pass"],
                arguments=(counts[0], counts[1]),
                indirect="indirect" in event,
                buffers={name: self.buffers[number].read() for name, number in numbers.items()},
                strides={name: self.strides[number] for name, number in numbers.items()},
                constants={**event["constants"], **event.get("block_constants", {})},
                indices=self.buffers[event["indices"]].read() if "indices" in event else None,
            )
        )

    def keep(self, event: dict[str, Any]) -> None:
        self.flush()
        self.result.kept[event["label"]] = self.buffers[event["buffer"]].read()

    def note(self, event: dict[str, Any]) -> None:
        """What the engine was at, which changes nothing."""

    def release(self, event: dict[str, Any]) -> None:
        self.flush()
        del self.buffers[event["buffer"]]

    def _groups(self, kernel: Kernel, number: int, offset: int) -> tuple[int, int, int]:
        """What a buffer holds by now. A device that is given garbage for counts may be busy for hours."""
        self.flush()
        first, second, third = self.buffers[number].read()[offset // 4 :][:3].tolist()
        assert max(first, second, third) <= MOST_GROUPS, (
            f"{kernel.name}: is dispatched in {first}, {second}, {third} groups"
        )
        return first, second, third

    def _bound(self, kernel: Kernel, event: dict[str, Any], name: str, stride: int) -> Buffer:
        """The buffer of a name; Unity asks for the stride of the shader's elements."""
        assert name in event["buffers"], f"{kernel.name}: the buffer {name} was never set"
        number = event["buffers"][name]
        assert self.targets[number] & STRUCTURED, f"{kernel.name}: {name} is no structured buffer"
        assert self.strides[number] == stride, f"{kernel.name}: {name} has stride {self.strides[number]}, not {stride}"
        return self.buffers[number]


def replay(device: Device, recording: Path) -> Replayed:
    """Run a recording; an AssertionError or InputError says what Unity would have refused or done wrong."""
    player = _Player(device, recording.with_suffix(".bin").read_bytes())
    for line in recording.with_suffix(".json").read_text().splitlines():
        event = json.loads(line)
        getattr(player, event["event"])(event)
    player.flush()
    return player.result


def value(label: str, constant: Constant, kind: str, content: str) -> Any:
    """What a Set... call leaves in a constant: a vector is cut to its size, integers keep their bits."""
    where = f"{label}: the constant {constant.name} of {constant.scalar} {constant.shape}"
    assert constant.scalar in SCALARS[kind], f"{where} was set as {kind}"
    values = np.frombuffer(base64.b64decode(content), KINDS[kind])
    if constant.scalar == "uint":
        values = values.view(np.uint32)
    if kind == "Matrix":
        values = values.reshape(-1, 4, 4).transpose(0, 2, 1).reshape(-1)  # Unity's memory is column by column
    count = int(np.prod(constant.shape, dtype=int))
    if kind == "Vector" and len(constant.shape) == 1:
        values = values[:count]
    assert len(values) == count, f"{where} was set to {len(values)} values"
    assert kind == "Matrix" or len(constant.shape) < 2 or constant.shape[-1] == 4, f"{where} has gaps between its rows"
    return values.reshape(constant.shape) if constant.shape else values[0]
