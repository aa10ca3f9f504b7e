// CRC-32, as in zlib and PNG, of a whole file with the checksum's own four bytes zero; four bytes at a step.

const POLYNOMIAL = 0xedb88320; // reflected
const STEP = 4;
const TABLES = tables();

/** The checksum of `content`, which stands at byte `at` of it. */
export function checksum(/** @type {Uint8Array} */ content, /** @type {number} */ at) {
  let crc = append(-1, content, 0, at);
  crc = append(crc, new Uint8Array(4), 0, 4);
  return ~append(crc, content, at + 4, content.length) >>> 0;
}

function append(
  /** @type {number} */ crc,
  /** @type {Uint8Array} */ content,
  /** @type {number} */ from,
  /** @type {number} */ end,
) {
  const [t0, t1, t2, t3] = TABLES;
  let at = from;
  for (; end - at >= STEP; at += STEP) {
    crc ^= content[at] | (content[at + 1] << 8) | (content[at + 2] << 16) | (content[at + 3] << 24);
    crc = t3[crc & 255] ^ t2[(crc >>> 8) & 255] ^ t1[(crc >>> 16) & 255] ^ t0[crc >>> 24];
  }
  for (; at < end; at++) crc = t0[(crc ^ content[at]) & 255] ^ (crc >>> 8);
  return crc;
}

/** Table k holds what a byte contributes k bytes later. */
function tables() {
  const found = Array.from({ length: STEP }, () => new Int32Array(256));
  for (let value = 0; value < 256; value++) {
    let crc = value;
    for (let bit = 0; bit < 8; bit++) crc = crc & 1 ? POLYNOMIAL ^ (crc >>> 1) : crc >>> 1;
    found[0][value] = crc;
  }
  for (let value = 0; value < 256; value++)
    for (let k = 1; k < STEP; k++) {
      const before = found[k - 1][value];
      found[k][value] = found[0][before & 255] ^ (before >>> 8);
    }
  return found;
}
