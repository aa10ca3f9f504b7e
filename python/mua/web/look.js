// How the element looks, light and dark, wide and narrow.

/** @type {WeakMap<Document, CSSStyleSheet>} */
const sheets = new WeakMap();

/** The sheet that all elements of a document share: browsers take none of another document's. */
export function look(/** @type {Document} */ of) {
  let sheet = sheets.get(of);
  if (!sheet) {
    sheet = new (of.defaultView ?? globalThis).CSSStyleSheet();
    sheet.replaceSync(RULES);
    sheets.set(of, sheet);
  }
  return sheet;
}

const RULES = `
:host {
  --back: light-dark(#edf0f2, #16191d);
  --front: light-dark(#1b2026, #e8ebee);
  --quiet: light-dark(#59636e, #a3adb8);
  --panel: light-dark(#fffffff2, #22272df2);
  --line: light-dark(#c9d0d6, #3d454e);
  --accent: light-dark(#0b5cad, #7cbcff);
  --wrong: light-dark(#9b1c1c, #ffb3a8);
  color-scheme: light dark;
  position: relative;
  display: block;
  box-sizing: border-box;
  overflow: hidden;
  width: 100%; /* also where a page gives it a height */
  min-height: 12rem;
  aspect-ratio: 4 / 3;
  background: var(--back);
  color: var(--front);
  font: 0.9375rem/1.4 system-ui, sans-serif;
}
:host([hidden]), [hidden] { display: none !important; }
.frame { position: absolute; inset: 0; container: avatar / size; --bar: 0px; }
canvas, .poster { position: absolute; inset: 0; width: 100%; height: calc(100% - var(--bar)); }
canvas { touch-action: pan-y; cursor: grab; } /* a swipe up or down scrolls the page */
:host(:fullscreen) canvas { touch-action: none; }
canvas:active { cursor: grabbing; }
.poster { object-fit: contain; pointer-events: none; }
:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; border-radius: 4px; }
canvas:focus-visible { outline-offset: -3px; }

button, select, summary {
  min-height: 2.25rem;
  font: inherit;
  color: inherit;
  accent-color: var(--accent);
}
button, select {
  padding: 0 0.6rem;
  border: 1px solid var(--line);
  border-radius: 6px;
  background: transparent;
  cursor: pointer;
}
option { background: light-dark(#fff, #22272d); }
button:hover, select:hover { border-color: var(--accent); }
button[aria-pressed="true"], button[aria-expanded="true"] { border-color: var(--accent); color: var(--accent); }
button:disabled, select:disabled, input:disabled { opacity: 0.45; cursor: default; }
button svg { display: block; width: 1.1rem; height: 1.1rem; fill: currentColor; }
input { accent-color: var(--accent); }
input[type="checkbox"] { width: 1.05rem; height: 1.05rem; margin: 0; }

.bar {
  position: absolute;
  inset: auto 0 0;
  display: flex;
  flex-wrap: wrap;
  align-items: center;
  gap: 0.4rem 0.5rem;
  padding: 0.5rem max(0.6rem, env(safe-area-inset-left)) max(0.5rem, env(safe-area-inset-bottom));
  background: var(--panel);
  border-top: 1px solid var(--line);
}
.scrub { flex: 1 1 8rem; min-width: 6rem; height: 2.25rem; margin: 0; }
.clock { min-width: 6.5rem; text-align: center; font-variant-numeric: tabular-nums; color: var(--quiet); white-space: nowrap; }
.clips { max-width: 12rem; text-overflow: ellipsis; }

.panel {
  position: absolute;
  inset: 0.75rem 0.75rem auto auto;
  width: min(19rem, calc(100% - 3rem));
  max-height: calc(100% - var(--bar) - 3.5rem);
  padding: 0.5rem 1rem 0.9rem;
  overflow: auto;
  background: var(--panel);
  border: 1px solid var(--line);
  border-radius: 10px;
}
.panel h2 { margin: 0.6rem 0 0.3rem; font-size: 0.8125rem; font-weight: 600; color: var(--quiet); }
.panel label { display: flex; align-items: center; gap: 0.6rem; min-height: 2rem; cursor: pointer; }
.panel ul { margin: 0; padding: 0; list-style: none; }
.panel li { display: flex; align-items: center; gap: 0.5rem; min-height: 2rem; margin: 0.25rem 0; overflow-wrap: anywhere; }
.panel li span { flex: 1; }
.panel table { width: 100%; border-collapse: collapse; font-size: 0.8125rem; }
.panel td, .panel th { padding: 0.1rem 0; text-align: left; font-weight: 400; }
.panel td:last-child { text-align: right; font-variant-numeric: tabular-nums; }
.keys td:last-child { text-align: left; }
.panel p { margin: 0.2rem 0; font-size: 0.8125rem; color: var(--quiet); }
.row { display: flex; flex-wrap: wrap; gap: 0.4rem; margin-top: 0.5rem; }
summary { display: flex; align-items: center; font-size: 0.8125rem; font-weight: 600; color: var(--quiet); cursor: pointer; }
summary::before { content: "›"; width: 1rem; }
details[open] > summary::before { transform: rotate(90deg); transform-origin: 0.2rem 50%; }

.says {
  position: absolute;
  inset: 50% 0 auto;
  display: grid;
  justify-items: center;
  gap: 0.6rem;
  width: fit-content;
  max-width: min(32rem, calc(100% - 2rem));
  margin: 0 auto;
  padding: 0.8rem 1.1rem;
  transform: translateY(-50%);
  text-align: center;
  overflow-wrap: anywhere;
  background: var(--panel);
  border: 1px solid var(--line);
  border-radius: 10px;
}
.says p { margin: 0; }
.says.wrong { border-color: var(--wrong); }
.says.wrong p { color: var(--wrong); }
.says.low { inset: auto 0 calc(var(--bar) + 0.75rem); transform: none; }
progress { width: 14rem; max-width: 100%; accent-color: var(--accent); }
:host(.dropping)::after {
  content: "";
  position: absolute;
  inset: 0.5rem;
  border: 3px dashed var(--accent);
  border-radius: 10px;
  pointer-events: none;
}

@container avatar (max-width: 40rem) {
  .scrub { order: -1; flex-basis: 50%; }
  .clock { order: -1; min-width: 5rem; }
  .bar { gap: 0.4rem 0.3rem; }
  .clips { flex: 1 1 4rem; min-width: 4rem; }
  .speed { flex: 0 1 4.5rem; min-width: 4rem; }
  .bar select { padding: 0 0.3rem; }
  .play { order: -2; }
  .panel { inset: auto 0 var(--bar); width: auto; max-height: 55%; border-width: 1px 0 0; border-radius: 10px 10px 0 0; }
  button, select, .panel label, .panel li { min-height: 2.75rem; }
  button { min-width: 2.75rem; padding: 0 0.5rem; display: inline-grid; place-items: center; }
}
@container avatar (max-width: 24rem) or ((max-width: 40rem) and (max-height: 22rem)) {
  .bar { flex-wrap: nowrap; padding-block: 0.2rem; }
  .bar :is(.clock, .speed, .picture) { display: none; }
  .bar .scrub { flex: 1 1 3rem; min-width: 2rem; }
  .bar .clips { flex: 0 1 6rem; min-width: 0; }
  .bar button { min-width: 2.25rem; }
  .bar :is(button, select, .scrub) { min-height: 2.25rem; height: 2.25rem; }
}
@container avatar (max-width: 24rem) {
  .bar .whole { display: none; }
}
`;
