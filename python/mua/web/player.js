// The public interface of the browser player: load avatars, play their clips, look at them. Everything a page may use
// stands here; the other modules of this folder are its parts.
//
//   const player = await createPlayer(canvas);
//   player.onerror = (error) => say(error.message);
//   const avatar = await player.load("avatar.muaavatar", { onProgress: (share, sentence) => bar.set(share) });
//   player.clip = avatar.clips[0].name;
//   player.start();

import { AvatarError } from "./error.js";
import { offersVR } from "./webxr.js";

export { AvatarError, offersVR };

const NO_WEBGPU = "This browser has no WebGPU, which draws the avatar: use a recent Chrome, Edge or Safari.";
const INSECURE = "Browsers offer WebGPU, which draws the avatar, only to pages opened by https: or from localhost.";

/**
 * @typedef {object} Show what a picture shows, back to front; the names of mua-view --show
 * @property {boolean} splats
 * @property {boolean} geometry the texels' surface, lit
 * @property {boolean} template the posed coarse mesh, lit
 * @property {boolean} skeleton bones and joints, over all else
 * @property {boolean} shadow on the ground
 */

/**
 * @typedef {object} CameraState where the camera is about its target
 * @property {number} azimuth radians; 0 faces the character, positive goes round to its left
 * @property {number} elevation radians; positive looks down
 * @property {number} distance metres from the target
 * @property {[number, number, number]} target world, metres
 * @property {number} fov vertical, radians
 */

/** @typedef {"auto" | "full" | number} Level of detail: by the distance, the finest, or texels along a side of the texture */
/** @typedef {{name: string, seconds: number, frames: number, loop: boolean}} ClipInfo loop: whether it starts over at its end */
/** @typedef {{type: "play" | "pause" | "loop" | "end", clip: string | null, time: number}} PlaybackEvent loop: the clip starts over; end: one that does not has ended, and rests at its last frame */
/** @typedef {[[number, number, number], [number, number, number]]} Box lowest and highest corner, metres */

/**
 * @typedef {object} AvatarHandle an avatar that was loaded
 * @property {string} name
 * @property {string} notes what the file says of itself, e.g. that its teacher was a simulated stand-in
 * @property {ClipInfo[]} clips
 * @property {Box} bounds about its root joint over all its clips
 * @property {number} splats 0 while only its template is there
 * @property {number[]} levels of detail: texels along a side of the texture, the finest first
 * @property {boolean} whole false while only a part of its file is there, whose checksum nobody knows yet
 * @property {[number, number, number]} place where it stands, world, metres; may be set
 * @property {number} outsideTraining share of the pose last decoded that training did not show, 0 to 1; 0 before the first
 *   picture. Beyond about a half, folds and colours are close to their mean
 * @property {SkeletonInfo} skeleton
 * @property {readonly string[]} expressions names; empty where the file has none
 * @property {(pose: PoseInput | null) => void} setPose shows this pose in place of the clip, until the next one; null gives the avatar
 *   back to its clip. Throws an AvatarError where the pose is wrong
 * @property {(weights: Readonly<Record<string, number>> | null) => void} setExpressions sets weights by name, whatever else moves the
 *   avatar; other names of ARKit, VRM or Oculus' visemes move the nearest that it has. Those that are left out stay, null forgets all.
 *   Throws an AvatarError where a name or weight is wrong
 * @property {(source: MotionSource, options?: PlayClipOptions) => Promise<PlayedClip | null>} playClip retargets a BVH, glTF, GLB, VRM or
 *   VRMA file and plays it; null where the avatar was taken away, or another clip asked for, meanwhile. Rejects with an AvatarError
 * @property {(rig: RigInfo, options?: {mapping?: Record<string, string>}) => Promise<Follow>} retarget what turns poses of another
 *   figure's skeleton into poses of this avatar. Rejects with an AvatarError
 * @property {() => void} remove gives its memory back; may be called twice
 */

/** @typedef {import("./retarget/types.js").SkeletonInfo} SkeletonInfo */
/** @typedef {import("./retarget/types.js").PoseInput} PoseInput */
/** @typedef {import("./retarget/types.js").MotionSource} MotionSource */
/** @typedef {import("./retarget/types.js").PlayClipOptions} PlayClipOptions */
/** @typedef {import("./retarget/types.js").PlayedClip} PlayedClip */
/** @typedef {import("./retarget/types.js").RigInfo} RigInfo */
/** @typedef {import("./retarget/types.js").Follow} Follow */

/**
 * @typedef {object} LoadOptions
 * @property {(fraction: number, sentence: string) => void} [onProgress] fraction of 0 to 1
 * @property {(avatar: AvatarHandle) => void} [onPart] a part of the avatar can be drawn, or more of it: of a packed file, its
 *   mesh and then coarser splats. The handle is the one that `load` gives at last; where loading fails, the part goes again
 * @property {AbortSignal} [signal] ends the download; `load` rejects with its reason
 */

/**
 * @typedef {object} PlayerOptions
 * @property {[number, number, number, number]} [background] sRGB and alpha, premultiplied; transparent by default
 * @property {"high-performance" | "low-power"} [powerPreference]
 */

/**
 * @typedef {object} Player
 * @property {(source: string | ArrayBuffer | File, options?: LoadOptions) => Promise<AvatarHandle>} load
 * @property {readonly AvatarHandle[]} avatars
 * @property {string | null} clip name of the clip that plays; null where no avatar holds one
 * @property {number} time seconds within the clip; setting it scrubs
 * @property {readonly ClipInfo[]} clips of the first avatar, and what pages have added to others
 * @property {boolean} playing
 * @property {boolean} moving whether pictures change by themselves: it plays, or a pose that was set has not come to rest
 * @property {number} speed 1 plays at the recorded speed
 * @property {CameraState} camera may be changed in place; the next picture follows
 * @property {(chosen?: readonly AvatarHandle[]) => void} frameAll puts the camera where all avatars, or those that are chosen, are in the picture
 * @property {Show} show may be changed in place
 * @property {Level} level of detail; "auto" by default
 * @property {number | null} budget splats of all avatars together where the level is "auto", for the nearest first; null: no limit
 * @property {number | null} frameBudget milliseconds that the graphics device may work on a picture, or that pass between two where it keeps no
 *   time: where it takes longer, fewer splats are shown; null, the default: no splats are left out for it
 * @property {boolean} stereo whether a left and a right eye share the width of the picture; not by default
 * @property {boolean} follow whether the camera goes with the first avatar along the ground; not by default
 * @property {() => Promise<void>} draw one picture now, at the canvas' size; resolves when it is drawn
 * @property {() => void} start draws a picture for every frame of the display
 * @property {() => void} stop
 * @property {boolean} vr whether a headset shows the avatars, in place of the canvas
 * @property {() => Promise<void>} enterVR shows them in a headset, before the reader on the floor; called by a click or a key,
 *   where `offersVR()` is true
 * @property {() => void} leaveVR gives the canvas back its picture; the headset's own button does the same
 * @property {((vr: boolean) => void) | null} onvr a headset begins to show the avatars, or has ended
 * @property {() => Promise<Blob>} screenshot the present picture as a PNG, its background transparent unless one was given
 * @property {Readonly<Record<string, number>>} milliseconds of the device by stage; empty where it keeps no time
 * @property {number} bytes of the device's memory that it holds
 * @property {string} adapter what the browser says of the device
 * @property {() => void} dispose gives all memory back; the player is of no more use
 * @property {((error: AvatarError) => void) | null} onerror what went wrong while nobody waited
 * @property {((event: PlaybackEvent) => void) | null} onplayback it begins or ceases to play, or a clip starts over or ends
 * @property {(() => void) | null} onchange a pose, expressions or a clip was set; who draws without `start` draws anew
 */

/**
 * A player that draws into a canvas.
 * @param {HTMLCanvasElement} canvas its width and height in pixels are the caller's
 * @param {PlayerOptions} [options]
 * @returns {Promise<Player>}
 * @throws {AvatarError} where the browser has no WebGPU, or no device for it
 */
export async function createPlayer(canvas, options = {}) {
  if (!globalThis.navigator?.gpu) throw new AvatarError(globalThis.isSecureContext === false ? INSECURE : NO_WEBGPU);
  const { Engine } = await import("./engine.js");
  return Engine.create(canvas, options);
}
