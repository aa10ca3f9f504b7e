// Vectors [3] as arrays, the rotations [4] that they ask for, and where most of some numbers lie. References:
// python/mua/rotation.py and python/mua/motion/trunk.py.

import { multiply, normalized } from "../rotation.js";

/** @typedef {number[]} Vector */
/** @typedef {number[]} Quaternion w, x, y, z */

/** @type {Vector} */
export const Y = [0, 1, 0];
/** @type {Quaternion} */
export const IDENTITY = [1, 0, 0, 0];

export const vector = (/** @type {ArrayLike<number>} */ values, /** @type {number} */ at) => [
  values[3 * at],
  values[3 * at + 1],
  values[3 * at + 2],
];
export const quaternion = (/** @type {ArrayLike<number>} */ values, /** @type {number} */ at) => [
  values[4 * at],
  values[4 * at + 1],
  values[4 * at + 2],
  values[4 * at + 3],
];
export const plus = (/** @type {Vector} */ a, /** @type {Vector} */ b) => a.map((value, i) => value + b[i]);
export const minus = (/** @type {Vector} */ a, /** @type {Vector} */ b) => a.map((value, i) => value - b[i]);
export const times = (/** @type {Vector} */ a, /** @type {number} */ scale) => a.map((value) => scale * value);
export const dot = (/** @type {Vector} */ a, /** @type {Vector} */ b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (/** @type {Vector} */ a) => Math.hypot(...a);
export const middle = (/** @type {Vector} */ a, /** @type {Vector} */ b) => times(plus(a, b), 0.5);

/** The mean of some vectors. */
export function mean(/** @type {Vector[]} */ all) {
  const sum = [0, 0, 0];
  for (const one of all) for (let axis = 0; axis < 3; axis++) sum[axis] += one[axis];
  return times(sum, 1 / all.length);
}

export function cross(/** @type {Vector} */ a, /** @type {Vector} */ b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/** The direction of a vector; one without length stays 0. */
export function unit(/** @type {Vector} */ a) {
  return times(a, 1 / (length(a) || 1));
}

/** The angle between two vectors. */
export function degrees(/** @type {Vector} */ a, /** @type {Vector} */ b) {
  return (180 / Math.PI) * Math.atan2(length(cross(a, b)), dot(a, b));
}

/** The signed coordinate axis nearest to a vector. */
export function nearestAxis(/** @type {Vector} */ a) {
  const sizes = a.map(Math.abs);
  const axis = sizes.indexOf(Math.max(...sizes));
  return a.map((value, i) => (i === axis ? Math.sign(value) : 0));
}

/** The shortest rotation that takes one unit vector to another. @returns {Quaternion} */
export function between(/** @type {Vector} */ a, /** @type {Vector} */ b) {
  const cosine = dot(a, b);
  if (cosine >= -1 + 1e-9) return /** @type {number[]} */ (normalized([1 + cosine, ...cross(a, b)]));
  const sizes = a.map(Math.abs);
  const least = sizes.indexOf(Math.min(...sizes)); // any axis across a serves for a half turn
  return [
    0,
    ...unit(
      cross(
        a,
        [0, 1, 2].map((i) => Number(i === least)),
      ),
    ),
  ];
}

/** The rotation whose matrix has these columns, w >= 0 (Shepperd 1978, https://doi.org/10.2514/3.55767b). @returns {Quaternion} */
export function fromColumns(/** @type {[Vector, Vector, Vector]} */ [x, y, z]) {
  const [yz, zx, xy] = [y[2] - z[1], z[0] - x[2], x[1] - y[0]];
  const [sxy, szx, syz] = [x[1] + y[0], x[2] + z[0], y[2] + z[1]];
  const rows = [
    [1 + x[0] + y[1] + z[2], yz, zx, xy],
    [yz, 1 + x[0] - y[1] - z[2], sxy, szx],
    [zx, sxy, 1 - x[0] + y[1] - z[2], syz],
    [xy, szx, syz, 1 - x[0] - y[1] + z[2]],
  ];
  let largest = 0;
  for (let row = 1; row < 4; row++) if (rows[row][row] > rows[largest][largest]) largest = row;
  const q = /** @type {number[]} */ (normalized(rows[largest]));
  return q[0] < 0 ? q.map((value) => -value) : q;
}

/** The rotation about a coordinate axis. @returns {Quaternion} */
export function aboutAxis(/** @type {number} */ axis, /** @type {number} */ radians) {
  const q = [Math.cos(radians / 2), 0, 0, 0];
  q[axis + 1] = Math.sin(radians / 2);
  return q;
}

/** The product of rotations, the last of which comes first. @returns {Quaternion} */
export function turns(/** @type {Quaternion[]} */ ...all) {
  return all.reduce((product, one) => multiply(product, one));
}

/** The value below which so large a share of some numbers lies, between the two nearest of them. */
export function quantile(/** @type {number[]} */ values, /** @type {number} */ share) {
  const sorted = values.toSorted((a, b) => a - b);
  const at = share * (sorted.length - 1);
  const below = sorted[Math.floor(at)];
  return below + (at - Math.floor(at)) * (sorted[Math.ceil(at)] - below);
}
