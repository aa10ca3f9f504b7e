"""The capacity of each kind of blendshapes, whatever predicts their coefficients: explained texture against size.

    python tools/research/measure_capacity.py RECORDING --preset tiny --frames 375 --frames 1500 -o build/capacity

Bases are solved in closed form on the training frames (or on so many of them, evenly spaced); every frame then takes
the best coefficients there are. What is printed is the share of the variance about the mean texture, over the valid
texels in the loss' channel weights, of training and of held-out frames, beside the numbers that the bases store.
The ranks of the separable kinds are the preset's times each factor; of the full-size kinds every number of components
is one point. Writes capacity.csv, capacity.md and capacity.png.
"""

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import torch
import typer
from torch import Tensor

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua.channels import APPEARANCE, CHANNELS, COARSE_TEXELS, GEOMETRY, STATIC_LEVELS
from mua.recording import Recording
from mua.student.bases import BestCoefficients, factorize_channel
from mua.student.factorize import Factors, separable_blendshapes
from mua.student.model import Branch, lowpass_texels
from mua.student.paper_recipe import set_means
from mua.student.settings import Ranks, Settings, preset
from mua.student.targets import channel_weights
from mua.wavelets import Bands, synthesise_lowpass, waverec2

FACTORS = (0.125, 0.25, 0.5, 1.0, 2.0)  # factors of the preset's ranks
COMPONENTS = (1, 2, 4, 8, 16, 24, 32, 48, 64, 96, 128, 192, 256)
BRANCHES = {"geometry": GEOMETRY, "appearance": APPEARANCE}
COLOURS = {"ours": "tab:blue", "single-level": "tab:green", "pca-only": "tab:orange", "full-blendshapes": "tab:red"}


@dataclass(frozen=True)
class Point:
    """The variance explained by a basis of one size."""

    frames: int
    kind: str
    size: str  # ranks or components
    numbers: int  # numbers that the basis stores
    training: float
    held_out: float


@dataclass(frozen=True)
class Textures:
    """The frames of one kind as subbands about the training mean, in weighted channels."""

    bands: Bands  # [F, 23, ...]
    wavelet: str
    texels: Tensor  # [N]

    def channel(self, channel: int) -> Bands:
        return self.bands.of(slice(channel, channel + 1))

    def image(self, bands: Bands) -> Tensor:
        """[F, N] of the subbands of one channel."""
        return lowpass_texels(bands, self.wavelet, self.texels)[:, 0]

    def quarter(self, channel: int) -> Tensor:
        """The low-pass quarter-size images [F, 1, n, n] of one channel."""
        ll, d3, d2 = self.channel(channel)
        return waverec2(ll, [d3.transpose(1, 2), d2.transpose(1, 2)], self.wavelet)


def main(
    recording: Annotated[Path, typer.Argument(help="Recording with held-out clips.")],
    preset_name: Annotated[str, typer.Option("--preset", help="Whose ranks are scaled.")] = "tiny",
    frames: Annotated[list[int], typer.Option(help="Training frames to use, may be repeated; all if left out.")] = [],  # noqa: B006
    output: Annotated[Path, typer.Option("--output", "-o", help="Directory of table and plot.")] = Path(
        "build/capacity"
    ),
) -> None:
    """Measure what bases can hold."""
    opened, settings = Recording(recording), preset(preset_name)
    output.mkdir(parents=True, exist_ok=True)
    points: list[Point] = []
    for count in frames or [opened.count()]:
        count = min(count, opened.count())
        known, unseen = load(opened, count)
        totals = energy(known), energy(unseen)
        for kind in (full_size, ours, single_level):
            for point in kind(known, unseen, totals, settings, count):
                points.append(point)
                print(*(f"{x:.4g}" if isinstance(x, float) else x for x in vars(point).values()), flush=True)
    with (output / "capacity.csv").open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(Point.__dataclass_fields__)
        table.writerows(vars(point).values() for point in points)
    (output / "capacity.md").write_text(markdown(points))
    plot(output / "capacity.png", points)


def load(recording: Recording, count: int) -> tuple[Textures, Textures]:
    """`count` training frames and all held-out ones."""
    rows = torch.arange(count) * recording.count() // count
    parts = []
    for part in BRANCHES.values():
        branch = Branch(
            part.stop - part.start, Ranks(1, 1, 1), recording.rig.texels.size // COARSE_TEXELS, inputs=1, hidden=1
        )

        def source(channels: slice, some: Tensor, start: int = part.start) -> Bands:
            return recording.subbands(slice(start + channels.start, start + channels.stop), rows[some])

        weights = channel_weights(set_means(branch, source, frames=count), part)
        parts.append((branch.ll_mean, branch.d3.mean, branch.d2.mean, weights))
    ll, d3, d2, weight = zip(*parts, strict=True)
    mean = Bands(torch.cat(ll), torch.cat(d3, dim=1), torch.cat(d2, dim=1))
    scale = torch.cat(weight)[:, None, None]
    texels = torch.from_numpy(recording.rig.texels.texels).long()
    found = []
    for held_out, chosen in ((False, rows), (True, torch.arange(recording.count(held_out=True)))):
        bands = recording.subbands(slice(0, CHANNELS), chosen, held_out=held_out)
        weighted = Bands(*((band - middle) * scale for band, middle in zip(bands, mean, strict=True)))
        found.append(Textures(weighted, recording.wavelet, texels))
    return found[0], found[1]


def energy(textures: Textures) -> float:
    return sum(float(textures.image(textures.channel(c)).double().square().sum()) for c in range(CHANNELS))


def full_size(
    known: Textures, unseen: Textures, totals: tuple[float, float], settings: Settings, frames: int
) -> Iterator[Point]:
    """Principal components of all channels together, and of either branch, through the Gram matrix of the frames."""
    held: dict[str, tuple[Tensor, Tensor, int]] = {}
    for name, part in BRANCHES.items():
        gram = torch.zeros(len(known.bands.ll), len(known.bands.ll), dtype=torch.double)
        cross = torch.zeros(len(unseen.bands.ll), len(known.bands.ll), dtype=torch.double)
        for channel in range(part.start, part.stop):
            x = known.image(known.channel(channel))
            gram += (x @ x.T).double()
            cross += (unseen.image(unseen.channel(channel)) @ x.T).double()
        held[name] = gram, cross, (part.stop - part.start) * len(known.texels)
    together = tuple(map(sum, zip(*held.values(), strict=True)))
    for kind, parts in (("pca-only", [together]), ("full-blendshapes", list(held.values()))):
        spectra = [spectrum(*part[:2]) for part in parts]
        for components in COMPONENTS:
            sums = [sum(float(s[at][:components].sum()) for s in spectra) for at in (0, 1)]
            numbers = sum(components * int(part[2]) for part in parts)
            shares = [got / total for got, total in zip(sums, totals, strict=True)]
            yield Point(frames, kind, str(components), numbers, *shares)


def spectrum(gram: Tensor, cross: Tensor) -> tuple[Tensor, Tensor]:
    """The energies of training and of other frames along each component, largest first."""
    values, vectors = torch.linalg.eigh(gram)
    values, vectors = values.flip(0).clamp(min=0), vectors.flip(1)
    sound = values > values[0] * 1e-9
    other = (cross @ vectors[:, sound]).square().sum(0) / values[sound]
    return values[sound], other


def ours(
    known: Textures, unseen: Textures, totals: tuple[float, float], settings: Settings, frames: int
) -> Iterator[Point]:
    """LL by blendshapes, D3 and D2 by separable ones."""
    for factor in FACTORS:
        lost, numbers, names = [0.0, 0.0], 0, []
        for name, part in BRANCHES.items():
            own = settings.geometry if name == "geometry" else settings.appearance
            ranks = Ranks(*(max(round(factor * rank), 1) for rank in (own.ll, own.d3, own.d2)))
            names.append(f"{ranks.ll}/{ranks.d3}/{ranks.d2}")
            for channel in range(part.start, part.stop):
                branch = Branch(1, ranks, known.bands.ll.shape[-1], inputs=1, hidden=1).requires_grad_(False)
                generator = torch.Generator().manual_seed(channel)
                factorize_channel(branch, 0, known.channel(channel), sweeps=settings.sweeps, generator=generator)
                bases = (branch.ll_basis, branch.d3.h, branch.d3.w, branch.d2.h, branch.d2.w)
                numbers += sum(basis.numel() for basis in bases)
                for at, textures in enumerate((known, unseen)):
                    bands = textures.channel(channel)
                    found = branch.synthesize(BestCoefficients(branch)(bands))
                    left = Bands(*(a - b for a, b in zip(bands, found, strict=True)))
                    lost[at] += float(textures.image(left).double().square().sum())
        yield Point(frames, "ours", ", ".join(names), numbers, *(1 - a / b for a, b in zip(lost, totals, strict=True)))


def single_level(
    known: Textures, unseen: Textures, totals: tuple[float, float], settings: Settings, frames: int
) -> Iterator[Point]:
    """Outer products at full size, of twice our LL ranks; solved on quarter-size images, which hold all."""
    for factor in FACTORS:
        lost, numbers, names = [0.0, 0.0], 0, []
        for name, part in BRANCHES.items():
            rank = max(round(2 * factor * (settings.geometry if name == "geometry" else settings.appearance).ll), 1)
            names.append(str(rank))
            for channel in range(part.start, part.stop):
                generator = torch.Generator().manual_seed(channel)
                image = known.quarter(channel)
                factors = separable_blendshapes(image, rank, sweeps=settings.sweeps, generator=generator)
                numbers += 2 * rank * (image.shape[-1] << STATIC_LEVELS)
                for at, textures in enumerate((known, unseen)):
                    left = remainder(textures.quarter(channel), factors)
                    full = synthesise_lowpass(left, textures.wavelet, STATIC_LEVELS).flatten(1)[:, textures.texels]
                    lost[at] += float(full.double().square().sum())
        shares = (1 - a / b for a, b in zip(lost, totals, strict=True))
        yield Point(frames, "single-level", ", ".join(names), numbers, *shares)


def remainder(
    image: Tensor,  # [F, 1, n, n]
    factors: Factors,  # subbands of one band
) -> Tensor:
    """The residual [F, n, n] of images with their best coefficients."""
    basis, x = factors.basis().double(), image.flatten(1).double()
    coefficients = x @ torch.linalg.pinv(basis)
    return (x - coefficients @ basis).to(image).unflatten(1, image.shape[2:])


def markdown(points: list[Point]) -> str:
    lines = ["| frames | kind | ranks | M numbers | training | held out |", "| --- " * 6 + "|"]
    for p in points:
        lines.append(
            f"| {p.frames} | `{p.kind}` | {p.size} | {p.numbers / 1e6:.3f} | {p.training:.2%} | {p.held_out:.2%} |"
        )
    return "\n".join(lines) + "\n"


def plot(path: Path, points: list[Point]) -> None:
    import matplotlib.pyplot as plt

    figure, panels = plt.subplots(1, 2, figsize=(10, 4.2), sharey=True, layout="constrained")
    counts = sorted({point.frames for point in points})
    styles = dict(zip(reversed(counts), ("-", "--", ":", "-."), strict=False))
    for panel, column in zip(panels, ("training", "held_out"), strict=True):
        for kind, colour in COLOURS.items():
            for count, style in styles.items():
                own = [p for p in points if p.kind == kind and p.frames == count]
                x, y = [p.numbers for p in own], [1 - getattr(p, column) for p in own]
                panel.plot(x, y, style, color=colour, marker=".", label=f"{kind}, {count} frames")
        panel.set(
            xscale="log",
            yscale="log",
            xlabel="numbers that the bases store",
            title=f"{column.replace('_', ' ')} frames",
        )
        panel.yaxis.set_major_formatter(lambda share, _: f"{100 * share:g} %")
        panel.grid(alpha=0.3)
    panels[0].set_ylabel("variance not held, best coefficients")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right center", fontsize=8)
    figure.savefig(path, dpi=120)


if __name__ == "__main__":
    typer.run(main)
