// Which expressions of an avatar those of a motion or a tracker move, and how much. Reference: python/mua/pose/expression_names.py.

import { TABLE } from "./table.js";

const WORD = /[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|(?:(?![A-Za-z])[\p{L}\p{Nl}\p{No}])+/gu;
const SIDE = new Map([
  ["l", "left"],
  ["r", "right"],
  ["left", "left"],
  ["right", "right"],
]);
const VOCABULARIES = [TABLE.vrm, TABLE.visemes, TABLE.arkit, TABLE.pairsAndHalves]; // where a source has several, an expression follows the first
const SIDED = new Set([...TABLE.arkit, ...TABLE.pairsAndHalves]);
const STAND_INS = new Map(Object.entries(TABLE.standIns));
const BY_SPELLING = new Map(VOCABULARIES.flat().map((name) => [spelt(name), name]));
const BY_OTHER_NAME = new Map(Object.entries(TABLE.otherNames).map(([other, name]) => [spelt(other), name]));

/** A name in one spelling, less words before it that only say whose it is. */
function spelt(/** @type {string} */ name) {
  const own = name.normalize("NFKC").split(".").at(-1) ?? "";
  const words = (own.match(WORD) ?? []).map((word) => word.toLowerCase());
  while (words.length > 1 && TABLE.owners.includes(words[0])) words.shift();
  if (words.length > 1 && SIDE.has(words[0])) words.push(/** @type {string} */ (words.shift()));
  if (words.length > 1) words.push(/** @type {string} */ (withSide(words.pop())));
  return words.join("");
}

function withSide(/** @type {string | undefined} */ word) {
  return SIDE.get(word ?? "") ?? word;
}

/** The expression of a vocabulary that a name means, in whatever spelling. @returns {string | undefined} */
export function knownExpression(/** @type {string} */ name) {
  const spelling = spelt(name);
  const known = BY_SPELLING.get(spelling) ?? BY_OTHER_NAME.get(spelling);
  const [, whole, side] = (!known && spelling.match(/^(.*)(left|right)$/)) || [];
  const both = BY_OTHER_NAME.get(whole ?? "");
  return both ? BY_SPELLING.get(spelt(`${both}_${side}`)) : known;
}

/** How much [E, S] each expression of a source moves each of an avatar. @param {string[]} names of the avatar's @param {string[]} source @returns {Float32Array} */
export function matchExpressions(names, source) {
  const matrix = new Float32Array(names.length * source.length);
  const rows = rowsOf(names);
  const known = source.map(knownExpression);
  const direct = source.map((name, column) => {
    const row = names.indexOf(name);
    return row < 0 ? (rows.get(known[column] ?? "") ?? -1) : row;
  });
  /** @type {Map<number, {rank: number, shares: [number, number][]}>} by row: columns and shares of the first vocabulary */
  const found = new Map();
  for (const [column, row] of direct.entries()) {
    if (row >= 0) matrix[row * source.length + column] = 1;
    else
      for (const [other, share] of nearest(known[column] ?? "", rows)) {
        const row = /** @type {number} */ (rows.get(other));
        if (direct.includes(row)) continue;
        const rank = VOCABULARIES.findIndex((vocabulary) => vocabulary.includes(known[column] ?? ""));
        const held = found.get(row);
        if (!held || rank < held.rank) found.set(row, { rank, shares: [[column, share]] });
        else if (rank === held.rank) held.shares.push([column, share]);
      }
  }
  for (const [row, { shares }] of found)
    for (const [column, share] of shares) matrix[row * source.length + column] = share;
  return matrix;
}

/** Weights [E] of an avatar's expressions, held to 0 to 1. @param {Float32Array} matrix [E, S] @param {ArrayLike<number>} weights [S] of the source's */
export function weighted(matrix, weights) {
  return Float32Array.from({ length: matrix.length / weights.length }, (_, row) => {
    let sum = 0;
    for (let column = 0; column < weights.length; column++)
      sum += matrix[row * weights.length + column] * weights[column];
    return Math.min(Math.max(sum, 0), 1);
  });
}

/** The row of each known expression among an avatar's: of several names for it, that of the nearest. */
function rowsOf(/** @type {string[]} */ names) {
  const rows = new Map();
  const order = names.map((name, row) => ({ row, name, likeness: likeness(name) }));
  for (const { row, name } of order.sort((a, b) => a.likeness - b.likeness)) {
    const known = knownExpression(name);
    if (known && !rows.has(known)) rows.set(known, row);
  }
  return rows;
}

/** 0 for another spelling of an expression's name, 2 for one with the same meaning, one more where it has a number. */
function likeness(/** @type {string} */ name) {
  return 2 * Number(!BY_SPELLING.has(spelt(name))) + Number(/\p{Nd}/u.test(name.split(".").at(-1) ?? ""));
}

/** What an avatar has of the first set that stands for an expression. @param {string} known "" for none @param {Map<string, number>} rows @returns {[string, number][]} */
function nearest(known, rows) {
  const sided = [{ [`${known}Left`]: 1, [`${known}Right`]: 1 }, { [known.replace(/(Left|Right)$/, "")]: 0.5 }];
  const own = sided.filter((set) => Object.keys(set).every((name) => SIDED.has(name)));
  for (const set of [...own, ...(STAND_INS.get(known) ?? [])]) {
    const there = Object.entries(set).filter(([other]) => rows.has(other));
    if (there.length) return there;
  }
  return [];
}
