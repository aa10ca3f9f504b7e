"""The dispatches of ComputeShaders/splat_sort.compute, for tests of the kernels alone."""

import numpy as np

from mua.arrays import Array
from mua.gpu import Device
from mua.kernels.splat_project import pack_keys
from mua.kernels.splat_sort import DIGIT_BITS

BLOCK = 2048  # keys that one group takes
DIGITS = 1 << DIGIT_BITS
SCANNED = 16  # digits of a group of ScanDigits
INSTANCES = 3
CORNERS = 3
UNWRITTEN = 0xFFFFFFFF


def sort_keys(
    device: Device,
    keys: Array,  # [N] uint16
) -> tuple[Array, Array]:
    """The order [N] that the shader leaves, UNWRITTEN behind the visible ones, and the arguments [5]."""
    count = len(keys)
    groups = -(-count // BLOCK)
    counts = device.buffer(DIGITS * groups * 4, name="digit_counts")
    totals = device.buffer(DIGITS * 4, name="digit_totals")
    arguments = device.buffer(np.full(5, UNWRITTEN, np.uint32), name="arguments")
    element = device.buffer(np.full(count, UNWRITTEN, np.uint32), name="elements")
    order = device.buffer(np.full(count, UNWRITTEN, np.uint32), name="order")
    table = {"digit_counts": counts, "arguments": arguments}
    commands = device.commands()
    passes = (
        (device.buffer(pack_keys(np.append(keys, np.zeros(len(keys) % 2, keys.dtype))), name="keys"), element),
        (element, order),
    )
    for second_pass, (source, target) in enumerate(passes):
        constants = {"second_pass": second_pass, "key_count": count}
        count_digits = device.kernel("splat_sort.compute", "CountDigits")
        commands.dispatch(count_digits, (groups, 1, 1), {"keys": source, **table}, **constants)
        scan = device.kernel("splat_sort.compute", "ScanDigits")
        commands.dispatch(scan, (DIGITS // SCANNED, 1, 1), {"digit_totals": totals, **table}, **constants)
        scatter = device.kernel("splat_sort.compute", "ScatterDigits")
        moved = {"keys": source, "digit_totals": totals, **table, "sorted": target}
        commands.dispatch(scatter, (groups, 1, 1), moved, **constants, instances=INSTANCES, corners=CORNERS)
    commands.submit()
    return order.read(), arguments.read()
