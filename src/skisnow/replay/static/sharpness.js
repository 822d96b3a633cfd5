// How fine the picture is drawn: as fine as the machine keeps up with while it plays, and finer when it stands.

const RATIOS = [0.45, 0.6, 0.8, 1, 1.5, 2]; // pixels drawn for each of the page
const SLOW = 55; // ms between pictures above which it gets coarser: 18 a second
const QUICK = 28; // ms below which it may get finer
const PATIENCE = 12; // pictures between changes

/** The ratio of a picture that stands still: edges are smooth when two are made one. */
export const STILL = 2;

/** Keeps the ratio of a picture that plays. */
export class Sharpness {
  constructor() {
    this.place = RATIOS.indexOf(1);
    this.start();
  }

  get ratio() {
    return RATIOS[this.place];
  }

  start() {
    this.mean = null;
    this.since = 0;
  }

  /** Take note of the time between two pictures (ms); true where the ratio has changed. */
  took(time) {
    this.mean = this.mean === null ? time : 0.8 * this.mean + 0.2 * time;
    this.since += 1;
    const way = this.mean > SLOW ? -1 : this.mean < QUICK ? 1 : 0;
    const next = Math.min(Math.max(this.place + way, 0), RATIOS.length - 1);
    if (this.since < PATIENCE || next === this.place) return false;
    this.place = next;
    this.start();
    return true;
  }
}
