// Weights of an avatar's expressions as a page sets them, by the avatar's names or by those of a tracker.

import { AvatarError } from "../error.js";
import { listed } from "../pose.js";
import { knownExpression, matchExpressions, weighted } from "./match.js";

export class Face {
  /** @type {Float32Array} */
  #matrix = new Float32Array(); // [E, S]
  /** @type {string[]} */
  #source = []; // S
  /** @type {Record<string, number>} */
  #set = {};

  /** @param {string[]} names of the avatar's expressions */
  constructor(names) {
    this.names = names;
  }

  /** Set weights over those that were set before; null forgets all. @param {Readonly<Record<string, number>> | null} given @returns {Float32Array | null} the avatar's [E], NaN where nothing that was set moves one */
  set(given) {
    this.#check(given ?? {});
    this.#set = given ? { ...this.#set, ...given } : {};
    const source = Object.keys(this.#set);
    if (!source.length) return null;
    if (String(source) !== String(this.#source)) this.#matrix = matchExpressions(this.names, source);
    this.#source = source;
    const width = source.length;
    const weights = weighted(this.#matrix, Object.values(this.#set));
    return weights.map((weight, row) =>
      this.#matrix.subarray(row * width, (row + 1) * width).some(Boolean) ? weight : NaN,
    );
  }

  #check(/** @type {Readonly<Record<string, number>>} */ given) {
    for (const [name, weight] of Object.entries(given)) {
      if (!this.names.includes(name) && !knownExpression(name))
        throw fault(`the avatar has no expression "${name}", only ${listed(this.names)}`);
      if (!Number.isFinite(weight)) throw fault(`${name}: expected a finite number, found ${weight}`);
    }
  }
}

const fault = (/** @type {string} */ sentence) => new AvatarError(`setExpressions: ${sentence}.`);
