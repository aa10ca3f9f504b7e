// A camera that turns about its target, the two eyes beside it, and those of a headset. Matrices are row-major and act on
// columns; eye space is right-handed, Y up, looking along -Z. References: python/mua/avatar/camera.py, python/mua/player/viewpoint.py.

/** @typedef {import("./player.js").CameraState} CameraState */
/**
 * @typedef {object} Camera
 * @property {number[]} view [4, 4] world to eye, metres
 * @property {number[]} projection [4, 4] eye to clip, z of -w to w
 * @property {number[]} viewProjection [4, 4] world to clip, z of 0 to w
 * @property {number[]} position world, metres
 * @property {[number, number]} screen width and height, pixels
 * @property {number} near metres
 */

export const FOV = Math.PI / 6; // vertical; a portrait lens
export const NEAR = 0.02; // metres, at most
const NEAR_SHARE = 0.01; // of the distance of what is looked at: so near a small figure is not cut
const EYE_DISTANCE = 0.063; // metres, of an adult
const FILL = 0.92; // of the picture's half size, that the framed box reaches

/** The view of a state on a screen. @param {CameraState} state @param {[number, number]} screen @returns {Camera} */
export function cameraOf({ azimuth, elevation, distance, target, fov }, screen) {
  const turn = rotation(azimuth, elevation);
  const moved = turn.map((row, axis) => -dot(row, target) - (axis === 2 ? distance : 0));
  const view = [...turn.flatMap((row, axis) => [...row, moved[axis]]), 0, 0, 0, 1];
  const near = Math.min(NEAR, NEAR_SHARE * distance);
  const focal = 1 / Math.tan(fov / 2);
  const projection = [(focal * screen[1]) / screen[0], 0, 0, 0, 0, focal, 0, 0, 0, 0, -1, -2 * near, 0, 0, -1, 0];
  return eyeOf(view, projection, screen, near);
}

/**
 * The eyes of a picture of so many pixels: the camera of a state, or in stereo a left and a right one beside each other that
 * look the same way, half of the picture each, their middle at the camera.
 * @param {CameraState} state @param {boolean} stereo @param {[number, number]} size @returns {Camera[]}
 */
export function camerasOf(state, stereo, [width, height]) {
  if (!stereo || width < 2) return [cameraOf(state, [width, height])];
  const { view, projection, screen, near } = cameraOf(state, [Math.floor(width / 2), height]);
  return [EYE_DISTANCE / 2, -EYE_DISTANCE / 2].map((aside) => {
    const moved = view.map((value, i) => (i === 3 ? value + aside : value));
    return eyeOf(moved, projection, screen, near);
  });
}

/**
 * [4, 4] from the world to a room whose origin is on the floor below the reader, who looks along -Z.
 * @param {number[]} foot world, metres: what comes before the reader, on the floor
 * @param {number} azimuth radians from which it is then seen
 * @param {number} apart metres between the two
 */
export function roomOf(foot, azimuth, apart) {
  const turn = rotation(azimuth, 0);
  return [...turn.flatMap((row, axis) => [...row, -dot(row, foot) - (axis === 2 ? apart : 0)]), 0, 0, 0, 1];
}

/** An eye of a headset in a room. @param {number[]} room [4, 4] from the world @param {import("./webxr.js").View} view @param {[number, number]} screen @returns {Camera} */
export function eyeInRoom(room, { projectionMatrix, transform }, screen) {
  const clip = rows(projectionMatrix);
  const projection = clip.map((value, i) => (i >= 8 && i < 12 ? 2 * value - clip[i + 4] : value));
  return eyeOf(product(rows(transform.inverse.matrix), room), projection, screen, clip[11] / clip[10]);
}

/** A camera by its matrices. @param {number[]} view @param {number[]} projection @param {[number, number]} screen @param {number} near @returns {Camera} */
function eyeOf(view, projection, screen, near) {
  const position = [0, 1, 2].map((axis) => -[0, 4, 8].reduce((sum, row) => sum + view[row + axis] * view[row + 3], 0));
  const depth = projection.map((value, i) => (i >= 8 && i < 12 ? (value + projection[i + 4]) / 2 : value));
  return { view, projection, viewProjection: product(depth, view), position, screen, near };
}

/**
 * The distance from which all of a box is in the picture.
 * @param {number[]} box lowest then highest corner @param {CameraState} state of which azimuth, elevation and fov count
 * @param {[number, number]} screen
 */
export function framing(box, { azimuth, elevation, fov }, screen) {
  const turn = rotation(azimuth, elevation);
  const half = [0, 1, 2].map((axis) => (box[3 + axis] - box[axis]) / 2);
  const focal = 1 / Math.tan(fov / 2);
  const slopes = [(FILL * screen[0]) / (screen[1] * focal), FILL / focal];
  let distance = 0;
  for (let corner = 0; corner < 8; corner++) {
    const [x, y, z] = turn.map((row) =>
      dot(
        row,
        half.map((length, axis) => (corner & (1 << axis) ? length : -length)),
      ),
    );
    distance = Math.max(distance, z + Math.max(Math.abs(x) / slopes[0], Math.abs(y) / slopes[1]));
  }
  const target = /** @type {[number, number, number]} */ ([0, 1, 2].map((axis) => (box[axis] + box[3 + axis]) / 2));
  return { target, distance: distance || NEAR };
}

/** Whether any of a box may be in the picture: not all of it lies beyond one side, or before the near plane. */
export function sees(/** @type {Camera} */ { viewProjection }, /** @type {number[]} */ box) {
  const corners = Array.from({ length: 8 }, (_, corner) => {
    const place = [...[0, 1, 2].map((axis) => box[corner & (1 << axis) ? 3 + axis : axis]), 1];
    return [0, 4, 8, 12].map((row) => dot(place, viewProjection.slice(row, row + 4)));
  });
  const sides = [
    corners.every(([x, , , w]) => x > w),
    corners.every(([x, , , w]) => x < -w),
    corners.every(([, y, , w]) => y > w),
    corners.every(([, y, , w]) => y < -w),
    corners.every(([, , z]) => z < 0),
  ];
  return !sides.includes(true);
}

/** Rows of the rotation from the world to the eye. */
function rotation(/** @type {number} */ azimuth, /** @type {number} */ elevation) {
  const [c, s] = [Math.cos(azimuth), Math.sin(azimuth)];
  const [up, down] = [Math.cos(elevation), Math.sin(elevation)];
  return [
    [c, 0, -s],
    [-down * s, up, -down * c],
    [up * s, down, up * c],
  ];
}

/** @param {number[]} a @param {number[]} b */
const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);

/** A matrix [4, 4] that is given column by column. */
function rows(/** @type {ArrayLike<number>} */ columns) {
  return Array.from(columns, (_, i) => columns[4 * (i % 4) + Math.floor(i / 4)]);
}

/** Matrices [4, 4], row by row. */
function product(/** @type {number[]} */ a, /** @type {number[]} */ b) {
  return a.map((_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[i - (i % 4) + k] * b[4 * k + (i % 4)], 0));
}
