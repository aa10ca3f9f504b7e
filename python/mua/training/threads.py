"""Work on several threads of this process: numpy and torch leave Python's lock while they compute."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_EXCEPTION, Future, ThreadPoolExecutor, wait
from itertools import islice
from typing import TypeVar

A = TypeVar("A")
B = TypeVar("B")


def in_order(work: Callable[[A], B], items: Iterable[A], *, threads: int) -> Iterator[B]:
    """Results of `work` in the order of the items; no more of them are in memory than threads are busy."""
    items = iter(items)
    with ThreadPoolExecutor(threads) as pool:
        pending: deque[Future[B]] = deque(pool.submit(work, item) for item in islice(items, threads))
        while pending:
            result = pending.popleft().result()
            pending.extend(pool.submit(work, item) for item in islice(items, 1))
            yield result


def while_next(work: Callable[[A], B], items: Iterable[A]) -> Iterator[B]:
    """Results of `work` in the order of the items, in another thread while the next item is made in this one."""
    with ThreadPoolExecutor(1) as pool:
        at_work: Future[B] | None = None
        for item in items:
            if at_work is not None:
                yield at_work.result()
            at_work = pool.submit(work, item)
        if at_work is not None:
            yield at_work.result()


def together(tasks: Sequence[Callable[[], None]], *, stop: Callable[[], None], threads: int) -> None:
    """Run tasks in their order, so many at once, and raise the first error of any.

    `stop` is called then, and on an interrupt: it has to make those that run end, which is waited for; others do not
    begin.
    """
    with ThreadPoolExecutor(threads) as pool:
        futures = [pool.submit(task) for task in tasks]
        try:
            ended, _ = wait(futures, return_when=FIRST_EXCEPTION)
            for future in ended:
                future.result()
        except BaseException:
            stop()
            pool.shutdown(wait=False, cancel_futures=True)
            raise
