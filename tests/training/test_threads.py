"""Threads of one process: results stay in order, errors end all."""

import threading
import time
from collections.abc import Iterator
from functools import partial

import pytest

from mua.training.threads import in_order, together, while_next


def test_results_come_in_the_order_of_the_items() -> None:
    def later_first(item: int) -> int:
        time.sleep(0.02 if item % 3 == 0 else 0.0)
        return item * item

    assert list(in_order(later_first, range(10), threads=3)) == [item * item for item in range(10)]
    assert list(in_order(later_first, [], threads=3)) == []


def test_no_more_items_are_taken_than_threads_are_busy() -> None:
    taken = []

    def items() -> Iterator[int]:
        for item in range(10):
            taken.append(item)
            yield item

    ahead = [len(taken) - done for done, _ in enumerate(in_order(lambda item: item, items(), threads=2))]
    assert len(ahead) == 10
    assert max(ahead) <= 3  # the one given back, and one for each thread


def test_items_are_worked_on_at_once() -> None:
    meet = threading.Barrier(2, timeout=60)
    assert list(in_order(lambda _: meet.wait() >= 0, range(2), threads=2)) == [True, True]


def test_the_next_item_is_made_while_one_is_worked_on() -> None:
    begun, made = threading.Event(), threading.Event()

    def items() -> Iterator[int]:
        yield 1
        assert begun.wait(60)
        made.set()
        yield 2

    def work(item: int) -> int:
        begun.set()
        assert made.wait(60)
        return item * item

    assert list(while_next(work, items())) == [1, 4]
    assert list(while_next(work, [])) == []


def test_an_error_in_the_other_thread_ends_what_makes_items() -> None:
    made = []

    def items() -> Iterator[int]:
        for item in range(10):
            made.append(item)
            yield item

    def fail(item: int) -> None:
        raise ValueError(f"no room for {item}")

    with pytest.raises(ValueError, match="no room for 0"):
        list(while_next(fail, items()))
    assert made == [0, 1]


def test_the_first_error_ends_all_tasks() -> None:
    stop = threading.Event()

    def fail() -> None:
        raise ValueError("no room")

    with pytest.raises(ValueError, match="no room"):
        together([lambda: assert_set(stop), fail], stop=stop.set, threads=2)


def test_tasks_beyond_the_threads_wait_and_do_not_begin_after_an_error() -> None:
    begun: list[str] = []

    def fail() -> None:
        raise ValueError("no room")

    together([partial(begun.append, name) for name in ("one", "two", "three")], stop=lambda: None, threads=1)
    assert begun == ["one", "two", "three"]
    with pytest.raises(ValueError, match="no room"):
        together([fail, *[partial(time.sleep, 0.05)] * 4, partial(begun.append, "late")], stop=lambda: None, threads=1)
    assert begun == ["one", "two", "three"]


def assert_set(stop: threading.Event) -> None:
    assert stop.wait(60)
