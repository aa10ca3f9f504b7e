// A drawn texture as a PNG.

import { half } from "./format/tensors.js";

const ROW = 256; // bytes, of which a row of a copy is a multiple
const PIXEL = 8; // bytes of four half floats

/** The PNG of a texture of half floats, premultiplied sRGB and alpha. @returns {Promise<Blob>} */
export async function readPicture(
  /** @type {import("./device.js").Device} */ { gpu },
  /** @type {GPUTexture} */ texture,
) {
  const { width, height } = texture;
  const bytesPerRow = Math.ceil((PIXEL * width) / ROW) * ROW;
  const buffer = gpu.createBuffer({
    size: bytesPerRow * height,
    usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST,
  });
  const encoder = gpu.createCommandEncoder();
  encoder.copyTextureToBuffer({ texture }, { buffer, bytesPerRow }, [width, height]);
  gpu.queue.submit([encoder.finish()]);
  await buffer.mapAsync(GPUMapMode.READ);
  const pixels = straight(new Uint16Array(buffer.getMappedRange()), width, height, bytesPerRow / 2);
  buffer.destroy();
  const canvas = new OffscreenCanvas(width, height);
  canvas.getContext("2d")?.putImageData(new ImageData(pixels, width, height), 0, 0);
  return canvas.convertToBlob({ type: "image/png" });
}

/** Straight sRGB and alpha of 8 bits. @param {Uint16Array} halves @param {number} width @param {number} height @param {number} row halves */
function straight(halves, width, height, row) {
  const pixels = new Uint8ClampedArray(4 * width * height);
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++) {
      const [from, to] = [y * row + 4 * x, 4 * (y * width + x)];
      const alpha = Math.min(half(halves[from + 3]), 1);
      for (let i = 0; i < 3; i++) pixels[to + i] = alpha > 0 ? (255 * half(halves[from + i])) / alpha : 0;
      pixels[to + 3] = 255 * alpha;
    }
  return pixels;
}
