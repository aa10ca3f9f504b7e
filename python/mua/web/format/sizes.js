// What a file claims by numbers alone, refused before any tensor is opened: how many of each part, how large a texture.
// Reference: python/mua/asset/sizes.py.

import {
  MAX_CLIPS,
  MAX_DETAIL_LEVELS,
  MAX_EXPRESSIONS,
  MAX_JOINTS,
  MAX_LAYERS,
  MAX_LEVELS,
  MAX_SIDE,
  MOST_TAPS,
  TEXTURE_ROOM,
  TEXTURE_TIMES,
} from "./limits.js";
import { refuse } from "./parser.js";

/** @typedef {import("./parser.js").Tree} Tree */

export function checkSizes(/** @type {Tree} */ tree) {
  const { levels, rec_lo: taps } = tree.wavelet;
  const [geometry, appearance] = [tree.geometry.details.length, tree.appearance.details.length];
  check("skeleton.names", tree.skeleton.names.length, 0, MAX_JOINTS);
  check("wavelet.levels", levels, 1, MAX_LEVELS);
  checkTexture(tree.texels, levels);
  for (const part of ["coarse", "geometry", "appearance"]) check(`${part}.mlp`, tree[part].mlp.length, 0, MAX_LAYERS);
  check("geometry.details", geometry, 0, levels);
  check("appearance.details", appearance, 0, levels);
  const most = taps.length > MOST_TAPS ? 0 : Math.min(MAX_DETAIL_LEVELS, levels - Math.max(geometry, appearance));
  check("texels.levels", tree.texels.levels.length, 0, most);
  check("clips", tree.clips.length, 0, MAX_CLIPS);
  check("expressions.names", tree.expressions?.names.length ?? 0, 0, MAX_EXPRESSIONS);
}

/** Its memory goes with its sides, which a few bytes could claim: so many must be valid. */
function checkTexture(/** @type {Tree} */ { size, texels }, /** @type {number} */ levels) {
  const count = texels.shape[0] ?? 0;
  check("texels.size", size, 1, MAX_SIDE);
  if (size % 2 ** levels) throw refuse("texels.size", `${size} does not halve ${levels} times`);
  if (size * size > TEXTURE_TIMES * count + TEXTURE_ROOM)
    throw refuse("texels.size", `${size}, too large for ${count} valid texels`);
}

function check(
  /** @type {string} */ field,
  /** @type {number} */ number,
  /** @type {number} */ least,
  /** @type {number} */ most,
) {
  if (number < least || number > most) throw refuse(field, `${number}, expected ${least} to ${most}`);
}
