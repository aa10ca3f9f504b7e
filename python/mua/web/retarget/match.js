// Which joint of a motion moves which joint of an avatar: by a mapping, by roles, by equal names. Reference:
// python/mua/motion/match.py, of joints that their names tell.

import { AvatarError } from "../error.js";
import { FINGERS, NAMESPACE, rolesOf, SIDES } from "./joint_names.js";

/** @typedef {import("./joint_names.js").Roles} Roles */
/** @typedef {import("./source.js").Bones} Bones */
/** @typedef {{chains: Map<number, [number, number]>, roles: Roles, sourceRoles: Roles}} Matches chains: target joint to the first and last source joint of what moves it; roles: of the target */

const LIMBS = [
  ...SIDES.flatMap((side) => [
    { name: `${side} arm`, parts: [`${side} upper_arm`, `${side} forearm`] },
    { name: `${side} leg`, parts: [`${side} thigh`, `${side} shin`] },
  ]),
  { name: "spine", parts: ["spine"] },
];
const SAME_RIG = 0.8; // of the target's joints: with as many equal names, motion and avatar are of one kind of rig

/** @param {Bones} source @param {Bones} target @param {Record<string, string>} mapping target to source joint names @param {Record<string, string>} stated roles that the source's file states, by joint @returns {Matches} */
export function matchJoints(source, target, mapping, stated) {
  const chains = equalNames(source, target);
  const alike = chains.size;
  const [sourceRoles, roles] = [rolesOf(source, stated), rolesOf(target)];
  for (const side of SIDES) {
    const [thumb, ...fingers] = FINGERS.map((finger) => `${side} ${finger}`);
    if (!fingers.some((finger) => sourceRoles[finger])) delete sourceRoles[thumb]; // a marker of optical motion capture
  }
  for (const [role, joints] of Object.entries(roles)) {
    const chain = sourceRoles[role] ?? [];
    for (const [i, joint] of chain.length ? joints.entries() : []) {
      const first = Math.floor((i * chain.length) / joints.length);
      chains.set(joint, [chain[first], chain[Math.ceil(((i + 1) * chain.length) / joints.length) - 1]]);
    }
  }
  addMapped(source, target, roles, sourceRoles, mapping);
  for (const [name, from] of Object.entries(mapping)) {
    if (!from) continue; // one that nothing was found for
    const chosen = indexOf(source, from, "the motion");
    chains.set(indexOf(target, name, "the avatar"), [chosen, chosen]);
  }
  const matches = { chains, roles, sourceRoles };
  if (alike < SAME_RIG * target.names.length && !Object.keys(mapping).length) requireLimbs(matches);
  return matches;
}

/** Let mapped joints without a role take over that of the joint which moves them. @param {Bones} source @param {Bones} target @param {Roles} roles @param {Roles} sourceRoles @param {Record<string, string>} mapping */
function addMapped(source, target, roles, sourceRoles, mapping) {
  const known = new Set(Object.values(roles).flat());
  /** @type {Roles} */
  const added = {};
  for (const [name, from] of Object.entries(mapping)) {
    const [joint, mover] = [target.names.indexOf(name), source.names.indexOf(from)];
    const role = Object.keys(sourceRoles).findLast((one) => sourceRoles[one].includes(mover));
    if (role && joint >= 0 && !known.has(joint) && !roles[role]) added[role] = [...(added[role] ?? []), joint];
  }
  for (const [role, joints] of Object.entries(added)) roles[role] = joints.toSorted((a, b) => a - b);
}

function requireLimbs(/** @type {Matches} */ { chains, roles }) {
  const missing = LIMBS.filter(({ parts }) => !parts.every((part) => roles[part]?.some((joint) => chains.has(joint))));
  const spineless = !roles.spine && roles["left upper_arm"]; // arms that grow straight out of the hips
  const names = missing.map(({ name }) => name).filter((name) => name !== "spine" || !spineless);
  if (!names.length) return;
  const sentence = `nothing of it is known to move the avatar's ${names.join(", ")}; pair their joints by the option mapping`;
  throw new AvatarError(`${sentence}, { "joint of the avatar": "joint of the motion" }.`);
}

/** @param {Bones} bones @param {string} name @param {string} owner */
function indexOf({ names }, name, owner) {
  const joint = names.indexOf(name);
  if (joint >= 0) return joint;
  const shown = names.length > 6 ? `${names.slice(0, 6).join(", ")}, ... ${names.length} in all` : names.join(", ");
  throw new AvatarError(`mapping: ${owner} has no joint "${name}", only ${shown}.`);
}

/** @returns {Map<number, [number, number]>} */
function equalNames(/** @type {Bones} */ source, /** @type {Bones} */ target) {
  const plain = (/** @type {Bones} */ { names }) =>
    names.map((name) =>
      name
        .replace(NAMESPACE, "")
        .toLowerCase()
        .replace(/[^a-z0-9]/g, ""),
    );
  const places = new Map(plain(source).map((name, joint) => [name, joint]));
  /** @type {Map<number, [number, number]>} */
  const found = new Map();
  for (const [joint, name] of plain(target).entries()) {
    const place = places.get(name);
    if (place !== undefined) found.set(joint, [place, place]);
  }
  return found;
}
