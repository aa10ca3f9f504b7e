"""How many threads numpy's matrix products take. Those of OpenBLAS wait for the next product with their cores busy."""

import ctypes
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from numpy.linalg import _umath_linalg

# What OpenBLAS names its calls in numpy's own packages, and where it belongs to the system.
NAMES = ("scipy_openblas_{}_num_threads64_", "openblas_{}_num_threads64_", "openblas_{}_num_threads")


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Compute matrix products in the thread that asks for them; does nothing where numpy has another library.

    For work whose products are small, or that keeps the cores busy with threads of its own.
    """
    calls = openblas()
    if calls is None:
        yield
        return
    get, put = calls
    threads = get()
    put(1)
    try:
        yield
    finally:
        put(threads)


def openblas() -> tuple[Callable[[], int], Callable[[int], None]] | None:
    """How to ask for the number of threads and to change it."""
    library = ctypes.CDLL(_umath_linalg.__file__)  # which finds what it is linked with
    for name in NAMES:
        if hasattr(library, name.format("set")):
            return getattr(library, name.format("get")), getattr(library, name.format("set"))
    return None
