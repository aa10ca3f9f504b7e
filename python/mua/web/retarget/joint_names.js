// The body part and side of a joint by its name, whatever program named it. Reference: python/mua/pose/joint_names.py, whose
// words are joint_words.js.

import { WORDS } from "./joint_words.js";

/** @typedef {{names: string[], parents: Int32Array, root: number}} Named joints, parents first */
/** @typedef {Record<string, number[]>} Roles the joints of every role, from the root outwards */

export const SIDES = ["left", "right"];
export const FINGERS = ["thumb", "index", "middle", "ring", "pinky"];
const LIMBS = SIDES.flatMap((side) => ["upper_arm", "forearm", "thigh", "shin"].map((part) => `${side} ${part}`));
const LIMBS_NAMED = 6; // of these, which names that are understood tell at least
/** @type {Record<string, string>} */
const BELOW = { upper_arm: "forearm", forearm: "hand", thigh: "shin", shin: "foot" };
export const NAMESPACE = /^.*[:|]/;
const RIG_PREFIX =
  /^(valvebiped\.)?((mixamorig\d*|bip\d+)[\s_.-]?|(cc_base|def|j_bip(_c)?|b|j|jnt|joint|character\d*|quickrigcharacter\d*|skeleton|armature)[\s_.-])/i;
const WORD = /[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+/g;
const FBX_ESCAPE = /FBXASC(\d{3})/g; // Maya writes characters that names may not have by their code
const OWNER = /^[\p{L}\p{N}]+[_\s.-]+/u; // the word before a joint's own name
const LAST_WORD = /([A-Z][a-z]*|[a-z]+)$/;
const NUMBERED_FINGER = /finger[\s_.-]?(\d)/i;
// biome-ignore lint/suspicious/noControlCharactersInRegex: these are what ASCII is
const ASCII = /^[\x00-\x7f]*$/;

/** The joints above one, nearest first. */
export function ancestors(/** @type {{parents: Int32Array}} */ { parents }, /** @type {number} */ joint) {
  const found = [];
  for (let above = parents[joint]; above >= 0; above = parents[above]) found.push(above);
  return found;
}

/** Joints of every role: from the file where it states them, else from the names. @param {Named} skeleton @param {Record<string, string>} [stated] joint name to role @returns {Roles} */
export function rolesOf(skeleton, stated = {}) {
  /** @type {Roles} */
  const found = {};
  const names = withoutOwner(skeleton.names);
  const first = firstFinger(names);
  for (const [joint, name] of names.entries()) {
    const role = roleOf(name, first);
    if (role) found[role] = [...(found[role] ?? []), joint];
  }
  for (const side of SIDES) {
    settleSide(found, side);
    leaveOutTargets(skeleton, found, side);
  }
  for (const role of Object.keys(found)) found[role] = oneChain(skeleton, found[role]);
  const chains = withStated(skeleton.names, found, stated);
  keepToLimbs(skeleton, chains);
  settleLegs(skeleton, chains);
  settleTrunk(skeleton, chains);
  return chains;
}

/** The names less the figure's own before them, as in UnityChan_LeftArm, where they tell arms and legs only without it. */
function withoutOwner(/** @type {string[]} */ names) {
  /** @type {Map<string, number>} */
  const starts = new Map();
  for (const name of names) {
    const start = OWNER.exec(name)?.[0];
    if (start) starts.set(start, (starts.get(start) ?? 0) + 1);
  }
  const sorted = names.toSorted((a, b) => (a < b ? -1 : Number(a > b)));
  const [low, high] = [sorted[0] ?? "", sorted.at(-1) ?? ""];
  let shared = 0;
  while (shared < low.length && low[shared] === high[shared]) shared += 1;
  const common = low.slice(0, shared);
  const most = [...starts].toSorted((a, b) => b[1] - a[1]).slice(0, 2);
  for (const owner of ["", common, common.replace(LAST_WORD, ""), ...most.map(([start]) => start)]) {
    const bare = names.map((name) => (name.startsWith(owner) && name.slice(owner.length)) || name);
    const first = firstFinger(bare);
    const told = new Set(bare.map((name) => roleOf(name, first)));
    if (LIMBS.filter((limb) => told.has(limb)).length >= LIMBS_NAMED) return bare;
  }
  return names;
}

/** @param {string[]} names @param {Roles} found @param {Record<string, string>} stated @returns {Roles} */
function withStated(names, found, stated) {
  /** @type {Roles} */
  const filed = {};
  for (const [joint, name] of names.entries())
    if (Object.hasOwn(stated, name)) filed[stated[name]] = [...(filed[stated[name]] ?? []), joint];
  const taken = new Set(Object.values(filed).flat());
  const left = Object.entries(found)
    .map(([role, joints]) => /** @type {const} */ ([role, joints.filter((joint) => !taken.has(joint))]))
    .filter(([role, joints]) => joints.length && !filed[role]);
  return { ...Object.fromEntries(left), ...filed };
}

/** @returns {string | null} */
function roleOf(/** @type {string} */ filed, /** @type {number} */ first) {
  const name = withoutAccents(filed.replace(FBX_ESCAPE, (_, code) => String.fromCharCode(Number(code))));
  if (!ASCII.test(name)) return wideRole(name);
  const bare = name.replace(NAMESPACE, "").replace(RIG_PREFIX, "");
  const words = (bare.match(WORD) ?? []).map((word) => word.toLowerCase());
  const sideWords = words.some((word) => has(WORDS.side, word)) ? WORDS.side : WORDS.foreignSide;
  let sides = words.filter((word) => has(sideWords, word)).map((word) => sideWords[word]);
  const kept = words.filter((word) => !has(sideWords, word) && !WORDS.noPart.includes(word));
  let part = kept.join("");
  const backward = kept.toReversed().join("");
  for (const side of SIDES)
    if (!sides.length && !has(WORDS.central, part) && (part.startsWith(side) || part.endsWith(side)))
      [sides, part] = [[side], part.replace(new RegExp(`^${side}`), "").replace(new RegExp(`${side}$`), "")];
  if (!sides.length && has(WORDS.side, part[0] ?? "") && has(WORDS.sided, part.slice(1)))
    [sides, part] = [[WORDS.side[part[0]]], part.slice(1)]; // lhumerus, rfoot, lindex
  if (sides.length !== 1) return sides.length ? null : (get(WORDS.central, part) ?? get(WORDS.central, backward));
  const numbered = NUMBERED_FINGER.exec(bare);
  if (numbered) {
    const finger = FINGERS[Number(numbered[1]) - first];
    return finger ? `${sides[0]} ${finger}` : null;
  }
  const found = get(WORDS.sided, part) ?? get(WORDS.sided, backward); // armUpper
  return found && `${sides[0]} ${found}`;
}

const has = (/** @type {Record<string, string>} */ words, /** @type {string} */ word) => Object.hasOwn(words, word);
const get = (/** @type {Record<string, string>} */ words, /** @type {string} */ word) =>
  has(words, word) ? words[word] : null;

/** The name in ASCII where only accents and the German ß are not. */
function withoutAccents(/** @type {string} */ name) {
  const plain = [...name.replaceAll("ß", "ss").normalize("NFKD")].filter((letter) => ASCII.test(letter)).join("");
  return plain.length >= [...name].length ? plain : name;
}

/** The role of a Chinese or Japanese name, whose digits may be wide ones; longer names are helper joints. */
function wideRole(/** @type {string} */ name) {
  const part = name
    .normalize("NFKC")
    .trim()
    .replace(/[0-9]+$/, "");
  const side = get(WORDS.wideSide, part[0] ?? "");
  const found = side ? get(WORDS.wideSided, part.slice(1)) : get(WORDS.wideCentral, part);
  return side && found ? `${side} ${found}` : found;
}

/** The number of the thumb where fingers are numbered: 0 in bipeds of 3ds Max, else 1. */
function firstFinger(/** @type {string[]} */ names) {
  const numbers = names.flatMap((name) => NUMBERED_FINGER.exec(name)?.[1] ?? []).map(Number);
  return numbers.length ? Math.min(...numbers) : 1;
}

/** Settle names whose part depends on their neighbours: SMPL's foot is the toe, its shoulder the upper arm. */
function settleSide(/** @type {Roles} */ found, /** @type {string} */ side) {
  const rename = (/** @type {string} */ old, /** @type {string} */ name) => {
    const joints = found[`${side} ${old}`];
    delete found[`${side} ${old}`];
    if (joints) found[`${side} ${name}`] = [...(found[`${side} ${name}`] ?? []), ...joints].toSorted((a, b) => a - b);
  };
  if (found[`${side} ankle`]) {
    rename("foot", "toe");
    rename("ankle", "foot");
  }
  if (!found[`${side} upper_arm`]) rename("shoulder", "upper_arm");
  rename("collar", "shoulder");
  if (!found[`${side} thigh`]) rename("hip", "thigh");
  delete found[`${side} hip`];
}

/** Drop IK targets: joints that share a name with joints of the limb but do not hang on the limb above. @param {Named} skeleton @param {Roles} found @param {string} side */
function leaveOutTargets(skeleton, found, side) {
  for (const [upper, lower] of Object.entries(BELOW)) {
    const above = found[`${side} ${upper}`] ?? [];
    const hanging = (found[`${side} ${lower}`] ?? []).filter((joint) =>
      ancestors(skeleton, joint).some((one) => above.includes(one)),
    );
    if (hanging.length) found[`${side} ${lower}`] = hanging;
  }
}

/** Leave twist joints out of a limb: they share its name but are not on the way to its end. @param {Named} skeleton @param {Roles} chains */
function keepToLimbs(skeleton, chains) {
  for (const [role, joints] of Object.entries(chains)) {
    const [side, part] = role.split(" ");
    const below = chains[`${side} ${BELOW[part]}`];
    const kept = below ? joints.filter((joint) => ancestors(skeleton, below[0]).includes(joint)) : joints;
    if (kept.length) chains[role] = kept;
  }
}

/** A leg above a knee, or one that hangs on what carries the other too, is the thigh; the last of a foot's joints its toe. @param {Named} skeleton @param {Roles} chains */
function settleLegs(skeleton, chains) {
  const shins = SIDES.flatMap((side) => chains[`${side} shin`]?.slice(0, 1) ?? []);
  const carrying = shins.length === 2 ? shared(skeleton, shins) : [];
  for (const side of SIDES) {
    const [shin, foot] = ["shin", "foot"].map((part) => chains[`${side} ${part}`] ?? []);
    if (!chains[`${side} thigh`] && shin.length && (shin.length > 1 || carrying.includes(skeleton.parents[shin[0]])))
      [chains[`${side} thigh`], chains[`${side} shin`]] = [shin.slice(0, 1), shin.slice(1)];
    if (!chains[`${side} shin`]?.length) delete chains[`${side} shin`];
    if (foot.length > 1 && !chains[`${side} toe`])
      [chains[`${side} foot`], chains[`${side} toe`]] = [foot.slice(0, -1), foot.slice(-1)];
  }
}

/** The joints that are above all of some, nearest first. */
function shared(/** @type {Named} */ skeleton, /** @type {number[]} */ joints) {
  const [first, ...others] = joints.map((joint) => ancestors(skeleton, joint));
  return first.filter((joint) => others.every((other) => other.includes(joint)));
}

/** Hips carry both legs and the spine; the spine ends where the arms begin, and neck and head go on from there. @param {Named} skeleton @param {Roles} chains */
function settleTrunk(skeleton, chains) {
  const first = (/** @type {string} */ part) => SIDES.flatMap((side) => chains[`${side} ${part}`]?.slice(0, 1) ?? []);
  const [legs, arms] = [first("thigh"), first("upper_arm")];
  const carrying = legs.length === 2 ? shared(skeleton, legs) : [];
  let spine = chains.spine ?? [];
  const below = spine.filter((joint) => carrying.includes(joint));
  if (below.length && !chains.hips) chains.hips = below;
  let hips = chains.hips ?? [skeleton.root];
  if (carrying.length && !hips.some((joint) => carrying.includes(joint))) {
    const above = carrying.filter((joint) => ancestors(skeleton, hips[0]).includes(joint));
    if (above.length) hips = [Math.max(...above), ...hips];
  }
  chains.hips = hips;
  spine = spine.filter((joint) => !hips.includes(joint));
  const reach = arms.length ? arms.flatMap((arm) => ancestors(skeleton, arm)) : spine;
  const beyond = spine.some((joint) => reach.includes(joint)) ? spine.filter((joint) => !reach.includes(joint)) : [];
  if (beyond.length > 1 && !chains.neck && !chains.head) {
    chains.neck = beyond;
    spine = spine.filter((joint) => !beyond.includes(joint));
  }
  const { neck = [], head } = chains;
  if (neck.length > 1 && !head) [chains.neck, chains.head] = [neck.slice(0, -1), neck.slice(-1)];
  chains.spine = spine.length ? spine : unnamedSpine(skeleton, chains, arms);
  if (!chains.spine.length) delete chains.spine;
}

/** The joints from the hips to where both arms branch off, whatever they are called, or a body that carries arms and hips. @param {Named} skeleton @param {Roles} chains @param {number[]} arms */
function unnamedSpine(skeleton, chains, arms) {
  if (arms.length < 2) return [];
  const hips = /** @type {number} */ (chains.hips.at(-1));
  const carrying = shared(skeleton, arms);
  const known = Object.values(chains).flat();
  const above = carrying.filter((joint) => !known.includes(joint) && ancestors(skeleton, joint).includes(hips));
  if (above.length) return above.toSorted((a, b) => a - b);
  const nearest = Math.max(...carrying);
  return carrying.length && ancestors(skeleton, hips).includes(nearest) ? [nearest] : [];
}

function oneChain(/** @type {Named} */ skeleton, /** @type {number[]} */ joints) {
  const chain = joints.slice(0, 1);
  for (const joint of joints.slice(1))
    if (ancestors(skeleton, joint).includes(/** @type {number} */ (chain.at(-1)))) chain.push(joint);
  return chain;
}
