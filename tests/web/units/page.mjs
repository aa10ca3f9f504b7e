// Stand-ins for what the modules of <mua-avatar> work with: the element, its controls and its player.

/** An element with attributes and events, and nothing else of a page. */
export class FakeElement extends EventTarget {
  player = null;

  constructor(attributes = {}) {
    super();
    this.attributes = attributes;
  }

  get avatars() {
    return this.player?.avatars ?? [];
  }

  getAttribute(name) {
    return this.attributes[name] ?? null;
  }

  hasAttribute(name) {
    return name in this.attributes;
  }
}

export const box = (width, middle = 0) => [
  [middle - width / 2, 0, -0.2],
  [middle + width / 2, 1.8, 0.2],
];

/** A player of avatars with these bounds; `framed` holds what it was asked to frame, one entry for each time. */
export function fakePlayer(...bounds) {
  const player = {
    avatars: bounds.map((each) => ({ bounds: each, place: [9, 9, 9] })),
    clips: [{ name: "walk" }, { name: "wave" }],
    clip: "walk",
    camera: { azimuth: 0, elevation: 0, distance: 1, target: [0, 0, 0], fov: 0.5 },
    show: {},
    framed: [],
    frameAll(chosen) {
      player.framed.push(chosen);
      Object.assign(player.camera, { distance: 4, target: [0, 0.9, 0] });
    },
  };
  return player;
}
