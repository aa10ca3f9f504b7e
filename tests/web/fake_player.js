// A stand-in for player.js with the same interface and no WebGPU: what the page does can be tested without an engine.
// A file is JSON: {name, clips, splats, far}; anything else is refused. Every picture is a disc at the clip's time, and leaves
// `far` times a tenth of the seconds as how far outside of training the pose is.

import { AvatarError } from "./error.js";

export { AvatarError };
export const offersVR = async () => Boolean(globalThis.fakeHeadset);
globalThis.AvatarError = AvatarError;

export async function createPlayer(canvas) {
  if (globalThis.fakeMissing) throw new AvatarError("This browser has no WebGPU.");
  const player = new Fake(canvas);
  globalThis.fake = player;
  globalThis.fakes = (globalThis.fakes ?? 0) + 1;
  return player;
}

class Fake {
  avatars = [];
  clip = null;
  time = 0;
  playing = true;
  speed = 1;
  level = "auto";
  budget = null;
  frameBudget = null;
  follow = false;
  stereo = false;
  vr = false;
  onvr = null;
  camera = { azimuth: 0, elevation: 0, distance: 3, target: [0, 1, 0], fov: 0.8 };
  show = { splats: true, geometry: true, template: false, skeleton: false, shadow: false };
  milliseconds = { decode: 1.25, sort: 0.5 };
  adapter = "fake adapter (software)";
  onerror = null;
  drawn = 0;
  started = false;
  disposed = false;

  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
  }

  get moving() {
    return this.playing;
  }

  get clips() {
    return this.avatars[0]?.clips ?? [];
  }

  async load(source, { onProgress } = {}) {
    onProgress?.(0.5, "Loading half of it");
    const name = typeof source === "string" ? source : source.name;
    await globalThis.fakeHold;
    const answer = typeof source === "string" ? await fetch(source) : new Response(source);
    if (!answer.ok) throw new AvatarError(`${name}: the server answered ${answer.status}.`);
    let held;
    try {
      held = JSON.parse(await answer.text());
    } catch {
      throw new AvatarError(`${name}: not an avatar.`);
    }
    const handle = {
      notes: "",
      splats: 1,
      outsideTraining: 0,
      levels: [768, 384, 192],
      place: [0, 0, 0],
      bounds: [
        [-0.5, 0, -0.2],
        [0.5, 1.8, 0.2],
      ],
      ...held,
    };
    handle.remove = () => (this.avatars = this.avatars.filter((each) => each !== handle));
    this.avatars = [...this.avatars, handle];
    this.clip ??= handle.clips[0]?.name ?? null;
    return handle;
  }

  frameAll(/** @type {readonly any[] | undefined} */ chosen = undefined) {
    this.camera.distance = 4;
    this.camera.target = [chosen?.[0].place[0] ?? 0, 0.9, 0];
    this.framed = (this.framed ?? 0) + 1;
  }

  async draw() {
    if (this.disposed) throw new Error("drawn after dispose");
    const { width, height } = this.canvas;
    this.context.fillStyle = "#c05a3a";
    this.context.clearRect(0, 0, width, height);
    this.context.beginPath();
    this.context.arc(width / 2, height / 2, height / 5, 0, 6.3);
    this.context.fill();
    for (const one of this.avatars) one.outsideTraining = (this.time / 10) * (one.far ?? 1);
    this.drawn += 1;
  }

  start() {
    this.started = true;
  }

  stop() {
    this.started = false;
  }

  async enterVR() {
    if (globalThis.fakeHeadset !== "willing") throw new AvatarError("The headset cannot show the avatar: denied");
    this.vr = true;
    this.onvr?.(true);
  }

  leaveVR() {
    this.vr = false;
    this.onvr?.(false);
  }

  async screenshot() {
    return new Promise((resolve) => this.canvas.toBlob(resolve));
  }

  dispose() {
    this.disposed = true;
  }
}
