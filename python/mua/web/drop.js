// Files that are dropped on an element are shown; it has the class `dropping` while they are above it.

/** @typedef {import("./element.js").MuaAvatar} MuaAvatar */

export function acceptFiles(/** @type {MuaAvatar} */ avatar) {
  const over = (/** @type {boolean} */ is) => avatar.classList.toggle("dropping", is);
  avatar.addEventListener("dragover", (event) => {
    if (!event.dataTransfer?.types.includes("Files")) return;
    event.preventDefault();
    over(true);
  });
  avatar.addEventListener("dragleave", () => over(false));
  avatar.addEventListener("drop", (event) => {
    over(false);
    const files = [...(event.dataTransfer?.files ?? [])];
    if (!files.length) return;
    event.preventDefault();
    void avatar.add(...files);
  });
}
