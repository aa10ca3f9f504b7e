// Which part of which decode a displayed frame makes, so that its time does not grow with the number of avatars. One that is
// alone in view shows in time what is due; several take turns. Reference: python/mua/avatar/decode_turns.py; tests hold both to it.

import { PARTS } from "./channels.js";

/** @typedef {{clip: string, frame: number}} Moment */
/** @typedef {Moment & {level: number}} Decode a moment at a level of detail */
/**
 * @typedef {object} Ask an avatar in view in a displayed frame
 * @property {Moment} due
 * @property {Moment} following to be decoded before it is due; `due` where none is foreseen
 * @property {number} level of detail
 * @property {number} rank pixels of its height, times the radians by which its pose changed since the last decode
 * @property {boolean} spread whether its decode may be spread over displayed frames
 * @property {boolean} [mayLag] whether what is due may be shown a little later, where it is alone
 */
/** @typedef {{shown: Decode | null, coming: Decode | null, left: number, since: number, served: boolean}} State coming: begun and not shown, `left` parts missing; since: the displayed frame in which it began to wait; served: in this round */
/** @typedef {{whole: Decode | null, finish: number, show: boolean, begin: Decode | null, parts: number}} Steps in this order: decode all at once and show it; complete so many parts and show what was begun; begin; make so many parts */

/** @template Key @typedef {{key: Key, ask: Ask, state: State, steps: Steps}} Turn an avatar in a displayed frame */

export const ALONE = 2; // parts in a displayed frame of an avatar that is alone in view: half of a decode
export const LONGEST = 18; // displayed frames, a quarter of a second at 72 Hz

const isAt = (/** @type {Moment | null} */ made, /** @type {Moment} */ moment) =>
  made?.clip === moment.clip && made.frame === moment.frame;
const same = (/** @type {Decode | null} */ a, /** @type {Decode | null} */ b) =>
  a === b || (a !== null && b !== null && isAt(a, b) && a.level === b.level);
const followed = (/** @type {Ask} */ { following, level }) => ({ ...following, level });

/** Whether another decode is wanted than the one shown, and is not complete either. */
const waits = (/** @type {Ask} */ ask, /** @type {State} */ { shown, coming, left }) =>
  !same(shown, followed(ask)) && !(left === 0 && isAt(coming, ask.following));

/** @template Key tells avatars apart */
export class DecodeSchedule {
  constructor() {
    /** @type {Map<Key, State>} */
    this.states = new Map();
    /** @type {State | null} */
    this.holder = null; // whose decode is being made
  }

  /** Forget an avatar that went. */
  forget(/** @type {Key} */ key) {
    this.states.delete(key);
  }

  /**
   * The steps of one displayed frame. @param {Map<Key, Ask>} asks avatars in view, in an order that stays @param {number} frame
   * its number @param {number} parts in it where several take turns @returns {Map<Key, Steps>}
   */
  plan(asks, frame, parts) {
    const turns = Array.from(asks, ([key, ask]) => this.turn(key, ask, frame));
    const alone = turns.length === 1;
    let taken = 0;
    for (const turn of turns) {
      if (alone || !turn.ask.spread) taken += showDue(turn);
      else showWhole(turn);
    }
    if (!alone) this.serve(turns, frame, parts);
    else {
      this.holder = null;
      if (taken === 0) lookAhead(turns[0]); // a frame that must complete what is due does no more
    }
    return new Map(turns.map(({ key, steps }) => [key, steps]));
  }

  /** @param {Key} key @param {Ask} ask @param {number} frame @returns {Turn<Key>} */
  turn(key, ask, frame) {
    const state = this.states.get(key) ?? { shown: null, coming: null, left: 0, since: frame, served: false };
    this.states.set(key, state);
    if (!waits(ask, state)) state.since = frame;
    return { key, ask, state, steps: { whole: null, finish: 0, show: false, begin: null, parts: 0 } };
  }

  /** Make parts of one avatar's decode after the other's; none has two in one frame. @param {Turn<Key>[]} turns @param {number} frame @param {number} parts */
  serve(turns, frame, parts) {
    let others = turns;
    for (let spare = parts; spare > 0; ) {
      let turn = others.find(({ ask, state }) => state === this.holder && ask.spread && state.left > 0);
      if (!turn) {
        turn = this.next(others, frame);
        this.holder = turn?.state ?? null;
        if (!turn) return;
        Object.assign(turn.state, { served: true, since: frame });
        if (turn.state.left === 0 || !isAt(turn.state.coming, turn.ask.following)) begin(turn);
      }
      spare -= make(turn, spare);
      if (turn.state.left === 0) others = others.filter((other) => other !== turn);
    }
  }

  /** Whose turn it is, in this round or, once all that wait were served, in the next. @param {Turn<Key>[]} turns @param {number} frame */
  next(turns, frame) {
    const waiting = turns.filter(({ ask, state }) => ask.spread && waits(ask, state));
    if (waiting.length && waiting.every(({ state }) => state.served))
      for (const state of this.states.values()) state.served = false;
    let [first, ...others] = waiting.filter(({ state }) => !state.served);
    for (const other of others) if (isBefore(other, first, frame)) first = other;
    return /** @type {Turn<Key> | undefined} */ (first);
  }
}

/** Those never decoded, then those that have waited LONGEST, then the largest whose pose changed most. @param {Turn<any>} a @param {Turn<any>} b @param {number} frame */
function isBefore(a, b, frame) {
  const urgency = (/** @type {Turn<any>} */ { ask, state: { shown, since } }) => {
    const waited = frame - since;
    return [Number(shown === null), waited >= LONGEST ? waited : 0, ask.rank];
  };
  const [first, second] = [urgency(a), urgency(b)];
  const differs = first.findIndex((value, i) => value !== second[i]);
  return differs >= 0 && first[differs] > second[differs];
}

/** Show what is due whatever that takes; how many parts it took. @param {Turn<any>} turn */
function showDue({ ask, state, steps }) {
  const made = [state.shown, state.coming].filter((decode) => decode !== null);
  let wanted = { ...ask.due, level: ask.level };
  if (ask.spread && ask.mayLag && state.shown) wanted = made[made.length - 1];
  else if (ask.spread && !isAt(ask.following, ask.due)) wanted = made.find((decode) => isAt(decode, ask.due)) ?? wanted; // another level comes with the next decode
  if (same(state.shown, wanted)) return 0;
  const finishes = same(state.coming, wanted);
  const taken = finishes ? state.left : PARTS;
  Object.assign(steps, finishes ? { show: true, finish: state.left } : { whole: wanted });
  Object.assign(state, { shown: wanted, coming: null, left: 0 });
  return taken;
}

/** Show what is complete, unless it is still to come or what is due is shown already. @param {Turn<any>} turn */
function showWhole({ ask, state, steps }) {
  if (!state.coming || state.left > 0) return;
  const late = !isAt(state.coming, ask.following) && !isAt(state.shown, ask.due);
  if (!isAt(state.coming, ask.due) && !late) return;
  steps.show = true;
  Object.assign(state, { shown: state.coming, coming: null });
}

/** @param {Turn<any>} turn */
function lookAhead(turn) {
  const { ask, state } = turn;
  if (!ask.spread || same(state.shown, followed(ask))) return;
  if (!isAt(state.coming, ask.following)) begin(turn);
  make(turn, ALONE);
}

/** @param {Turn<any>} turn */
function begin({ ask, state, steps }) {
  steps.begin = followed(ask);
  Object.assign(state, { coming: steps.begin, left: PARTS });
}

/** Make parts of what was begun; how many there were. @param {Turn<any>} turn @param {number} most */
function make({ state, steps }, most) {
  const made = Math.min(most, state.left);
  state.left -= made;
  steps.parts += made;
  return made;
}
