// How long the device worked on each stage of a picture, where it keeps time.

const STAGES = ["decode", "sort", "draw"];
const BYTES = 16 * STAGES.length; // two times of eight bytes each
const SMOOTHING = 0.1; // share of the newest picture

/** Writes begin and end of each stage's pass, and reads them when the picture is done. */
export class Timing {
  /** @param {import("./device.js").Device} device @param {(milliseconds: number) => void} [taken] told of all stages of a picture together */
  constructor(device, taken = () => {}) {
    this.taken = taken;
    /** @type {Record<string, number>} */
    this.milliseconds = {};
    this.busy = false; // what was written last is still being read
    if (!device.timestamps) return;
    const { gpu } = device;
    this.queries = gpu.createQuerySet({ type: "timestamp", count: 2 * STAGES.length });
    this.resolved = gpu.createBuffer({ size: BYTES, usage: GPUBufferUsage.QUERY_RESOLVE | GPUBufferUsage.COPY_SRC });
    this.read = gpu.createBuffer({ size: BYTES, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
  }

  /** Where the pass of a stage notes its times. */
  of(/** @type {"decode" | "sort" | "draw"} */ stage) {
    const first = 2 * STAGES.indexOf(stage);
    if (!this.queries || this.busy) return undefined;
    return { querySet: this.queries, beginningOfPassWriteIndex: first, endOfPassWriteIndex: first + 1 };
  }

  /** Before the submit of a picture; gives what is to be done after it. */
  end(/** @type {GPUCommandEncoder} */ encoder) {
    const { queries, resolved, read } = this;
    if (!queries || !resolved || !read || this.busy) return () => {};
    encoder.resolveQuerySet(queries, 0, 2 * STAGES.length, resolved, 0);
    encoder.copyBufferToBuffer(resolved, 0, read, 0, BYTES);
    return () => {
      this.busy = true;
      read.mapAsync(GPUMapMode.READ).then(
        () => {
          this.take(new BigInt64Array(read.getMappedRange()));
          read.unmap();
          this.busy = false;
        },
        () => {}, // the device was lost, or given back
      );
    };
  }

  free() {
    for (const one of [this.queries, this.resolved, this.read]) one?.destroy();
  }

  take(/** @type {BigInt64Array} */ times) {
    let all = 0;
    STAGES.forEach((stage, i) => {
      const newest = Math.max(Number(times[2 * i + 1] - times[2 * i]) / 1e6, 0);
      const before = this.milliseconds[stage] ?? newest;
      this.milliseconds[stage] = before + SMOOTHING * (newest - before);
      all += newest;
    });
    this.taken(all);
  }
}
