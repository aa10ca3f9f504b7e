"""The dispatches of ComputeShaders/splat_sort.compute, for tests of the kernels alone."""

import numpy as np

from mua.arrays import Array
from mua.gpu import Buffer, Commands, Device
from mua.kernels.splat_sort import DIGIT_BITS, KEY_BITS

BLOCK = 2048  # keys that one group takes
DIGITS = 1 << DIGIT_BITS
DISPATCH_OFFSET = 16  # bytes into `arguments`


def append_sort(
    commands: Commands,
    device: Device,
    keys: Buffer,  # [capacity]
    values: Buffer,  # [capacity]
    arguments: Buffer,  # [8]; words 4-6 the groups, word 7 how many keys
) -> tuple[Buffer, Buffer]:
    """Append the sort of keys and values; returns the buffers that will hold them in order."""
    counts = device.buffer(keys.size // 4 // BLOCK * DIGITS * 4 + DIGITS * 4, name="digit_counts")
    totals = device.buffer(DIGITS * 4, name="digit_totals")
    table = {"digit_counts": counts, "arguments": arguments}
    for shift in range(0, KEY_BITS, DIGIT_BITS):
        ordered = device.buffer(keys.size, name="sorted_keys"), device.buffer(values.size, name="sorted_values")
        count = device.kernel("splat_sort.compute", "CountDigits")
        commands.dispatch_indirect(count, arguments, DISPATCH_OFFSET, {"keys": keys, **table}, shift=shift)
        scan = device.kernel("splat_sort.compute", "ScanDigits")
        commands.dispatch(scan, (DIGITS, 1, 1), {"digit_totals": totals, **table})
        scatter = device.kernel("splat_sort.compute", "ScatterDigits")
        moved = {"keys": keys, "values": values, "sorted_keys": ordered[0], "sorted_values": ordered[1]}
        commands.dispatch_indirect(
            scatter, arguments, DISPATCH_OFFSET, {**moved, "digit_totals": totals, **table}, shift=shift
        )
        keys, values = ordered
    return keys, values


def sort_keys(
    device: Device,
    keys: Array,  # [M] 16 bits each
) -> tuple[Array, Array]:
    """The keys in order, and their order: indices into them, [M] uint32 each."""
    groups = -(-len(keys) // BLOCK)
    arguments = np.array([0, 1, 0, 0, groups, 1, 1, len(keys)], dtype=np.uint32)
    commands = device.commands()
    ordered = append_sort(
        commands,
        device,
        device.buffer(keys.astype(np.uint32), name="keys"),
        device.buffer(np.arange(len(keys), dtype=np.uint32), name="values"),
        device.buffer(arguments, name="arguments", indirect=True),
    )
    commands.submit()
    return ordered[0].read(), ordered[1].read()
