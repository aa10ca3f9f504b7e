"""The processes that distil one student together: which frames each holds, and what they exchange.

Data-parallel training as in Li et al. 2020, https://arxiv.org/abs/2006.15704, through torch's own
DistributedDataParallel; `torchrun` starts the processes and says through the environment which one each is.
"""

import os
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import timedelta
from typing import TypeVar

import torch
import torch.distributed as dist
from torch import Tensor, nn
from torch.nn.parallel import DistributedDataParallel

from mua.errors import InputError

TIMEOUT = timedelta(minutes=10)  # longer than the computation between two exchanges
BARRIER_TIMEOUT = timedelta(days=7)  # for others to record their parts; a process that ends is noticed at once
HALVES = 2  # parts in which a single process computes a batch, so that it adds up the same numbers as two processes
# Texts of gloo's and NCCL's errors that occur only where a process is gone or silent.
LOST = (
    *("Connection closed", "Connection reset", "Broken pipe", "ncclRemoteError"),
    *("Timed out", "wait timeout", "Socket Timeout", "collective operation timeout", "Application timeout"),
)

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Share:
    """One process's part of a batch that is drawn for all of them."""

    rows: Tensor  # [B'] at least one
    held: range  # the frames that contain them
    weight: float  # weight of their mean loss, so that the average over the processes is the mean over the whole batch


@dataclass(frozen=True)
class Processes:
    """One of `count` processes; alone, there is nothing to exchange, and batches are computed half by half."""

    rank: int
    count: int

    @property
    def first(self) -> bool:
        """Whether this process writes and reports."""
        return self.rank == 0

    def place(self, device: torch.device) -> torch.device:
        """The device of this process: of several GPUs each process takes its own.

        Raises InputError where the machine has fewer GPUs than processes.
        """
        if self.count == 1 or device.type != "cuda":
            return device
        local, there = int(os.environ["LOCAL_RANK"]), torch.cuda.device_count()
        if local >= there:
            raise InputError(f"--nproc-per-node {os.environ['LOCAL_WORLD_SIZE']}: this machine has {there} GPUs")
        torch.cuda.set_device(local)
        return torch.device("cuda", local)

    def held(self, frames: int) -> range:
        """The frames that this process holds: every `count`-th; one of another's where there are too few frames."""
        return range(self.rank % max(frames, 1), frames, self.count)

    def parts(self, frames: int) -> list[range]:
        """The frames that this process computes, those of a range together."""
        if self.count > 1:
            return [self.held(frames)]
        return [range(half, frames, HALVES) for half in range(min(HALVES, frames))]

    def shares(
        self,
        rows: Tensor,  # [B] the whole batch, equal in all processes
        *,
        frames: int,  # number of frames that `rows` are drawn from
    ) -> list[Share]:
        """This process's shares of a batch; where it holds none of it, one row of weight 0."""
        shares = []
        for rest, part in enumerate(self.parts(frames), start=self.rank):
            own = rows[rows % part.step == rest]
            if len(own):
                shares.append(Share(own, part, len(own) * self.count / len(rows)))
        held = self.held(frames)
        return shares or [Share(torch.full((1,), held.start), held, 0.0)]

    def mean_loss(
        self,
        rows: Tensor,  # [B] the whole batch, equal in all processes
        loss: Callable[[Share], Tensor],  # the mean over the share's rows
        *,
        frames: int,  # number of frames that `rows` are drawn from
    ) -> Tensor:
        """This process's part of the mean loss over a batch, which is the average of all parts."""
        return torch.stack([share.weight * loss(share) for share in self.shares(rows, frames=frames)]).sum()

    def channels(self, count: int) -> range:
        """The channels out of `count` that this process solves for; see `owner`."""
        return range(self.rank, count, self.count)

    def owner(self, channel: int) -> int:
        """The rank that solves for a channel."""
        return channel % self.count

    def wrap(self, module: nn.Module) -> nn.Module:
        """`module` with its gradients averaged over all processes; all start from the first one's weights."""
        if self.count == 1:
            return module
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FutureWarning)  # deprecated in torch 2.13 for a name that 2.4 lacks
            return DistributedDataParallel(module, broadcast_buffers=False)

    @torch.no_grad()
    def broadcast(self, *tensors: Tensor, source: int = 0) -> None:
        """Copy `tensors` of the process of rank `source` to all processes, in place; shapes are the same everywhere."""
        if self.count == 1:
            return
        for tensor in tensors:
            sent = tensor.detach().contiguous()
            dist.broadcast(sent, src=source)
            tensor.copy_(sent)

    def broadcast_object(self, value: T) -> T:
        """Send `value` of the first process, anything that pickles, to all processes."""
        if self.count == 1:
            return value
        kept = [value]
        dist.broadcast_object_list(kept, src=0, device=torch.device("cpu"))
        return kept[0]

    def barrier(self) -> Callable[[], None]:
        """A function that returns when all processes have called it, however long that takes."""
        if self.count == 1:
            return lambda: None
        group = dist.new_group(backend="gloo", timeout=BARRIER_TIMEOUT)

        def wait() -> None:
            dist.barrier(group)

        return wait

    def mean(self, value: Tensor) -> float:
        """The average of a scalar over all processes."""
        if self.count == 1:
            return float(value.detach())
        total = value.detach().to("cpu", copy=True)
        dist.all_reduce(total)
        return float(total) / self.count


ALONE = Processes(0, 1)


@contextmanager
def joined(timeout: timedelta = TIMEOUT) -> Iterator[Processes]:
    """The processes that torchrun started together with this one; ALONE where it did not.

    Within the block, a process that ends or does not answer for `timeout` raises an InputError in all others; every
    InputError names its process.
    """
    count = int(os.environ.get("WORLD_SIZE", "1")) if "RANK" in os.environ else 1
    if count == 1:
        yield ALONE
        return
    rank = int(os.environ["RANK"])
    backend = "cpu:gloo,cuda:nccl" if torch.cuda.is_available() and dist.is_nccl_available() else "gloo"
    try:
        dist.init_process_group(backend, timeout=timeout)
        yield Processes(rank, count)
        dist.destroy_process_group()  # not after an error: it may wait for the dead
    except InputError as error:
        raise InputError(f"process {rank + 1} of {count}: {error}") from error
    except RuntimeError as error:
        if not another_ended(error):
            raise
        raise InputError(
            f"process {rank + 1} of {count}: another process has ended or not answered for "
            f"{timeout.total_seconds():.0f} s; start all again to resume from the last checkpoint"
        ) from error


def another_ended(error: RuntimeError) -> bool:
    """Whether torch says that another process is gone or silent, and not that this one did something wrong."""
    return isinstance(error, dist.DistNetworkError) or any(word in str(error) for word in LOST)
