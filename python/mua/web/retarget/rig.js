// Another figure's skeleton, whose poses a page hands over as they come.

import { AvatarError } from "../error.js";
import { inward, outward } from "../pose.js";
import { rolesOf } from "./joint_names.js";
import { retargeter } from "./retarget.js";
import { localOf } from "./source.js";

/** @typedef {import("./types.js").RigInfo} RigInfo */
/** @typedef {import("./types.js").Follow} Follow */

/** What turns a rig's poses into an avatar's. @param {import("../format/read.js").Avatar | undefined} avatar @param {RigInfo} rig @param {{mapping?: Record<string, string>}} [options] @returns {Follow} */
export function follow(avatar, rig, { mapping = {} } = {}) {
  if (!avatar) throw fault("the avatar was taken away");
  const { names, parents } = rig ?? {};
  if (!names || !parents) throw fault("expected names, parents, rotations and positions of joints");
  const late = parents.findIndex((parent, joint) => !(Number.isInteger(parent) && parent < joint));
  if (!names.length || parents.length !== names.length || late >= 0)
    throw fault(`parents: expected one of each of ${names.length} joints, before the joint itself; -1 for none`);
  const rest = checked(rig, names.length);
  const above = Int32Array.from(parents);
  const local = localOf(above, rest.turned, rest.at);
  const bones = {
    names,
    parents: above,
    root: 0,
    bindRotations: local.rotations,
    bindTranslations: local.translations,
  };
  bones.root = rolesOf(bones).hips[0];
  const turn = retargeter(bones, avatar, mapping);
  return (rotations, positions) => {
    const { turned, at } = checked({ rotations, positions }, names.length);
    const pose = turn(turned, at);
    return { rotations: outward(pose.rotations), translations: Float32Array.from(pose.translations) };
  };
}

const fault = (/** @type {string} */ sentence) => new AvatarError(`retarget: ${sentence}.`);

/** @param {Pick<RigInfo, "rotations" | "positions">} given @param {number} joints */
function checked({ rotations, positions }, joints) {
  for (const [field, values, width] of /** @type {const} */ ([
    ["rotations", rotations, 4],
    ["positions", positions, 3],
  ])) {
    if (values?.length !== width * joints)
      throw fault(`${field} holds ${values?.length ?? "no"} numbers, expected ${width} of each of ${joints} joints`);
    const wrong = Array.from(values).find((value) => !Number.isFinite(value));
    if (wrong !== undefined) throw fault(`${field}: expected finite numbers, found ${wrong}`);
  }
  return { turned: inward(rotations), at: Float64Array.from(positions) };
}
