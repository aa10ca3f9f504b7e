"""Images by OpenGL without a window, on a GPU or on the CPU; nothing here shares code with how splats are made."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

import moderngl
import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera
from mua.errors import InputError

OPENGL = 330  # the oldest version that has all that is needed
LAID_OVER = (moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA)  # premultiplied colours, from back to front


class Area(NamedTuple):
    """A part of an image in pixels, rows from the top; nothing of it where the last is not beyond the first."""

    left: int
    top: int
    right: int  # the first column beyond
    bottom: int

    @classmethod
    def about(
        cls,
        low: Array,  # [N, 2] column and row, pixels
        high: Array,  # [N, 2]
        screen: tuple[int, int],
    ) -> "Area":
        """The pixels of a screen that any of N boxes may touch."""
        if not len(low):
            return cls(0, 0, 0, 0)
        first = np.clip(np.floor(low.min(axis=0)) - 1, 0, screen).astype(int)
        last = np.clip(np.ceil(high.max(axis=0)) + 1, 0, screen).astype(int)
        return cls(*first.tolist(), *last.tolist())

    @classmethod
    def of_points(
        cls,
        points: Array,  # [N, 3] world, metres
        camera: Camera,
    ) -> "Area":
        """The pixels that what lies between some points may touch; all where one is not before the camera."""
        pixels, depths = camera.pixels(points)
        return cls(0, 0, *camera.screen) if (depths <= camera.near).any() else cls.about(pixels, pixels, camera.screen)

    def joined(self, other: "Area") -> "Area":
        """The area around both."""
        return Area(*map(min, self[:2], other[:2]), *map(max, self[2:], other[2:]))

    @property
    def empty(self) -> bool:
        return self.right <= self.left or self.bottom <= self.top

    def of(self, image: Array) -> Array:
        """The view of an image [H, W, ...] on this part."""
        return image[self.top : self.bottom, self.left : self.right]


@contextmanager
def opened() -> Iterator[moderngl.Context]:
    """An OpenGL context; raises an InputError where this machine has none."""
    options: dict[str, Any] = {"backend": "egl"} if sys.platform.startswith("linux") else {}
    try:
        context = moderngl.create_context(standalone=True, require=OPENGL, **options)
    except Exception as error:  # the library raises many kinds, some of them plain exceptions
        raise InputError(
            f"no OpenGL to draw with ({error}): install a driver (on Debian, libegl1 and libgl1-mesa-dri; they have "
            f"one for the CPU)"
        ) from error
    try:
        context.gc_mode = "context_gc"
        yield context
    finally:
        context.release()


class Canvas:
    """An image of premultiplied sRGB and alpha to draw on, and its depth."""

    def __init__(self, context: moderngl.Context, screen: tuple[int, int], *, samples: int, dtype: str) -> None:
        """`samples` are along a side of every pixel; `dtype` is "f1" for eight bits a channel or "f4" for floats."""
        self._context, self._screen, self._samples, self._dtype = context, screen, samples, dtype
        self.size = screen[0] * samples, screen[1] * samples
        self._color = context.renderbuffer(self.size, dtype=dtype)
        self._target = context.framebuffer([self._color], context.depth_renderbuffer(self.size))

    def begin(self, area: Area | None = None, onto: moderngl.Framebuffer | None = None) -> None:
        """Draw here from now on, onto nothing or onto a copy; only in a part of the image where one is given."""
        self._target.scissor = self._box(None)
        if onto is not None:
            self._context.copy_framebuffer(self._target, onto)
        self._target.use()
        self._target.scissor = self._box(area)
        if onto is None:
            self._target.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)

    def copy(self) -> moderngl.Framebuffer:
        """The colours of what is drawn so far."""
        copy = self._context.framebuffer([self._context.renderbuffer(self.size, dtype=self._dtype)])
        self._context.copy_framebuffer(copy, self._target)
        return copy

    def read(self, area: Area | None = None) -> Array:
        """The image or a part of it [H, W, 4] float32, each pixel the mean of its samples, its first row at the top."""
        count = self._samples
        box = self._box(area)
        kind = np.uint8 if self._dtype == "f1" else np.float32
        samples = np.frombuffer(self._target.read(box, components=4, dtype=self._dtype), kind)
        samples = samples.reshape(box[3] // count, count, box[2] // count, count, 4)[::-1]
        total = sum(samples[:, row, :, column].astype(np.float32) for row in range(count) for column in range(count))
        return np.asarray(total / np.float32((255 if kind is np.uint8 else 1) * count**2))

    def _box(self, area: Area | None) -> tuple[int, int, int, int]:
        """Samples of an area, as OpenGL counts them: left, bottom, width, height."""
        left, top, right, bottom = area or (0, 0, *self._screen)
        corner_and_size = left, self._screen[1] - bottom, right - left, bottom - top
        return tuple(self._samples * number for number in corner_and_size)  # type: ignore[return-value]


def draw(
    program: moderngl.Program,
    rows: Array,  # [N, c], one for each vertex or instance
    layout: str,  # layout of a row in moderngl's notation: "3f 2f"
    names: Sequence[str],  # names of the program's inputs
    *,
    mode: int,
    vertices: int = -1,  # vertices of each instance
    instances: int = 1,
) -> None:
    """Draw rows that are needed once."""
    if not len(rows):
        return
    context = program.ctx
    buffer = context.buffer(np.ascontiguousarray(rows, dtype=np.float32))
    array = context.vertex_array(program, [(buffer, layout, *names)])
    array.render(mode, vertices=vertices, instances=instances)
    array.release()
    buffer.release()


def set_uniform(program: moderngl.Program, name: str, value: Any) -> None:
    """Give a uniform of a program its value."""
    uniform = program[name]
    assert isinstance(uniform, moderngl.Uniform)
    uniform.value = value
