// The bar, the panel and the sentences of an element: what they ask of it, and what they show of it.

import { levelNamed } from "./attributes.js";
import { ICONS, parts } from "./markup.js";

const EVERY = 500; // milliseconds between two looks at the times

/** @typedef {import("./element.js").MuaAvatar} MuaAvatar */
/** @typedef {import("./keys.js").Shown} Shown */

/** The parts of an element. */
export class Controls {
  /** @param {ShadowRoot} root @param {MuaAvatar} avatar */
  constructor(root, avatar) {
    root.append(parts());
    this.avatar = avatar;
    const find = (/** @type {string} */ name) => /** @type {HTMLElement} */ (root.querySelector(name));
    this.frame = find(".frame");
    this.canvas = /** @type {HTMLCanvasElement} */ (find("canvas"));
    this.poster = /** @type {HTMLImageElement} */ (find(".poster"));
    this.bar = find(".bar");
    this.panel = find(".panel");
    this.play = find(".play");
    this.icon = find(".play path");
    this.scrub = /** @type {HTMLInputElement} */ (find(".scrub"));
    this.clock = find(".clock");
    this.clips = /** @type {HTMLSelectElement} */ (find(".clips"));
    this.speed = /** @type {HTMLSelectElement} */ (find(".speed"));
    this.settings = find(".settings");
    this.whole = find(".whole");
    this.vr = /** @type {HTMLButtonElement} */ (find(".vr"));
    this.stereo = /** @type {HTMLInputElement} */ (find(".stereo"));
    this.follow = /** @type {HTMLInputElement} */ (find(".follow"));
    this.level = /** @type {HTMLSelectElement} */ (find(".level"));
    this.avatars = find(".avatars");
    this.outside = find(".outside");
    this.times = /** @type {HTMLDetailsElement} */ (find(".times"));
    this.rate = find(".rate");
    this.stages = find(".times tbody");
    this.adapter = find(".adapter");
    this.says = find(".says");
    this.sentence = find(".says p");
    this.progress = /** @type {HTMLProgressElement} */ (find("progress"));
    this.again = find(".again");
    this.close = find(".close");
    this.file = /** @type {HTMLInputElement} */ (find(".file"));
    this.toggles = /** @type {HTMLInputElement[]} */ ([...root.querySelectorAll("[type=checkbox][name]")]);
    this.pictures = 0; // since the times were last shown
    this.looked = performance.now();
    this.listen(find);
  }

  /** Hand what is done to the element. */
  listen(/** @type {(name: string) => HTMLElement} */ find) {
    const { avatar } = this;
    const on = (/** @type {HTMLElement} */ part, /** @type {string} */ kind, /** @type {() => void} */ act) =>
      part.addEventListener(kind, act);
    on(this.play, "click", () => avatar.togglePlaying());
    on(this.scrub, "input", () => avatar.seek(Number(this.scrub.value)));
    on(this.clips, "change", () => (avatar.clip = this.clips.value));
    on(this.speed, "change", () => (avatar.speed = Number(this.speed.value)));
    on(this.stereo, "change", () => avatar.toggleStereo());
    on(this.follow, "change", () => avatar.toggleFollow());
    on(this.level, "change", () => (avatar.level = levelNamed(this.level.value)));
    on(this.settings, "click", () => this.openPanel(Boolean(this.panel.hidden)));
    on(find(".picture"), "click", () => void avatar.savePicture());
    on(this.whole, "click", () => void avatar.toggleFullscreen());
    on(this.vr, "click", () => void avatar.toggleVR());
    on(find(".open"), "click", () => avatar.openFiles());
    on(find(".reset"), "click", () => avatar.resetView());
    on(this.file, "change", () => {
      void avatar.add(...(this.file.files ?? []));
      this.file.value = ""; // the same file may be chosen again
    });
    on(this.again, "click", () => void avatar.reload());
    on(this.close, "click", () => this.hush());
    on(this.times, "toggle", () => this.showTimes(true));
    for (const box of this.toggles) on(box, "change", () => avatar.toggle(/** @type {Shown} */ (box.name)));
    this.panel.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      this.openPanel(false);
      this.settings.focus();
    });
  }

  /** Show an image until an avatar is drawn; none without an address. */
  setPoster(/** @type {string | null} */ address) {
    this.poster.hidden = !address || this.avatar.avatars.length > 0;
    if (address) this.poster.src = address;
  }

  openPanel(/** @type {boolean} */ open) {
    this.panel.hidden = !open;
    this.settings.setAttribute("aria-expanded", String(open));
  }

  /** Open the panel at the times of each stage, or close them. */
  toggleTimes() {
    this.times.open = Boolean(this.panel.hidden) || !this.times.open;
    this.openPanel(true);
  }

  /** Say how far loading is. */
  load(/** @type {number} */ share, /** @type {string} */ sentence) {
    this.say(sentence, { wrong: false });
    this.progress.hidden = false;
    this.progress.value = share;
  }

  /** Say a sentence: in the middle, or below where there is something to see. */
  say(/** @type {string} */ sentence, { wrong = true, again = false, close = false } = {}) {
    this.says.hidden = false;
    this.says.classList.toggle("wrong", wrong);
    this.says.classList.toggle("low", !this.poster.hidden || this.avatar.avatars.length > 0);
    this.sentence.setAttribute("role", wrong ? "alert" : "status");
    if (this.sentence.textContent !== sentence) this.sentence.textContent = sentence;
    this.progress.hidden = true;
    this.again.hidden = !again;
    this.close.hidden = !close;
    /** @type {HTMLElement} */ (this.again.parentElement).hidden = !again && !close;
  }

  /** Say nothing more; what is wrong may stay. */
  hush({ wrong = true } = {}) {
    if (!wrong && this.says.classList.contains("wrong")) return;
    this.says.hidden = true;
    this.sentence.textContent = "";
  }

  /** Show what is shown and how it plays. */
  update() {
    const { avatar } = this;
    const player = avatar.player;
    const here = avatar.avatars.length > 0;
    this.bar.hidden = !avatar.controls || !player;
    for (const part of /** @type {HTMLInputElement[]} */ ([this.play, this.scrub, this.clips, this.speed]))
      part.disabled = !here || !player?.clips.length;
    this.whole.hidden = !avatar.ownerDocument.fullscreenEnabled;
    this.whole.setAttribute("aria-pressed", String(avatar.matches(":fullscreen")));
    this.vr.hidden = !avatar.offersVR;
    this.vr.disabled = !here;
    this.vr.setAttribute("aria-pressed", String(player?.vr ?? false));
    this.frame.style.setProperty("--bar", `${this.bar.offsetHeight}px`); // all else stands above it
    const names = avatar.avatars.map(({ name }) => name).join(", ");
    this.canvas.setAttribute("aria-label", avatar.alt || avatar.ariaLabel || names || "No avatar");
    if (!player) return;
    this.icon.setAttribute("d", player.playing ? ICONS.pause : ICONS.play);
    this.play.setAttribute("aria-label", player.playing ? "Pause" : "Play");
    this.speed.value = String(player.speed);
    for (const box of this.toggles) box.checked = player.show[/** @type {Shown} */ (box.name)];
    this.list(
      this.clips,
      player.clips.map(({ name }) => name),
      player.clip,
    );
    this.stereo.checked = player.stereo;
    this.follow.checked = player.follow;
    this.list(this.level, avatar.levels.map(String), String(player.level));
    this.listAvatars();
    this.tick();
  }

  list(/** @type {HTMLSelectElement} */ select, /** @type {string[]} */ names, /** @type {string | null} */ chosen) {
    if ([...select.options].map((each) => each.value).join("\n") !== names.join("\n"))
      select.replaceChildren(...names.map((name) => new Option(name, name)));
    select.value = chosen ?? "";
  }

  /** Avatars by name, with a button each that takes it away. */
  listAvatars() {
    const rows = this.avatar.avatars.map((handle) => {
      const [item, name, remove] = [
        document.createElement("li"),
        document.createElement("span"),
        document.createElement("button"),
      ];
      name.textContent = handle.name;
      name.title = handle.notes;
      remove.type = "button";
      remove.textContent = "Remove";
      remove.setAttribute("aria-label", `Remove ${handle.name}`);
      remove.addEventListener("click", () => this.avatar.dismiss(handle));
      item.append(name, remove);
      return item;
    });
    this.avatars.replaceChildren(...rows);
  }

  /** Say how far outside of training the poses are that are shown, in the order of the avatars. */
  showOutside() {
    const shares = this.avatar.avatars.map(({ outsideTraining }) => `${Math.round(100 * outsideTraining)} %`);
    const text = shares.length ? `Outside of training: ${shares.join(", ")}` : "";
    if (this.outside.textContent !== text) this.outside.textContent = text;
  }

  /** What changes with every picture. */
  tick() {
    this.showOutside();
    const player = this.avatar.player;
    const clip = player?.clips.find(({ name }) => name === player.clip);
    if (!player || !clip) return;
    this.scrub.max = String(clip.seconds);
    this.scrub.value = String(player.time);
    const text = `${player.time.toFixed(1)} / ${clip.seconds.toFixed(1)} s`;
    if (this.clock.textContent !== text) this.clock.textContent = text;
    this.scrub.setAttribute("aria-valuetext", `${player.time.toFixed(1)} of ${clip.seconds.toFixed(1)} seconds`);
    this.pictures += 1;
    this.showTimes(false);
  }

  /** Pictures per second and the milliseconds of each stage. */
  showTimes(/** @type {boolean} */ now) {
    const player = this.avatar.player;
    const elapsed = performance.now() - this.looked;
    if (!player || (!now && elapsed < EVERY)) return;
    const rate = (1000 * this.pictures) / elapsed;
    [this.pictures, this.looked] = [0, performance.now()];
    if (!this.times.open || this.panel.hidden) return;
    const first = this.avatar.firstPicture;
    const since = first ? `; the first after ${(first / 1000).toFixed(1)} s` : "";
    this.rate.textContent = `${rate.toFixed(1)} pictures per second${since}`;
    const times = Object.entries(player.milliseconds);
    const sum = times.reduce((all, [, spent]) => all + spent, 0);
    this.stages.replaceChildren(
      ...[...times, ["all stages", sum]].map(([name, spent]) => line(String(name), `${Number(spent).toFixed(2)} ms`)),
    );
    this.stages.hidden = !times.length;
    this.adapter.textContent = (times.length ? "" : "This device keeps no time. ") + player.adapter;
  }
}

function line(/** @type {string[]} */ ...cells) {
  const row = document.createElement("tr");
  row.append(...cells.map((text) => Object.assign(document.createElement("td"), { textContent: text })));
  return row;
}
