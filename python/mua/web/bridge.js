// Poses the avatars of a page as another program does, to which `mua-view --web --listen` listens.
//
// The server sends JSON whenever a pose changes: {id, avatars: [pose, ...]}, what setPose() takes of each avatar, in the order
// of the attribute `src`. It is sent back each `id` once its poses have been drawn, and measures the time.

/** @typedef {Pick<import("./player.js").AvatarHandle, "setPose">} Posable */
/** @typedef {import("./player.js").PoseInput} PoseInput */

/** Pose the avatars of an element by what a socket brings. */
export function follow(/** @type {{avatars: readonly Posable[]}} */ element, /** @type {WebSocket} */ socket) {
  socket.addEventListener("message", ({ data }) => {
    const { id, avatars } = /** @type {{id: number, avatars: PoseInput[]}} */ (JSON.parse(data));
    for (const [index, pose] of avatars.entries()) element.avatars[index]?.setPose(pose);
    // Twice: in the first of these the element may draw after us.
    requestAnimationFrame(() => requestAnimationFrame(() => socket.readyState === 1 && socket.send(String(id))));
  });
}

const element = globalThis.document?.querySelector("mua-avatar[live]");
if (element) {
  const address = new URL(/** @type {string} */ (element.getAttribute("live")), location.href);
  address.protocol = "ws:";
  follow(/** @type {any} */ (element), new WebSocket(address));
}
