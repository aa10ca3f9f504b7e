// A player's avatars before a reader with a headset: where they stand, and what draws them meanwhile.

import "./anatomy.js"; // no frame of a headset waits for what it shows
import { roomOf } from "./camera.js";
import { AvatarError } from "./error.js";
import { Headset } from "./headset.js";
import { fetchAnatomy } from "./overlays.js";
import { boxAround, groundOf } from "./placement.js";

const APART = 1.2; // metres between the reader and what is nearest

export class VR {
  /** @type {Headset | null} */
  headset = null; // while it shows the avatars
  #entering = false;

  constructor(/** @type {import("./engine.js").Engine} */ engine) {
    this.engine = engine;
  }

  async enter() {
    const { engine } = this;
    const { renderer } = engine;
    if (this.headset || this.#entering) return;
    if (!renderer || !engine.entries.length) throw new AvatarError("There is no avatar yet that a headset could show.");
    this.#entering = true;
    try {
      await fetchAnatomy();
      const headset = await Headset.open(renderer.device, this.asks());
      if (engine.renderer !== renderer) return headset.leave(); // lost, or given back, meanwhile
      this.headset = headset;
      engine.onvr?.(true);
    } finally {
      this.#entering = false;
    }
  }

  leave() {
    this.headset?.leave();
  }

  /** @returns {import("./headset.js").Asks} */
  asks() {
    const { engine } = this;
    return {
      room: this.standing(),
      draw: (now, picture, eyes) => {
        engine.playback.advance(now);
        engine.takePoses(now);
        engine.renderer?.displays(now);
        engine.renderer?.submit(picture, engine.posed(), engine.look, eyes);
      },
      fail: (error) => engine.fail(error),
      ended: () => {
        if (!this.headset) return; // it never showed them
        this.headset = null;
        engine.drawn = "";
        engine.drawNow();
        engine.onvr?.(false);
      },
    };
  }

  /** How the avatars stand: on the floor before the reader, seen from the side from which the page shows them. */
  standing() {
    const { engine } = this;
    const { entries, playback } = engine;
    const box = boxAround(entries, playback);
    const lowest = Math.min(...entries.map((entry) => groundOf(entry, playback) + entry.handle.place[1]));
    const foot = [(box[0] + box[3]) / 2, lowest, (box[2] + box[5]) / 2];
    const apart = APART + Math.hypot(box[3] - box[0], box[5] - box[2]) / 2;
    const { azimuth } = engine.camera;
    const began = engine.followed();
    return () => {
      const followed = engine.followed();
      return roomOf(
        foot.map((at, axis) => at + followed[axis] - began[axis]),
        azimuth,
        apart,
      );
    };
  }
}
