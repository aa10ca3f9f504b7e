// DecompressionStream as the Compression Streams standard and browsers have it: bytes after the end of the stream are an
// error. That of Node 20 ignores them.

import { Duplex } from "node:stream";
import { createInflateRaw } from "node:zlib";

globalThis.DecompressionStream = class {
  constructor() {
    const inflate = createInflateRaw();
    const { readable, writable } = Duplex.toWeb(inflate);
    let given = 0;
    const counted = new TransformStream({
      transform(part, to) {
        given += part.byteLength;
        to.enqueue(part);
      },
    });
    const ended = new TransformStream({
      flush(to) {
        if (inflate.bytesWritten < given) to.error(new TypeError("bytes follow the end of the stream"));
      },
    });
    counted.readable.pipeTo(writable).catch(() => {});
    this.writable = counted.writable;
    this.readable = readable.pipeThrough(ended);
  }
};
