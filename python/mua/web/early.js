// Pictures before the kernels that sort are compiled, which takes a browser without a graphics card a second: meanwhile the
// processor sorts what the device has projected, into the same buffers.

/** @typedef {import("./device.js").Device} Device */
/** @typedef {import("./splats.js").SplatFrame} SplatFrame */

const HIDDEN = 0xffff;
const KEY_BYTES = 2;

/** The stable ascending order of the keys that are not hidden. Reference: python/mua/kernels/splat_sort.py. */
export function orderOf(/** @type {Uint16Array} */ keys) {
  const next = new Uint32Array(HIDDEN + 2); // the place that an element of each key takes
  for (const key of keys) next[key + 1] += 1;
  for (let key = 0; key < HIDDEN; key++) next[key + 1] += next[key];
  const order = new Uint32Array(next[HIDDEN]);
  keys.forEach((key, element) => {
    if (key !== HIDDEN) order[next[key]++] = element;
  });
  return order;
}

/** The order of the splats that were projected; null where the device was lost meanwhile. @param {Device} device @param {SplatFrame} splats @returns {Promise<Uint32Array | null>} */
export async function readOrder({ gpu }, { keys, sortedCount }) {
  const size = KEY_BYTES * sortedCount;
  const read = gpu.createBuffer({ size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
  const encoder = gpu.createCommandEncoder();
  encoder.copyBufferToBuffer(keys, 0, read, 0, size);
  gpu.queue.submit([encoder.finish()]);
  const there = await read.mapAsync(GPUMapMode.READ).then(
    () => true,
    () => false,
  );
  const order = there ? orderOf(new Uint16Array(read.getMappedRange())) : null;
  read.destroy();
  return order;
}

/** Give the device the order that its kernels would have made. */
export function writeOrder(
  /** @type {Device} */ device,
  /** @type {SplatFrame} */ splats,
  /** @type {Uint32Array} */ order,
) {
  device.write(splats.order, order);
  device.write(splats.arguments, Uint32Array.of(splats.corners * order.length, 1, 0, 0, order.length));
}
