// One graphics device for all players of a page, with all that is compiled on it. It is closed when nobody has used it for a while.

import { Device } from "./device.js";

/** @typedef {import("./player.js").PlayerOptions} PlayerOptions */
/** @typedef {{opening: Promise<Device>, device: Device | null, users: number, closing: ReturnType<typeof setTimeout> | undefined}} Shared */

const KEPT = 5000; // milliseconds: an element that loads another avatar uses the same device again

/** @type {Map<string, Shared>} by power preference */
const open = new Map();

/** The device of this page, opened where there is none; each user gives it back. @returns {Promise<Device>} @throws {AvatarError} where the browser has none */
export async function takeDevice(/** @type {PlayerOptions} */ options = {}) {
  const preference = options.powerPreference ?? "high-performance";
  const shared = open.get(preference) ?? begin(preference);
  clearTimeout(shared.closing);
  shared.users += 1;
  return shared.opening;
}

/** No longer use a device that was taken. */
export function giveBack(/** @type {Device} */ device) {
  const [preference, shared] = [...open].find(([, one]) => one.device === device) ?? [];
  if (!preference || !shared) return; // it was lost
  shared.users -= 1;
  if (shared.users) return;
  shared.closing = setTimeout(() => {
    open.delete(preference);
    device.gpu.destroy();
  }, KEPT);
}

/** @returns {Shared} */
function begin(/** @type {"high-performance" | "low-power"} */ powerPreference) {
  const opening = Device.open({ powerPreference });
  /** @type {Shared} */
  const shared = { opening, device: null, users: 0, closing: undefined };
  const forget = () => open.get(powerPreference) === shared && open.delete(powerPreference);
  opening.then((device) => {
    shared.device = device;
    device.whenLost(forget); // before its users hear of it
  }, forget);
  open.set(powerPreference, shared);
  return shared;
}
