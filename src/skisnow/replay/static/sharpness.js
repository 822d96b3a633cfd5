// How the picture is drawn: as fine and with as much as the machine keeps up with while it plays, and finer when it stands.

import { said } from "./words.js";

/** From the lowest: pixels drawn for each of the page, and effects (1: light on the snow, shadows; 2: the plume too). */
const LEVELS = [
  { ratio: 0.5, effects: 0 }, { ratio: 0.7, effects: 0 }, { ratio: 0.7, effects: 1 }, { ratio: 1, effects: 1 },
  { ratio: 1, effects: 2 }, { ratio: 1.5, effects: 2 }, { ratio: 2, effects: 2 },
];
const FULL = 4;
const SLOW = 36; // ms between pictures above which it steps down: 28 a second
const QUICK = 21; // ms below which it may step up
const PATIENCE = 12; // pictures before it steps down
const TRUST = 90; // pictures before it steps up: a drawing process takes some in before it falls behind
const MISSES = 2; // times that a level proved too much before it is left alone

/** The ratio of a picture that stands still: edges are smooth when two are made one. */
export const STILL = 2;
export const MOST_EFFECTS = 2;
export const settings = () => [["auto", said("As this machine keeps up")], ["low", said("Low")], ["full", said("Full")]];

/** Keeps the level of a picture that plays, or stays with the one that was chosen. */
export class Sharpness {
  constructor() {
    this.setting = "auto";
    this.place = FULL;
    this.missed = LEVELS.map(() => 0);
    this.start();
  }

  choose(setting) {
    this.setting = setting;
    this.place = setting === "low" ? 0 : FULL;
    this.missed.fill(0);
    this.start();
  }

  get ratio() {
    return LEVELS[this.place].ratio;
  }

  get effects() {
    return LEVELS[this.place].effects;
  }

  start() {
    this.mean = null;
    this.since = 0;
  }

  /** Take note of the time between two pictures (ms); true where the level has changed. */
  took(time) {
    if (this.setting !== "auto") return false;
    this.mean = this.mean === null ? time : 0.8 * this.mean + 0.2 * time;
    this.since += 1;
    if (this.since < PATIENCE) return false;
    const way = this.mean > SLOW ? -1 : this.mean < QUICK && this.since >= TRUST ? 1 : 0;
    const next = Math.min(Math.max(this.place + way, 0), LEVELS.length - 1);
    if (next === this.place || (way > 0 && this.missed[next] >= MISSES)) return false;
    if (way < 0) this.missed[this.place] += 1;
    this.place = next;
    this.start();
    return true;
  }
}
