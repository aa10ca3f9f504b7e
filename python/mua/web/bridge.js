// Poses the avatars of a page as another program does, to which `mua-view --web --listen` listens.
//
// The server sends JSON whenever a pose changes: {id, avatars: [pose, ...]}, what setPose() takes of each avatar, in the order
// of the attribute `src`, as server-sent events. It is sent back each `id` once its poses have been drawn, and measures the time.

/** @typedef {Pick<import("./player.js").AvatarHandle, "setPose">} Posable */
/** @typedef {import("./player.js").PoseInput} PoseInput */

/** Pose the avatars of an element by what a source brings. */
export function follow(/** @type {{avatars: readonly Posable[]}} */ element, /** @type {EventSource} */ source) {
  const answer = (/** @type {string} */ body) => fetch(source.url, { method: "POST", body }).catch(() => {}); // the server may end
  source.addEventListener("message", ({ data }) => {
    const { id, avatars } = /** @type {{id: number, avatars: PoseInput[]}} */ (JSON.parse(data));
    for (const [index, pose] of avatars.entries()) element.avatars[index]?.setPose(pose);
    // Twice: in the first of these the element may draw after us.
    requestAnimationFrame(() => requestAnimationFrame(() => answer(String(id))));
  });
}

const element = globalThis.document?.querySelector("mua-avatar[live]");
if (element) {
  const source = /** @type {string} */ (element.getAttribute("live"));
  const defined = customElements.whenDefined(element.localName); // by a script that comes after this one
  void defined.then(() => follow(/** @type {any} */ (element), new EventSource(source)));
}
