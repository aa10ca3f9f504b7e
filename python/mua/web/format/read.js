// A `.muaavatar` file: every offset, shape, range and value is checked before an avatar leaves here, with the code, field
// and sentence of the Python reader. Reference: python/mua/asset/read.py.

import { checksum } from "./checksum.js";
import { readExpressions, readWeights } from "./expressions.js";
import { LARGEST_RATE, LEAST_RATE, LEAST_SCALE, MAX_ADDED, MAX_FRAMES, MAX_WINDOW, STAGES } from "./limits.js";
import { checkMagnitude } from "./magnitude.js";
import { readBranch, readCoarse, readWavelet } from "./model.js";
import { general, shortest } from "./numbers.js";
import { unpack } from "./packing.js";
import { AGAIN, fault, parse, refuse } from "./parser.js";
import { besideRoot, readSkeleton, readSurface, readTemplate, readTexels, translated, unit } from "./rig.js";
import { checkSizes } from "./sizes.js";
import { leaveOut } from "./stages.js";
import { expanded, reals, someTensor } from "./tensors.js";

/** @typedef {import("./parser.js").Tree} Tree */
/** @typedef {import("./rig.js").Skeleton} Skeleton */

const GEOMETRY_CHANNELS = 11;
const APPEARANCE_CHANNELS = 12;
const PNG_SIGNATURE = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];

/** @typedef {ReturnType<typeof decode>} Avatar what a file holds; arrays are views of its bytes where they can be */
/** @typedef {import("../clip.js").Clip} Clip */
/** @typedef {ReturnType<typeof readEncoding>} Encoding */

/** The avatar in a file's bytes. @throws {import("../error.js").AvatarError} that names the field */
export async function read(/** @type {ArrayBuffer} */ content) {
  const { tree, crcAt } = parse(content);
  checkSum(content, tree, crcAt);
  checkStages(tree.stages, content.byteLength);
  checkSizes(tree);
  await unpack(tree, content.byteLength);
  return decode(tree);
}

/**
 * What the first `end` bytes of a file show, a stage of it: the mean mesh in motion, then splats, of which what is not there yet
 * is zeros. All is checked but the checksum, which only the whole file has.
 * @param {ArrayBuffer} content @param {number} end
 */
export async function readStage(content, end) {
  const part = new Uint8Array(content.byteLength);
  part.set(new Uint8Array(content, 0, end));
  const { tree } = parse(part.buffer);
  checkStages(tree.stages, part.length);
  checkSizes(tree);
  leaveOut(tree, end);
  await unpack(tree, part.length, end);
  return decode(tree);
}

function checkSum(/** @type {ArrayBuffer} */ content, /** @type {Tree} */ tree, /** @type {number | undefined} */ at) {
  if (at === undefined) throw fault("missing", "crc32", "the field is required and absent");
  const found = checksum(new Uint8Array(content), at);
  const hex = (/** @type {number} */ sum) => sum.toString(16).padStart(8, "0");
  if (found !== tree.crc32) {
    const sentence = `${hex(tree.crc32)}, but the content gives ${hex(found)}: the file is damaged; ${AGAIN}`;
    throw fault("checksum", "crc32", sentence);
  }
}

function checkStages(/** @type {Uint32Array | undefined} */ ends, /** @type {number} */ size) {
  if (!ends) return;
  const list = Array.from(ends);
  if (list.length !== STAGES || list.some((end, i) => end > size || (i > 0 && end < list[i - 1])))
    throw refuse("stages", `[${list.join(", ")}], expected ${STAGES} rising numbers up to the file's ${size} bytes`);
}

function decode(/** @type {Tree} */ tree) {
  const skeleton = readSkeleton(tree.skeleton);
  const joints = skeleton.names.length;
  const encoding = readEncoding(tree.encoding, skeleton);
  const inputs = encoding.margins.length;
  const wavelet = readWavelet(tree.wavelet);
  const coarse = readCoarse(tree.coarse, inputs);
  const template = readTemplate(tree.template, coarse.vertices, joints);
  const texels = readTexels(tree.texels, template);
  const side = Math.floor(texels.size / 2 ** wavelet.levels);
  const of = { count: texels.texels.length, inputs, size: side };
  const geometry = readBranch(tree.geometry, "geometry", GEOMETRY_CHANNELS, of);
  const appearance = readBranch(tree.appearance, "appearance", APPEARANCE_CHANNELS, of);
  checkMagnitude(encoding, wavelet, coarse, { geometry, appearance });
  const { names: expressions, targets } = readExpressions(tree.expressions, coarse.vertices);
  const clips = readClips(tree.clips, skeleton, expressions.length, encoding.rate);
  const bounds = readBounds(tree.bounds);
  const { name, producer, notes } = /** @type {Record<string, string>} */ (tree);
  const thumbnail = readThumbnail(tree.thumbnail);
  const surface = readSurface(tree.surface, texels);
  const model = { skeleton, encoding, wavelet, coarse, template, texels, geometry, appearance, surface, targets };
  return { name, producer, notes, ...model, clips, bounds, thumbnail, expressions };
}

function readEncoding(/** @type {Tree} */ tree, /** @type {Skeleton} */ skeleton) {
  const { root, names } = skeleton;
  const joints = besideRoot(tree.joints, "encoding.joints", names.length, root);
  const moved = translated(tree, "encoding.translated", names.length, root);
  if (!moved.every((joint) => skeleton.translated.includes(joint)))
    throw refuse("encoding.translated", "joints must be among the skeleton's translated ones");
  const window = /** @type {number} */ (tree.window);
  if (window < 1 || window > MAX_WINDOW)
    throw refuse("encoding.window", `${window} frames, expected 1 to ${MAX_WINDOW}`);
  const rate = readRate(tree, "encoding.rate");
  const width = 6 * joints.length + window * (9 + 6 * joints.length + 3 * moved.length);
  const components = readComponents(tree, width);
  return { joints, translated: moved, window, rate, heading: Boolean(tree.heading), ...components };
}

/** Of the descriptor: its scale, its principal components, and how far each may go. */
function readComponents(/** @type {Tree} */ tree, /** @type {number} */ width) {
  const scale = reals(tree.scale, "encoding.scale", [width]).values;
  const least = scale.reduce((a, b) => Math.min(a, b), Infinity);
  if (least < Math.fround(LEAST_SCALE))
    throw refuse("encoding.scale", `${shortest(least)}, expected ${scientificWhole(LEAST_SCALE)} or more`);
  const stored = someTensor(tree.components, "encoding.components", [null, width], 0);
  const [directions, count] = [expanded(stored), stored.shape[0]];
  const ranges = reals(tree.ranges, "encoding.ranges", [2, count]).values;
  const swapped = ranges.subarray(0, count).findIndex((low, k) => low > ranges[count + k]);
  if (swapped >= 0) throw refuse("encoding.ranges", `the lowest value of component ${swapped} is above its highest`);
  const margins = reals(tree.margins, "encoding.margins", [count]).values;
  const smallest = margins.reduce((a, b) => Math.min(a, b), 0);
  if (smallest < 0) throw refuse("encoding.margins", `${shortest(smallest)}, expected 0 or more`);
  const mean = reals(tree.mean, "encoding.mean", [width]).values;
  return { mean, scale, directions, ranges, margins };
}

const scientificWhole = (/** @type {number} */ value) => general(value, 6);

function readRate(/** @type {Tree} */ tree, /** @type {string} */ path) {
  const rate = /** @type {number} */ (tree.rate);
  if (!(rate >= LEAST_RATE && rate <= LARGEST_RATE))
    throw refuse(path, `${shortest(rate)} frames per second, expected ${LEAST_RATE} to ${LARGEST_RATE}`);
  return rate;
}

/** @param {Tree[]} trees @param {Skeleton} skeleton @param {number} expressions of the avatar @param {number} encodingRate */
function readClips(trees, skeleton, expressions, encodingRate) {
  let added = 0;
  return trees.map((tree, i) => {
    /** @type {Clip} */
    const clip = readClip(tree, `clips[${i}]`, skeleton, expressions);
    const times = Math.max(encodingRate / clip.rate, 1);
    added += (times - 1) * clip.frames * (skeleton.names.length + (clip.expressions ? expressions : 0));
    if (times * clip.frames > MAX_FRAMES || added > MAX_ADDED) {
      const [rate, ours] = [clip.rate, encodingRate].map((one) => general(one, 6));
      const sentence = `${clip.frames} frames at a rate of ${rate}, too many for the encoding's rate of ${ours}`;
      throw refuse(`clips[${i}].rotations`, sentence);
    }
    return clip;
  });
}

/** @param {Tree} tree @param {string} path @param {Skeleton} skeleton @param {number} expressions of the avatar */
function readClip(tree, path, skeleton, expressions) {
  const { values: rotations, shape } = unit(tree.rotations, `${path}.rotations`, [null, skeleton.names.length, 4]);
  const frames = shape[0];
  if (!frames) throw refuse(`${path}.rotations`, "a clip needs at least one frame");
  const translation = reals(tree.translation, `${path}.translation`, [frames, 3]).values;
  const moved = skeleton.translated.length;
  if (!tree.translations && moved)
    throw fault("missing", `${path}.translations`, `absent, but the skeleton names ${moved} translated joints`);
  const translations = tree.translations
    ? reals(tree.translations, `${path}.translations`, [frames, moved, 3]).values
    : new Float32Array();
  return {
    name: /** @type {string} */ (tree.name),
    rate: readRate(tree, `${path}.rate`),
    frames,
    rotations,
    translation,
    translations,
    expressions: tree.expressions && readWeights(tree.expressions, `${path}.expressions`, [frames, expressions]),
  };
}

function readBounds(/** @type {Tree} */ tensor) {
  const bounds = reals(tensor, "bounds", [2, 3]).values;
  const [low, high] = [Array.from(bounds.subarray(0, 3)), Array.from(bounds.subarray(3))];
  if (low.some((value, axis) => value > high[axis])) {
    const [lowest, highest] = [low, high].map((corner) => `[${corner.map(shortest).join(", ")}]`);
    throw refuse("bounds", `lowest corner ${lowest} above highest ${highest}`);
  }
  return bounds;
}

function readThumbnail(/** @type {Uint8Array} */ content) {
  if (content.length && !PNG_SIGNATURE.every((byte, i) => content[i] === byte))
    throw refuse("thumbnail", "the content is no PNG");
  return content;
}
