// At which level of detail avatars are shown and by which shape their splats are drawn: by their size on the screen, and by what all may cost. Reference:
// python/mua/avatar/level_choice.py; tests/golden/level_choice.json holds both to it.

/**
 * @typedef {object} Seen an avatar before the eyes
 * @property {number} distance metres
 * @property {number} texel pixels along a side of a texel of its finest level
 * @property {number[]} counts splats by level, the finest first
 * @property {number} shown level at present
 */

const LARGEST_TEXEL = 0.65; // pixels along a side; texels up to this size look like smaller ones
const LARGEST_TRIANGLE = 32; // pixels of a quad, about; up to this size one triangle costs less than two halves
const HYSTERESIS = 1.15; // times: texels must look so much larger before a finer level comes back

/** Metres of a box from the middle of the eyes, and pixels along a side of a texel of so many metres at its nearest point. @param {number} length @param {number[]} box @param {import("./camera.js").Camera[]} cameras */
export function texelPixels(length, box, cameras) {
  const [{ projection, screen, near }] = cameras;
  const middle = middleOf(cameras);
  const apart = middle.map((at, axis) => Math.max(box[axis] - at, at - box[3 + axis], 0));
  const distance = Math.hypot(...apart);
  return { distance, texel: (length * projection[5] * screen[1]) / 2 / Math.max(distance, near) };
}

/** Vertices by which each splat is drawn: 3 where splats are small, one triangle around the quad; else 6, its halves. Both make the same picture. @param {number[][]} boxes of the avatars in view @param {number} splats of all of them @param {import("./camera.js").Camera[]} cameras */
export function splatCorners(boxes, splats, cameras) {
  const [{ projection, screen, near }] = cameras;
  const middle = middleOf(cameras);
  let covered = 0; // the squares on the diagonals of the boxes: about what all quads cover
  for (const box of boxes) {
    const away = Math.hypot(...middle.map((at, axis) => (box[axis] + box[3 + axis]) / 2 - at));
    const diagonal = Math.hypot(...middle.map((_, axis) => box[3 + axis] - box[axis]));
    covered += ((diagonal * projection[5] * screen[1]) / 2 / Math.max(away, near)) ** 2;
  }
  return covered <= LARGEST_TRIANGLE * splats ? 3 : 6;
}

/** The place between the eyes, metres. */
function middleOf(/** @type {import("./camera.js").Camera[]} */ cameras) {
  return [0, 1, 2].map((axis) => cameras.reduce((sum, { position }) => sum + position[axis], 0) / cameras.length);
}

/** The coarsest level with texels up to LARGEST_TEXEL pixels; one that is shown stays until they are a little larger. @param {Seen} seen */
export function chooseLevel({ texel, counts, shown }) {
  let level = 0;
  for (let coarser = 1; coarser < counts.length; coarser++)
    if (texel * 2 ** coarser <= LARGEST_TEXEL * (coarser <= shown ? HYSTERESIS : 1)) level = coarser;
  return level;
}

/**
 * A level for each, no finer than it is worth: the nearest first has what it is worth, as far as the budget goes. Every other
 * one is kept the splats of its coarsest level; where not even these fit, all are at their coarsest. Of two that are about as
 * near, the one that is shown finer now counts as nearer, so that they do not swap to and fro.
 * @param {Seen[]} avatars @param {number | null} budget splats of all together @returns {number[]}
 */
export function chooseLevels(avatars, budget) {
  const worth = avatars.map(chooseLevel);
  if (budget === null) return worth;
  const levels = avatars.map(({ counts }) => counts.length - 1);
  const least = (/** @type {number} */ i) => avatars[i].counts[levels[i]];
  let spare = budget - avatars.reduce((sum, _, i) => sum + least(i), 0);
  const rank = avatars.map(({ distance, shown }) => distance * HYSTERESIS ** shown);
  for (const i of avatars.map((_, i) => i).toSorted((a, b) => rank[a] - rank[b])) {
    const { counts } = avatars[i];
    const more = counts.map((count) => count - least(i));
    const level = counts.findIndex((_, level) => level >= worth[i] && more[level] <= spare);
    if (level < 0) continue;
    levels[i] = level;
    spare -= more[level];
  }
  return levels;
}
