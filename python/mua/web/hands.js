// Mouse, pen and fingers on the canvas: one turns, two or the right button move aside, wheel and pinch zoom.

import { nearer, pan, turn, zoom } from "./view.js";

const NOTCH = 100; // of a wheel event, pixels
const LINE = 33; // pixels of a line, where wheels count lines

/**
 * @typedef {object} Held what hands move
 * @property {() => import("./player.js").CameraState | undefined} camera none while nothing is shown
 * @property {() => number} framed metres from which all is seen
 * @property {() => void} moved draws again
 */

/** Let hands on a canvas move a camera. */
export function listen(/** @type {HTMLElement} */ canvas, /** @type {Held} */ held) {
  /** @type {Map<number, {x: number, y: number}>} */
  const down = new Map();

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  for (const kind of /** @type {const} */ (["pointerup", "pointercancel", "lostpointercapture"]))
    canvas.addEventListener(kind, (event) => down.delete(event.pointerId));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault()); // the right button moves aside

  canvas.addEventListener("pointermove", (event) => {
    const camera = held.camera();
    const before = down.get(event.pointerId);
    if (!camera || !before) return;
    const now = { x: event.clientX, y: event.clientY };
    if (down.size > 1) two(camera, event.pointerId, before, now);
    else one(camera, event, now.x - before.x, now.y - before.y);
    down.set(event.pointerId, now);
    held.moved();
  });

  canvas.addEventListener(
    "wheel",
    (event) => {
      const camera = held.camera();
      if (!camera) return;
      event.preventDefault();
      zoom(camera, (-event.deltaY * (event.deltaMode ? LINE : 1)) / NOTCH, held.framed());
      held.moved();
    },
    { passive: false },
  );

  /** One finger, or the mouse. */
  function one(
    /** @type {import("./player.js").CameraState} */ camera,
    /** @type {PointerEvent} */ event,
    /** @type {number} */ right,
    /** @type {number} */ below,
  ) {
    const aside = event.shiftKey || !(event.buttons & 1);
    if (aside) pan(camera, right, below, canvas.clientHeight);
    else turn(camera, right, below);
  }

  /** Two fingers: their distance zooms, their middle moves aside. A finger that moves carries half of the middle. */
  function two(
    /** @type {import("./player.js").CameraState} */ camera,
    /** @type {number} */ id,
    /** @type {{x: number, y: number}} */ before,
    /** @type {{x: number, y: number}} */ now,
  ) {
    const [, other] = /** @type {[number, {x: number, y: number}]} */ ([...down].find(([each]) => each !== id));
    const apart = (/** @type {{x: number, y: number}} */ at) => Math.max(Math.hypot(at.x - other.x, at.y - other.y), 1);
    nearer(camera, apart(now) / apart(before), held.framed());
    pan(camera, (now.x - before.x) / 2, (now.y - before.y) / 2, canvas.clientHeight);
  }
}
