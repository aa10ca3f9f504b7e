// A camera that is moved by hand: round its target, nearer and farther, and aside; as player/viewpoint.py.

const STEEPEST = (89 / 180) * Math.PI; // of the elevation, so that up stays up
const NEAREST = 0.01; // times the distance from which all is seen
const FARTHEST = 30;
const ZOOM_STEP = 1.15; // of the distance, for one notch of the wheel
export const TURN = (0.4 / 180) * Math.PI; // radians, for one pixel of a drag

/** @typedef {import("./player.js").CameraState} CameraState */

const clamp = (/** @type {number} */ x, /** @type {number} */ low, /** @type {number} */ high) =>
  Math.min(Math.max(x, low), high);

/** After a drag of so many pixels: the figure follows the hand. */
export function turn(/** @type {CameraState} */ camera, /** @type {number} */ right, /** @type {number} */ down) {
  camera.azimuth -= TURN * right;
  camera.elevation = clamp(camera.elevation + TURN * down, -STEEPEST, STEEPEST);
}

/** Nearer by so many notches of the wheel; `framed` is the distance from which all is seen, metres. */
export function zoom(/** @type {CameraState} */ camera, /** @type {number} */ notches, /** @type {number} */ framed) {
  camera.distance = clamp(camera.distance * ZOOM_STEP ** -notches, NEAREST * framed, FARTHEST * framed);
}

/** Nearer so many times, as two fingers move apart. */
export function nearer(/** @type {CameraState} */ camera, /** @type {number} */ times, /** @type {number} */ framed) {
  zoom(camera, Math.log(times) / Math.log(ZOOM_STEP), framed);
}

/** After a drag of so many pixels in a picture of `height`: what is at the target stays under the hand. */
export function pan(
  /** @type {CameraState} */ camera,
  /** @type {number} */ right,
  /** @type {number} */ down,
  /** @type {number} */ height,
) {
  const metres = (2 * Math.tan(camera.fov / 2) * camera.distance) / height;
  const [sin, cos] = [Math.sin(camera.azimuth), Math.cos(camera.azimuth)];
  const [rise, level] = [Math.sin(camera.elevation), Math.cos(camera.elevation)];
  const across = [cos, 0, -sin];
  const up = [-sin * rise, level, -cos * rise];
  for (const i of [0, 1, 2]) camera.target[i] += metres * (down * up[i] - right * across[i]);
}
