// The page around the element: its title, files that are opened or dropped anywhere, keys wherever the focus is.

import "./element.js";
import { pressed } from "./keys.js";

const avatar = /** @type {import("./element.js").MuaAvatar} */ (document.querySelector("mua-avatar"));
const empty = /** @type {HTMLElement} */ (document.querySelector("#empty"));
const heading = /** @type {HTMLElement} */ (document.querySelector("h1"));
heading.textContent = document.title;

const showHint = () => (empty.hidden = avatar.hasAttribute("src") || avatar.avatars.length > 0);
showHint();
for (const kind of ["load", "error"])
  avatar.addEventListener(kind, () => (empty.hidden = kind === "error" || avatar.avatars.length > 0));

const open = /** @type {HTMLButtonElement} */ (document.querySelector("#open"));
open.addEventListener("click", () => avatar.openFiles());
open.disabled = false;
document.querySelector("#stuck")?.remove();
document.addEventListener("keydown", (event) => {
  if (!event.composedPath().includes(avatar)) pressed(event, avatar);
});
// A file that is dropped beside the element would otherwise replace the page.
document.addEventListener("dragover", (event) => event.preventDefault());
document.addEventListener("drop", (event) => {
  if (event.defaultPrevented) return;
  event.preventDefault();
  void avatar.add(...(event.dataTransfer?.files ?? []));
});
