// What a picture shows, in which order and for which eye, with parts that note when they are drawn.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Scene } from "../../../python/mua/web/scene.js";
import { SplatFrame } from "../../../python/mua/web/splats.js";

globalThis.GPUTextureUsage = { RENDER_ATTACHMENT: 16 };

const CAMERAS = [0, 1].map((eye) => ({ eye, screen: [40, 30], viewProjection: `eye ${eye}` }));
const NOTHING = { splats: false, geometry: false, template: false, skeleton: false, shadow: false };

/** All that a picture of avatars draws; `bare` ones have no splats. */
function drawn(show, { cameras = CAMERAS.slice(0, 1), bare = [false], seen = bare.map(() => true) } = {}) {
  const done = [];
  const note = (what) => (_, camera) => done.push(`${what}${camera ? ` for ${camera.eye}` : ""}`);
  const overlays = bare.map((is, i) => ({
    bare: is,
    drawMask: note(`mask ${i}`),
    drawGeometry: (_, camera, __, first) => done.push(`geometry ${i} from ${first} for ${camera.eye}`),
    drawTemplate: note(`template ${i}`),
    drawGround: note(`ground ${i}`),
    drawSkeleton: note(`skeleton ${i}`),
  }));
  const pass = {
    setViewport: (x, y, width, height) => done.push(`view ${[x, y, width, height]}`),
    setScissorRect: (x, y, width, height) => done.push(`cut ${[x, y, width, height]}`),
    drawIndirect: () => done.push("drawn"),
    end: () => done.push("end"),
  };
  const scene = Object.create(Scene.prototype);
  scene.depthOf = () => ({ createView() {} });
  scene.splats = {
    bind: (_, __, { eye, view_projection: seenBy }) => done.push(`splats of ${seenBy} with the colours of ${eye}`),
  };
  const frame = { seen, starts: bare.map((_, i) => 10 * i), splats: "splats" };
  scene.draw(
    { beginRenderPass: () => pass },
    { createView() {} },
    { frame, overlays, cameras, show: { ...NOTHING, ...show } },
  );
  return done.filter((each) => !each.startsWith("cut") && each !== "end");
}

test("an avatar that has no splats yet is shown by its template in their place", () => {
  assert.deepEqual(
    drawn({ splats: true }, { bare: [true, false] }).filter((each) => each.startsWith("template")),
    ["template 0 for 0"],
  );
  assert.deepEqual(
    drawn({ skeleton: true }, { bare: [true] }).filter((each) => each.startsWith("template")),
    [],
  );
});

test("the surface of an avatar is drawn through its own splats, and not where they were not placed", () => {
  const surfaces = drawn({ geometry: true }, { bare: [false, false, false], seen: [true, false, true] }).slice(1);
  assert.deepEqual(surfaces, ["geometry 0 from 0 for 0", "geometry 2 from 20 for 0"]);
});

test("the depth is kept for targets of one size and made anew for another", () => {
  const made = [];
  const createTexture = ({ size: [width, height] }) => (
    made.push({ width, height, destroyed: 0, destroy: () => (made.at(0).destroyed += 1) }), made.at(-1)
  );
  const scene = Object.assign(Object.create(Scene.prototype), { device: { gpu: { createTexture } }, depth: null });
  for (const [width, height] of [
    [4, 3],
    [4, 3],
    [4, 5],
  ])
    scene.depthOf({ width, height });
  assert.deepEqual(
    made.map(({ width, height, destroyed }) => [width, height, destroyed]),
    [
      [4, 3, 1],
      [4, 5, 0],
    ],
  );
});

test("splats of avatars in view come before those of the others, at even places", () => {
  const splats = Object.create(SplatFrame.prototype);
  splats.avatars = [{ splatCount: 3 }, { splatCount: 4 }, { splatCount: 5 }];
  for (const [seen, starts, count] of [
    [[true, true, true], [0, 4, 8], 14],
    [[false, true, true], [10, 0, 4], 10],
    [[true, false, false], [0, 4, 8], 4],
  ]) {
    splats.seen = seen;
    assert.deepEqual([splats.starts, splats.sortedCount], [starts, count]);
  }
});
