"""Several processes distil the student that one distils, and none waits for one that is gone."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
import torch
from synthetic_student import bands_of_frames
from together import errors, start, trained

from mua.channels import GEOMETRY
from mua.student.subband_source import hold
from mua.training.processes import ALONE, Processes, another_ended
from mua.wavelets import Bands

State = dict[str, torch.Tensor]
Losses = dict[tuple[str, int], float | None]
# Of losses and, in the Euclidean norm, of each tensor. A batch's sum in another order differs by some 1e-7; every step
# of Adam, which divides by the gradient's own size, lets that grow.
ROUNDING = 1e-3


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of two processes by both recipes."""
    directory = tmp_path_factory.mktemp("pair")
    assert errors(start("compare", directory), "compare", directory) == ["", ""]
    return directory


@pytest.fixture
def one_thread() -> Iterator[None]:
    """As in the processes: sums of other lengths turn directions that hold only rounding."""
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(threads)


def result(directory: Path, name: str, rank: int) -> tuple[State, Losses]:
    state, losses = torch.load(directory / f"{name}.{rank}.pt")
    return state, losses


def identical(a: State, b: State) -> bool:
    return all(torch.equal(a[name], b[name]) for name in a)


def difference(a: State, b: State) -> float:
    """The largest of any tensor, relative to its norm."""
    pairs = [(a[name].double(), b[name].double()) for name in a]
    return max(float((x - y).norm() / x.norm().clamp(min=1e-30)) for x, y in pairs)


@pytest.mark.usefixtures("one_thread")
@pytest.mark.parametrize("name", ["closed form", "paper"])
def test_two_processes_train_the_student_of_one(pair: Path, tmp_path: Path, name: str) -> None:
    alone, losses = trained(name, tmp_path)
    state, together = result(pair, name, 0)
    assert identical(alone.state_dict(), state)
    steps = {step: loss for step, loss in losses.items() if loss is not None}
    assert len(steps) > 30
    for step, loss in steps.items():
        assert together[step] == loss
    for kept in (pair / name).glob("* bases.pt"):
        assert kept.stat().st_size > 1000
        ours, theirs = (torch.load(path)["state"] for path in (kept, tmp_path / kept.name))
        assert torch.equal(ours["flat"], theirs["flat"])  # channels are solved for in one process each: no sum is split
        names = [name for name in ours["branch"] if not name.startswith("mlp")]  # which comes to be later
        assert all(torch.equal(ours["branch"][name], theirs["branch"][name]) for name in names)


@pytest.mark.usefixtures("one_thread")
def test_three_processes_share_the_work_and_differ_by_rounding(tmp_path: Path) -> None:
    together = tmp_path / "three"
    assert errors(start("resumed", together, count=3), "resumed", together) == [""] * 3
    alone, _ = trained("quick", tmp_path)
    states = [result(together, "quick", rank)[0] for rank in range(3)]
    assert 0 < difference(alone.state_dict(), states[0]) < ROUNDING  # zero would mean that nothing was shared
    assert all(identical(states[0], state) for state in states[1:])


@pytest.mark.parametrize("name", ["closed form", "paper"])
def test_both_processes_end_with_the_same_bytes(pair: Path, name: str) -> None:
    assert identical(result(pair, name, 0)[0], result(pair, name, 1)[0])


def test_only_the_first_process_reports(pair: Path) -> None:
    assert result(pair, "closed form", 1)[1] == {}


@pytest.mark.parametrize(
    ("message", "ended"),
    [
        ("[../third_party/gloo/gloo/transport/tcp/pair.cc:534] Connection closed by peer [127.0.0.1]:3381", True),
        ("[../third_party/gloo/gloo/transport/tcp/unbound_buffer.cc:78] Timed out waiting 3000ms for recv", True),
        ("NCCL error in: ProcessGroupNCCL.cpp, ncclRemoteError: A call failed, possibly a process has exited", True),
        ("[enforce fail at ../third_party/gloo/gloo/allreduce.cc:101] ptr != nullptr", False),
        ("NCCL error in: ProcessGroupNCCL.cpp, ncclInvalidUsage: This usually reflects invalid usage", False),
        ("NCCL error in: ProcessGroupNCCL.cpp, ncclUnhandledCudaError: CUDA out of memory", False),
        ("CUDA error: the launch timed out and was terminated", False),
    ],
)
def test_only_what_another_process_causes_is_put_down_to_it(message: str, ended: bool) -> None:
    assert another_ended(RuntimeError(message)) == ended


@pytest.mark.usefixtures("one_thread")
def test_a_killed_process_ends_all_and_any_number_goes_on(pair: Path, tmp_path: Path) -> None:
    killed = tmp_path / "killed"
    first, _ = errors(start("killed", killed), "killed", killed)
    assert first.startswith("error: process 1 of 2: another process has ended")
    assert first.count("\n") == 1
    assert list((killed / "quick").glob("*.pt"))  # something to go on from
    shutil.copytree(killed, tmp_path / "alone")

    assert errors(start("resumed", killed), "resumed", killed) == ["", ""]
    state, again = result(killed, "quick", 0)
    undisturbed, losses = result(pair, "quick", 0)
    assert len(again) < len(losses)
    assert identical(state, undisturbed)

    alone, _ = trained("quick", tmp_path / "alone" / "quick")
    assert identical(undisturbed, alone.state_dict())


def test_a_silent_process_is_not_waited_for(tmp_path: Path) -> None:
    processes = start("silent", tmp_path)
    processes[0].join(timeout=60)
    processes[1].kill()
    first, _ = errors(processes, "silent", tmp_path)
    assert first.startswith("error: process 1 of 2: another process has ended or not answered for 3 s")
    assert first.count("\n") == 1


@pytest.mark.parametrize("count", [1, 2, 3, 7])
@pytest.mark.parametrize("rows", [[0], [4, 1], [3, 0, 4, 2, 1]])
def test_shares_of_a_batch_average_to_the_whole(count: int, rows: list[int]) -> None:
    values = torch.arange(5.0) ** 2
    batch = torch.tensor(rows)
    total = 0.0
    for rank in range(count):
        processes = Processes(rank, count)
        for share in processes.shares(batch, frames=5):
            assert set(share.rows.tolist()) <= set(share.held) <= set(processes.held(5))
        total += float(processes.mean_loss(batch, lambda share: values[share.rows].mean(), frames=5))
    assert total / count == pytest.approx(float(values[batch].mean()))


@pytest.mark.parametrize("count", [2, 3, 70])
def test_a_process_reads_no_frame_of_others_until_asked(count: int) -> None:
    _, bands = bands_of_frames()
    read: list[int] = []

    def subbands(channels: slice, rows: torch.Tensor) -> Bands:
        read.extend(rows.tolist())
        return Bands(*(band[rows] for band in bands.of(channels)))

    frames = len(bands.ll)
    for rank in (0, 1, count - 1):
        processes = Processes(rank, count)
        read.clear()
        source = hold(subbands, GEOMETRY, frames=frames, size=48, processes=processes)
        own = processes.held(frames)
        assert read == list(own)
        for rows in (torch.tensor(own), torch.arange(frames)):
            found = source(slice(2, 4), rows)
            truth = bands.of(slice(2, 4))
            assert all(torch.equal(a, b[rows]) for a, b in zip(found, truth, strict=True))
        assert read == [*own, *range(frames)]


def test_channels_are_solved_for_once() -> None:
    solved = [channel for rank in range(3) for channel in Processes(rank, 3).channels(11)]
    assert sorted(solved) == list(range(11))
    assert all(channel in Processes(ALONE.rank, 1).channels(11) for channel in range(11))
