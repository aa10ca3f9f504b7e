"""A posed avatar to an image, by the reference kernels on the CPU.

Colours are display-referred, as in 3D Gaussian Splatting: sRGB values are blended, so an image needs no transfer
function before it is written as 8 bits.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageColor

from mua.arguments import describe, finite_array, whole_number
from mua.arrays import Array
from mua.avatar.camera import Camera, orbit
from mua.avatar.decode import Splats, box_of
from mua.errors import InputError
from mua.kernels.dq_skinning import covariances
from mua.kernels.splat_draw import splat_colors, splat_draw
from mua.kernels.splat_project import splat_project
from mua.kernels.splat_sort import splat_sort

WHITE = (1.0, 1.0, 1.0)
SIZE = (640, 960)  # width and height in pixels: upright, as people stand
LARGEST = 8192  # pixels along a side
RIGID_BOUND = 1e-3  # by which a user's rotation may differ from one, computed in float32 and multiplied a few times
LAST_ROW, PERSPECTIVE_ROW = (0, 0, 0, 1), (0, 0, -1, 0)  # of a view, and of a projection


@dataclass(frozen=True, eq=False)
class Projected:
    """M splats on the screen of one camera."""

    ellipses: Array  # [M, 6] (mua.kernels.splat_project)
    colors: Array  # [M, 3] sRGB
    opacities: Array  # [M]
    order: Array  # [M] back to front


def render(
    splats: Splats,
    camera: Camera | None = None,
    *,
    size: tuple[int, int] = SIZE,
    azimuth: float = 0.0,
    elevation: float = 0.0,
    background: str = "white",
) -> Image.Image:
    """An image of the splats on the CPU, in a second or a few.

    Without a `camera`, one is placed so that all splats are in the image: `size` is its width and height in pixels,
    `azimuth` the degrees by which it goes round to the avatar's left, 0 being the front of the bind pose, and
    `elevation` the degrees from which it looks down. `background` is a colour name or `#rrggbb`.

    Errors: InputError for a size, an angle, an unknown colour or a camera without perspective, and where a camera comes
    with a size or an angle.

    Example:

        mua.render(splats, size=(480, 720), azimuth=25).save("avatar.png")
    """
    if not isinstance(splats, Splats):
        raise InputError(f"splats is {describe(splats)}; expected what Avatar.decode returns")
    if camera is None:
        camera = _orbit(splats, size, azimuth, elevation)
    elif not isinstance(camera, Camera):
        raise InputError(f"camera is {describe(camera)}; expected a mua.Camera")
    elif (size, azimuth, elevation) != (SIZE, 0, 0):
        raise InputError("camera is given together with size, azimuth or elevation; expected camera alone")
    else:
        camera = _checked(camera)
    return Image.fromarray(to_bytes(render_over(splats, camera, background=parse_color(background))))


def render_over(
    splats: Splats,
    camera: Camera,
    *,
    background: tuple[float, float, float] = WHITE,  # sRGB, 0..1
) -> Array:
    """The image [H, W, 3] over a plain background, sRGB, float64, not below 0; above 1 where the SH says so."""
    image = render_premultiplied(splats, camera)
    return np.asarray(image[..., :3] + (1 - image[..., 3:]) * np.array(background))


def render_premultiplied(
    splats: Splats,
    camera: Camera,
    *,
    encode: Callable[[Array], Array] = np.asarray,  # from the splats' sRGB [M, 3] to what is blended
) -> Array:
    """Premultiplied sRGB, or what `encode` makes of it, and alpha [H, W, 4], float64."""
    seen = projected(splats, camera)
    return splat_draw(seen.ellipses, encode(seen.colors), seen.opacities, seen.order, screen=camera.screen)


def projected(splats: Splats, camera: Camera) -> Projected:
    """The splats that a camera sees, ready to be drawn."""
    seen, keys, ellipses = visible(splats, camera)
    colors = splat_colors(splats.centres[seen], splats.texel_dq[seen], splats.sh[seen], camera.position)
    return Projected(ellipses[0], colors, splats.opacities[seen], splat_sort(keys))


def visible(splats: Splats, camera: Camera) -> tuple[Array, Array, Array]:
    """The splats [M] that a camera sees, with their keys [M] and ellipses [1, M, 6] (mua.kernels.splat_project)."""
    return splat_project(
        splats.centres,
        covariances(splats.rotations, splats.scales),
        splats.opacities,
        camera.view[None],
        camera.projection[None],
        screen=camera.screen,
        near=camera.near,
        bounds=splats.bounds,
        normals=splats.normals,
    )


def frame_bounds(splats: Splats) -> Array:
    """Lowest and highest corner [2, 3] of the splat centres, metres; zeros where there are none."""
    return box_of(splats.centres)


def parse_color(text: str) -> tuple[float, float, float]:
    """sRGB in 0..1 from a colour name or #rrggbb."""
    try:
        red, green, blue = ImageColor.getrgb(text)[:3]
    except (AttributeError, TypeError, ValueError) as error:
        raise InputError(f"background is {describe(text)}; expected a colour name or #rrggbb") from error
    return red / 255, green / 255, blue / 255


def to_bytes(image: Array) -> Array:
    """sRGB in 0..1 to 8 bits."""
    return (np.clip(image, 0, 1) * 255 + 0.5).astype(np.uint8)


def _orbit(splats: Splats, size: tuple[int, int], azimuth: float, elevation: float) -> Camera:
    """A camera that frames the splats, from angles in degrees."""
    width, height = _pixels(size, "size")
    turn, tilt = (np.radians(finite_array(*angle, ())) for angle in ((azimuth, "azimuth"), (elevation, "elevation")))
    return orbit(frame_bounds(splats), screen=(width, height), azimuth=float(turn), elevation=float(tilt))


def _checked(camera: Camera) -> Camera:
    """A camera of a user, whose view is rigid and whose projection has a perspective."""
    view = finite_array(camera.view, "view of the camera", (4, 4))
    projection = finite_array(camera.projection, "projection of the camera", (4, 4))
    if np.abs(view[:3, :3] @ view[:3, :3].T - np.eye(3)).max() > RIGID_BOUND or (view[3] != LAST_ROW).any():
        raise InputError("view of the camera: expected a rotation and a translation, from the world to the eye")
    if (projection[3] != PERSPECTIVE_ROW).any() or projection[2, 3] >= 0 or not projection[0, 0] * projection[1, 1]:
        raise InputError(
            "projection of the camera: expected a perspective of an eye that looks along -Z, its last row 0 0 -1 0"
        )
    return Camera(view, projection, _pixels(camera.screen, "screen of the camera"))


def _pixels(size: tuple[int, int], name: str) -> tuple[int, int]:
    if not isinstance(size, Sequence) or len(size) != 2:
        raise InputError(f"{name} is {describe(size)}; expected width and height in pixels")
    width, height = (whole_number(side, name) for side in size)
    if not (0 < width <= LARGEST and 0 < height <= LARGEST):
        raise InputError(f"{name} is {describe(size)}; expected sides of 1 to {LARGEST} pixels")
    return width, height
