// Quaternions (w, x, y, z) and dual quaternions, one after the other in arrays of float64. Reference: python/mua/rotation.py.

/** @typedef {Float64Array | Float32Array | number[]} Numbers */

/** Scale the quaternion at `at` to unit length, in place. */
export function normalized(/** @type {Float64Array | number[]} */ q, at = 0) {
  const length = Math.hypot(q[at], q[at + 1], q[at + 2], q[at + 3]);
  for (let i = at; i < at + 4; i++) q[i] /= length;
  return q;
}

/** Hamilton product of the quaternions at `i` and `j`: the rotation b, then a. */
export function multiply(/** @type {Numbers} */ a, /** @type {Numbers} */ b, i = 0, j = 0) {
  const [aw, ax, ay, az] = [a[i], a[i + 1], a[i + 2], a[i + 3]];
  const [bw, bx, by, bz] = [b[j], b[j + 1], b[j + 2], b[j + 3]];
  return [
    aw * bw - ax * bx - ay * by - az * bz,
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
  ];
}

export function conjugate(/** @type {Numbers} */ q, at = 0) {
  return [q[at], -q[at + 1], -q[at + 2], -q[at + 3]];
}

/** The vector at `j` turned by the unit quaternion at `i`. */
export function rotate(/** @type {Numbers} */ q, /** @type {Numbers} */ v, i = 0, j = 0) {
  const [w, x, y, z] = [q[i], q[i + 1], q[i + 2], q[i + 3]];
  const [vx, vy, vz] = [v[j], v[j + 1], v[j + 2]];
  const [tx, ty, tz] = [2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)];
  return [vx + w * tx + (y * tz - z * ty), vy + w * ty + (z * tx - x * tz), vz + w * tz + (x * ty - y * tx)];
}

/** Interpolate between the quaternions at `i` and `j` along the shorter arc, t from 0 to 1. */
export function slerp(/** @type {Numbers} */ a, /** @type {Numbers} */ b, /** @type {number} */ t, i = 0, j = 0) {
  const dot = a[i] * b[j] + a[i + 1] * b[j + 1] + a[i + 2] * b[j + 2] + a[i + 3] * b[j + 3];
  const angle = Math.acos(Math.min(Math.abs(dot), 1));
  const small = angle < 1e-6;
  const before = small ? 1 - t : Math.sin((1 - t) * angle) / Math.sin(angle);
  const after = (small ? t : Math.sin(t * angle) / Math.sin(angle)) * (dot < 0 ? -1 : 1);
  return normalized([0, 1, 2, 3].map((k) => before * a[i + k] + after * b[j + k]));
}

/** The first two columns of the matrix of the unit quaternion at `at`. */
export function sixNumbers(/** @type {Numbers} */ q, at = 0) {
  const [w, x, y, z] = [q[at], q[at + 1], q[at + 2], q[at + 3]];
  return [
    1 - 2 * (y * y + z * z),
    2 * (x * y + w * z),
    2 * (x * z - w * y),
    2 * (x * y - w * z),
    1 - 2 * (x * x + z * z),
    2 * (y * z + w * x),
  ];
}

/** The dual quaternion of the rotation at `i`, then the translation at `j`. */
export function dualFromRigid(/** @type {Numbers} */ q, /** @type {Numbers} */ t, i = 0, j = 0) {
  const pure = [0, t[j], t[j + 1], t[j + 2]];
  return [q[i], q[i + 1], q[i + 2], q[i + 3], ...multiply(pure, q, 0, i).map((value) => value / 2)];
}

/** The product of the dual quaternions at `i` and `j`: the transform b, then a. */
export function dualMultiply(/** @type {Numbers} */ a, /** @type {Numbers} */ b, i = 0, j = 0) {
  const [first, second] = [multiply(a, b, i, j + 4), multiply(a, b, i + 4, j)];
  return [...multiply(a, b, i, j), ...first.map((value, k) => value + second[k])];
}

/** A point moved by a unit dual quaternion. */
export function dualTransform(/** @type {Numbers} */ d, /** @type {Numbers} */ p, i = 0, j = 0) {
  const moved = multiply(d, conjugate(d, i), i + 4, 0);
  return rotate(d, p, i, j).map((value, axis) => value + 2 * moved[axis + 1]);
}

/** Largest angle between the rotations [J, 4] of two poses, radians. @param {ArrayLike<number>} a @param {ArrayLike<number>} b */
export function largestTurn(a, b) {
  let least = 1; // cosine of half the angle
  for (let at = 0; at < a.length; at += 4) {
    const cosine = a[at] * b[at] + a[at + 1] * b[at + 1] + a[at + 2] * b[at + 2] + a[at + 3] * b[at + 3];
    least = Math.min(least, Math.abs(cosine));
  }
  return 2 * Math.acos(least);
}
