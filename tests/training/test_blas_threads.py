"""The threads of numpy's matrix products."""

import numpy as np
import pytest

from mua.training.blas_threads import one_blas_thread, openblas


@pytest.fixture(autouse=True)
def two() -> None:
    """Two threads, as on a machine of two cores."""
    calls = openblas()
    if calls is None:
        blas = np.show_config(mode="dicts")["Build Dependencies"]["blas"]["name"]
        assert "openblas" not in blas
        pytest.skip(f"numpy with OpenBLAS, not {blas}")
    calls[1](2)


def threads() -> int:
    calls = openblas()
    assert calls is not None
    return calls[0]()


def test_products_have_one_thread_within_the_block_and_as_many_as_before_after_it() -> None:
    with one_blas_thread():
        assert threads() == 1
    assert threads() == 2


def test_an_error_gives_threads_back() -> None:
    with pytest.raises(ZeroDivisionError), one_blas_thread():
        raise ZeroDivisionError
    assert threads() == 2
