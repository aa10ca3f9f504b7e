// Shaders as the player changes them before they are compiled.

import assert from "node:assert/strict";
import { test } from "node:test";
import { withLines, withRoom } from "../../../python/mua/web/shader.js";
import { BendTexels, LightTexels } from "../../../python/mua/web/wgsl/expressions.js";
import { InverseDwt, UpsampleTexels } from "../../../python/mua/web/wgsl/inverse_dwt.js";

const lengthOf = (shader, array) => Number(shader.code.match(`\\b${array}_\\d+:array<[^;]*,(\\d+)>;`)[1]);

for (const [shader, array] of [
  [InverseDwt, "filtered"],
  [UpsampleTexels, "upsampled"],
  [BendTexels, "upsampled"],
  [LightTexels, "upsampled"],
])
  test(`${shader.entry} shares no more memory than an avatar needs`, () => {
    const most = lengthOf(shader, array);
    assert.equal(lengthOf(withRoom(shader, array, 32), array), 32);
    assert.equal(lengthOf(withRoom(shader, array, most + 1), array), most);
  });

test("lines of another shader stand where their numbers stood", () => {
  assert.equal(withLines("a\n1-3\nb\n0-1", { code: "0\n1\n2\n3" }), "a\n1\n2\nb\n0");
});
