// Whether a headset can show the player, and what is used of WebXR, which TypeScript does not describe. WebGPU is not named here:
// the types of the player must hold where TypeScript does not know it.

/** @typedef {{matrix: Float32Array, inverse: {matrix: Float32Array}}} Transform column by column */
/** @typedef {{projectionMatrix: Float32Array, transform: Transform}} View of one eye; its depth goes from 0 to w */
/** @typedef {{getViewerPose: (space: object) => {views: View[]} | null}} Frame */
/** @typedef {{layers?: object[], depthNear?: number}} RenderState */
/** @typedef {(now: number, frame: Frame) => void} Draws */
/**
 * @typedef {EventTarget & {
 *   requestReferenceSpace: (kind: string) => Promise<object>, updateRenderState: (state: RenderState) => void,
 *   requestAnimationFrame: (draws: Draws) => number, end: () => Promise<void>}} Session
 */
/** @typedef {EventTarget & {
 *   isSessionSupported: (mode: string) => Promise<boolean>,
 *   requestSession: (mode: string, asked: {requiredFeatures: string[]}) => Promise<Session>}} System
 */

const MODE = "immersive-vr";

/** The browser's WebXR, where it works with WebGPU. @returns {System | undefined} */
export function webXR() {
  return "XRGPUBinding" in globalThis
    ? /** @type {{xr?: System}} */ (/** @type {unknown} */ (navigator)).xr
    : undefined;
}

/** Whether there is a headset, and a browser that draws on it by WebGPU. @returns {Promise<boolean>} */
export async function offersVR() {
  return (
    (await webXR()
      ?.isSessionSupported(MODE)
      .catch(() => false)) ?? false
  );
}

/** A session; the browser grants it only while it handles a click or a key. @returns {Promise<Session>} */
export async function requestSession() {
  const xr = webXR();
  if (!xr) throw new Error("this browser has no WebXR with WebGPU");
  return xr.requestSession(MODE, { requiredFeatures: ["webgpu", "local-floor"] });
}
