// What a page poses an avatar with, and what it learns of it: types alone, which nothing loads.

/**
 * @typedef {object} SkeletonInfo joints in an order in which parents come first, and the bind pose
 * @property {string[]} names
 * @property {number[]} parents -1 for none
 * @property {number} root the joint whose path is the avatar's
 * @property {Float32Array} rotations [J, 4] in their parents, x y z w
 * @property {Float32Array} translations [J, 3] in their parents, metres
 */

/** @typedef {ArrayLike<number> | Readonly<Record<string, ArrayLike<number>>>} JointNumbers of all joints one after the other, or of some by name */

/**
 * @typedef {object} PoseInput joints in their parents, as in SkeletonInfo; what is left out is as in the bind pose
 * @property {JointNumbers} [rotations] x y z w each
 * @property {JointNumbers} [translations] x y z each, metres
 * @property {ArrayLike<number>} [expressions] weights, in the order of the avatar's
 */

/** @typedef {string | ArrayBuffer | Blob} MotionSource address, content or file */

/**
 * @typedef {object} PlayClipOptions
 * @property {string} [name] of the clip; that of the file if left out. A clip of that name is replaced
 * @property {boolean} [loop] whether it starts over at its end; true if left out
 * @property {string} [animation] which one of a glTF file; the first that moves a joint if left out
 * @property {Record<string, string>} [mapping] joint of the avatar to joint of the motion, where names do not tell them
 */

/** @typedef {import("../player.js").ClipInfo & {notes: string[]}} PlayedClip notes: what was left out or decided, a sentence each */

/**
 * @typedef {object} RigInfo another figure's skeleton, at rest: a body that stands, as in a T-pose
 * @property {string[]} names
 * @property {number[]} parents -1 for none; parents come first
 * @property {ArrayLike<number>} rotations [S, 4] in the world, x y z w
 * @property {ArrayLike<number>} positions [S, 3] in the world
 */

/** @typedef {(rotations: ArrayLike<number>, positions: ArrayLike<number>) => PoseInput} Follow the pose of an avatar, from joints of another figure in the world, as in RigInfo */

export {};
