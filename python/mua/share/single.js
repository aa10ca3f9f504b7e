// Begins a page that holds all its parts: makes a blob of each module, then shows the avatars that the page holds.
"use strict";

const muaModules = {};
globalThis.muaModules = muaModules;
for (const [path, text] of JSON.parse(document.querySelector("#modules").textContent)) {
  const linked = text.replace(/"mua:([^"]+)"/g, (_, name) => JSON.stringify(muaModules[name]));
  muaModules[path] = URL.createObjectURL(new Blob([linked], { type: "text/javascript" }));
}

const bytesOf = (text) => Uint8Array.fromBase64?.(text) ?? Uint8Array.from(atob(text), (each) => each.charCodeAt(0));

import(muaModules["page.js"]).then(() => {
  const held = [...document.querySelectorAll("script[data-name]")];
  const files = held.map((part) => new File([bytesOf(part.textContent)], part.dataset.name));
  for (const part of held) part.remove(); // the text is of no more use
  return document.querySelector("mua-avatar").add(...files);
});
