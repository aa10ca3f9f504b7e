// Frames of the window that an element is in: the page's, or one that it has opened, such as a picture in picture, which displays
// frames also while the page itself is in the background.

/** The window that an element is in; what an OffscreenCanvas has is its worker. @returns {Window & typeof globalThis} */
export function windowOf(/** @type {Element} */ element) {
  return /** @type {Window & typeof globalThis} */ (element.ownerDocument?.defaultView ?? globalThis);
}

/** Call back with the next frame of a window and its time by this page's clock, milliseconds; gives the request. @param {Window & typeof globalThis} view @param {(now: number) => void} draw */
export function nextFrame(view, draw) {
  return view.requestAnimationFrame((now) => draw(now + view.performance.timeOrigin - performance.timeOrigin));
}
