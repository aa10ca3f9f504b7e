// How many parts of decodes and how many splats a displayed frame may hold, by how long frames took on this device.
// Reference: python/mua/avatar/frame_budget.py; tests hold both to it.

import { PARTS } from "./channels.js";
import { LONGEST } from "./schedule.js";

/** @typedef {[number, number]} Splats shown, and of the finest levels */
/** @typedef {{most: number, exact: boolean, avatars: number, splats: Splats | null}} Measured most: milliseconds of a frame; exact: by the graphics device, else from one displayed frame to the next; avatars in view; splats: null where no limit is to be set */

export const MILLISECONDS = 1000 / 72; // of a frame where nothing else is asked for: a headset's
const WINDOW = 36; // displayed frames from one decision to the next
const FEW = 3; // frames of a window that may be longer, whatever else delayed them
const ROOM = 0.8; // share of the budget that frames stay below before there is room for more
const MISSED = 1.25; // times the budget; displayed frames that took longer missed their time
const STEP = 0.8; // share of the splats that is left after a decision for fewer
const PATIENCE = 64; // windows with room before more is tried, at most

/** What a frame may hold, and what is known of the frames since the last decision. */
export class FrameBudget {
  parts = 1; // of decodes
  /** @type {number | null} */
  splats = null; // of all avatars together; null: no limit
  #frames = 0;
  #over = 0; // of these, longer than the budget
  #near = 0; // of these, without room for more
  #roomy = 0; // windows with room, one after the other
  #patience = 1; // windows with room before more is tried
  #raised = false; // whether the last decision was for more

  /** Take how long a frame took. @param {number} milliseconds @param {Measured} measured */
  measure(milliseconds, { most, exact, avatars, splats }) {
    const over = milliseconds > most * (exact ? 1 : MISSED);
    this.#frames += 1;
    this.#over += Number(over);
    this.#near += Number(over || (exact && milliseconds > ROOM * most));
    if (this.#frames < WINDOW) return;
    const [isOver, isNear] = [this.#over >= FEW, this.#near >= FEW];
    this.#frames = this.#over = this.#near = 0;
    const least = splats ? Math.max(Math.ceil((PARTS * avatars) / LONGEST), 1) : 1; // parts by which none waits longer than LONGEST
    if (isOver) this.#lower(least, splats);
    else if (isNear && this.parts >= least) this.#roomy = 0;
    else if (this.#roomy + 1 < this.#patience) this.#roomy += 1;
    else this.#raise(least, avatars, splats);
  }

  /** Fewer parts, then fewer splats; where all are at their coarsest, fewer parts than would do. @param {number} least @param {Splats | null} splats */
  #lower(least, splats) {
    this.#patience = this.#raised ? Math.min(2 * this.#patience, PATIENCE) : this.#patience;
    this.#roomy = 0;
    this.#raised = false;
    const half = Math.floor(this.parts / 2);
    if (this.parts > least) this.parts = Math.max(half, least);
    else if (!splats || (this.splats !== null && this.splats < splats[0])) this.parts = Math.max(half, 1);
    else this.splats = Math.floor(STEP * splats[0]);
  }

  /** As many parts as will do, then more splats, as many as there are, then more parts. @param {number} least @param {number} avatars @param {Splats | null} splats */
  #raise(least, avatars, splats) {
    this.#patience = this.#raised ? Math.max(Math.floor(this.#patience / 2), 1) : this.#patience;
    this.#roomy = 0;
    this.#raised = true;
    if (this.parts < least) this.parts = Math.min(2 * this.parts, least);
    else if (this.splats !== null) {
      const more = Math.floor(this.splats / STEP) + 1;
      this.splats = !splats || more >= splats[1] ? null : more;
    } else this.parts = Math.min(2 * this.parts, Math.max(PARTS * avatars, 1));
  }
}
