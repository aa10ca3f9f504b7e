// What a reader's buttons and keys do with what an element shows.

import { AvatarError } from "./player.js";
import { Attributed } from "./properties.js";

/** @typedef {import("./element.js").MuaAvatar} MuaAvatar */

export class Operated extends Attributed {
  /** Draw two eyes side by side, or one. */
  toggleStereo() {
    this.toggleAttribute("stereo");
  }

  /** Let the camera go with the figure, or stay. */
  toggleFollow() {
    this.toggleAttribute("follow");
  }

  /** Show or hide a part of the picture. */
  toggle(/** @type {import("./keys.js").Shown} */ name) {
    const shown = this.show.split(",").filter(Boolean);
    this.reflect("show", (shown.includes(name) ? shown.filter((each) => each !== name) : [...shown, name]).join());
  }

  /** The next coarser level of detail; after the coarsest, by the distance again. */
  nextLevel() {
    const at = this.levels.indexOf(this.level);
    this.reflect("level", this.levels[(at + 1) % this.levels.length]);
  }

  /** Play the next clip; after the last, the first. */
  nextClip() {
    const names = this.player?.clips.map(({ name }) => name) ?? [];
    if (names.length) Object.assign(this, { clip: names[(names.indexOf(this.clip ?? "") + 1) % names.length] });
  }

  /** Play or pause. @this {MuaAvatar} */
  togglePlaying() {
    if (this.player?.playing) this.pause();
    else this.play();
  }

  /** Pause and go so many frames on, round and round. @this {MuaAvatar} @param {number} frames */
  step(frames) {
    const clip = this.player?.clips.find(({ name }) => name === this.player?.clip);
    if (!this.player || !clip) return;
    const rate = clip.frames / clip.seconds;
    const index = (Math.floor(this.player.time * rate + 1e-6) + frames + clip.frames) % clip.frames;
    this.seek(index / rate);
  }

  /** The present picture as a PNG. */
  async screenshot() {
    if (!this.player) throw new AvatarError("No avatar is loaded, so there is no picture to save.");
    return this.player.screenshot();
  }

  async toggleFullscreen() {
    const { ownerDocument: page } = this;
    if (!page.fullscreenEnabled) return;
    if (this.matches(":fullscreen")) await page.exitFullscreen();
    else await this.requestFullscreen();
  }
}
