// The replay: plays a run on its stage and answers buttons, sliders, keys and fingers.

import { decoded } from "./binary.js";
import { VIEWS } from "./cameras.js";
import { controls, depthTitle, fillLegend, forceTitle, laidOut, made, marks, meter, MOST_RELIEF, readings, setMeter } from "./controls.js";
import { skiForces } from "./force_arrows.js";
import { gapAt } from "./gap.js";
import { miniMap } from "./mini_map.js";
import { edges, row } from "./motion.js";
import { MOST_EFFECTS, Sharpness, STILL } from "./sharpness.js";
import { Stage } from "./stage.js";
import { composed, filmType, recording, saved } from "./takeaway.js";
import { decimal, said, speak } from "./words.js";

const STEP = 0.05; // s that an arrow key goes
const LARGE_STEP = 0.5;
const RELIEF = 8; // times that the groove is deeper and wider than it is, at first
const LIGHT = 8; // ms of drawing after which a calm replay does not rest
const LONGEST = 1000; // ms of play in one picture: a page that was hidden meanwhile goes on from where it was

/**
 * Show a run in an element.
 *
 * `run` and, for a second one laid over it, `ghost` are the bytes of replays. `words` are translations, by the English
 * texts. A calm replay leaves a machine without a graphics card time for other things, and plays only in view.
 */
export function startReplay(root, { run, ghost = null, words = null, isCalm = false }) {
  speak(words);
  return new Player(root, decoded(run), ghost ? decoded(ghost) : null, isCalm);
}

class Player {
  constructor(root, run, ghost, isCalm) {
    this.run = run;
    this.ghost = ghost;
    this.parts = controls({ run, ghost });
    this.map = miniMap(run);
    this.parts.map = this.map.canvas;
    laidOut(root, this.parts, run);
    this.start = run.arrays.time.values[0];
    this.end = this.start + Math.max(...[run, ghost].filter(Boolean).map(duration)); // both begin together
    Object.assign(this, { time: this.start, playing: false, rate: 1, exaggeration: 1, relief: RELIEF, frames: 0, film: null });
    this.shown = { groove: true, marks: true, forces: false, ghost: true, track: true };
    this.flat = document.createElement("canvas");
    this.sharpness = new Sharpness();
    this.rest = isCalm ? () => this.#rest() : null;
    try {
      this.stage = new Stage(this.parts.canvas, run, ghost);
    } catch (error) {
      this.say(said("This browser shows no WebGL picture. Switch hardware acceleration on, or use another browser."));
      throw error;
    }
    this.#fill();
    this.#listen(root);
    new ResizeObserver(() => this.resize()).observe(this.parts.canvas.parentElement);
    if (window.matchMedia("(prefers-reduced-motion: reduce)").matches) this.resize();
    else this.play();
  }

  #fill() {
    const { parts } = this;
    Object.assign(parts.time, { min: this.start, max: this.end, step: 0.01, value: this.start });
    fillLegend(parts.legend, this.stage.scales, this.run.colours, Boolean(this.run.skier));
    if (!filmType()) {
      parts.film.disabled = true;
      parts.film.title = said("This browser records no film.");
    }
    this.deepen(RELIEF);
    this.look("chase");
  }

  say(text) {
    this.parts.message.textContent = text;
  }

  resize() {
    const [width, height] = this.#size();
    if (!width || !height) return;
    this.stage.spend(this.playing && !this.film ? this.sharpness.effects : MOST_EFFECTS);
    this.stage.resize(width, height, this.#ratio());
    this.draw();
  }

  #ratio() {
    if (this.film) return 1; // a film keeps its size
    return this.playing ? this.sharpness.ratio : Math.max(STILL, window.devicePixelRatio || 1);
  }

  /** Draw the present moment, and tell it in words. */
  draw() {
    const pose = this.stage.draw(this.time, this.exaggeration);
    this.frames += 1;
    const forces = this.shown.forces ? skiForces(this.run, pose.at) : null;
    const gap = gapAt(this.run, this.ghost, this.time);
    this.lines = readings(this.run, pose, { row, outer: this.stage.follower.outer, gap, forces });
    this.#tell();
    this.map.show(pose.place);
    if (this.film) this.#compose();
  }

  #tell() {
    const { parts } = this;
    if (parts.readings.children.length !== this.lines.length) {
      this.words = this.lines.map(() => [made("dt"), made("span")]);
      this.meters = this.lines.map(({ share }) => (share === undefined ? [] : [meter()]));
      parts.readings.replaceChildren(
        ...this.lines.map(({ large }, i) => made("div", { className: large ? "replay-large" : "replay-small" },
          this.words[i][0], made("dd", {}, ...this.meters[i], this.words[i][1]))),
      );
    }
    this.lines.forEach(({ name, text }, i) => {
      [name, text].forEach((words, part) => {
        if (this.words[i][part].textContent !== words) this.words[i][part].textContent = words;
      });
    });
    this.meters.forEach((found, i) => found.forEach((each) => setMeter(each, this.lines[i])));
    parts.time.value = this.time;
    parts.time.setAttribute("aria-valuetext", said("{} seconds", decimal(this.time, 2)));
  }

  #compose() {
    const bent = this.exaggeration === 1 ? [] : [said("Bending and twist {} times", this.exaggeration)];
    const deep = this.relief === 1 || !this.shown.groove ? [] : [said("Groove {} times as deep and wide", this.relief)];
    const squares = this.shown.marks ? [marks()] : [];
    const words = [this.run.title, ...this.lines.map(({ name, text }) => `${name}: ${text}`), ...bent, ...deep, ...squares];
    const { force, forceGoesOn, depth, staysNothing } = this.stage.scales;
    const { colours } = this.run;
    const scales = [{ title: forceTitle(), colours: colours.force, most: force / 1000, goesOn: forceGoesOn }];
    if (this.shown.groove && !staysNothing) scales.push({ title: depthTitle(), colours: colours.depth, most: Number((1000 * depth).toPrecision(3)) });
    composed(this.parts.canvas, this.flat, words, scales);
  }

  seek(time) {
    this.time = Math.min(Math.max(time, this.start), this.end);
    this.draw();
  }

  play() {
    if (this.playing) return;
    if (this.time >= this.end) this.time = this.start;
    this.playing = true;
    this.parts.play.textContent = said("Pause");
    this.sharpness.start();
    this.resize();
    let before = null;
    const next = (now) => {
      if (this.next !== next) return; // paused, and perhaps played again
      const gone = before === null ? 0 : Math.min(now - before, LONGEST);
      this.time = Math.min(this.time + (this.rate * gone) / 1000, this.end);
      before = now;
      if (gone > 0 && !this.film && this.sharpness.took(gone)) this.resize();
      else this.draw();
      if (this.time >= this.end) this.pause();
      else if (this.rest) this.rest().then(() => requestAnimationFrame(next));
      else requestAnimationFrame(next);
    };
    this.next = next;
    this.stage.drawn().then(() => requestAnimationFrame(next));
  }

  /** Wait after a picture that took long, so that drawing takes at most a third of the time; and while out of view. */
  async #rest() {
    const begun = performance.now();
    await this.stage.drawn();
    const took = performance.now() - begun;
    if (took > LIGHT) await new Promise((done) => setTimeout(done, 2 * took));
    while (!inView(this.parts.canvas)) await new Promise((done) => setTimeout(done, 200));
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.next = null;
    this.parts.play.textContent = said("Play");
    if (this.film) this.#endFilm();
    this.resize();
  }

  look(view) {
    this.stage.follower.view = view;
    this.#press();
    if (this.stage.follower.pose) this.draw();
  }

  #press() {
    for (const button of this.parts.views.children) {
      button.setAttribute("aria-pressed", String(button.dataset.view === this.stage.follower.view));
    }
  }

  exaggerate(factor) {
    this.exaggeration = Math.min(Math.max(factor, 1), 20);
    this.parts.exaggeration.value = this.exaggeration;
    this.parts.exaggerated.textContent = `${this.exaggeration} ×`;
    this.draw();
  }

  /** Draw the groove so often as deep and wide as it is. */
  deepen(times) {
    this.relief = Math.min(Math.max(times, 1), MOST_RELIEF);
    this.parts.relief.value = this.relief;
    this.parts.deepened.textContent = `${this.relief} ×`;
    this.stage.deepen(this.relief);
    if (this.stage.follower.pose) this.draw();
  }

  /** How it is drawn while it plays: one of the settings of sharpness.js. */
  drawAs(setting) {
    this.sharpness.choose(setting);
    this.parts.drawing.value = setting;
    this.resize();
  }

  show(name, on) {
    this.shown[name] = on;
    const box = this.parts.shown.querySelector(`[data-show="${name}"]`);
    if (box) box.checked = on;
    this.parts.legend.querySelector(".replay-arrows").hidden = !this.shown.forces;
    this.parts.legend.querySelector(".replay-marks").hidden = !this.shown.marks;
    this.stage.choose(this.shown);
    this.draw();
  }

  turn(azimuth, height) {
    this.stage.follower.turn(azimuth, height);
    this.#press();
    if (!this.playing) this.draw();
  }

  nearer(factor) {
    this.stage.follower.nearer(factor);
    if (!this.playing) this.draw();
  }

  /** The picture as a PNG, with its readings. */
  picture() {
    this.draw();
    this.#compose();
    return new Promise((resolve) => this.flat.toBlob(resolve, "image/png"));
  }

  /** Record from here, or from the start if at the end, until the end or the next press. */
  async startFilm() {
    this.pause();
    if (this.time >= this.end) this.time = this.start;
    this.film = recording(this.flat);
    this.resize();
    this.parts.film.textContent = said("End the film");
    this.say(said("Recording while it plays."));
    await this.film.begun;
    this.play();
  }

  #size() {
    const { clientWidth, clientHeight } = this.parts.canvas.parentElement;
    return [clientWidth, clientHeight];
  }

  async #endFilm() {
    const film = this.film;
    this.draw();
    this.film = null;
    this.parts.film.textContent = said("Film (WebM)");
    this.lastFilm = await film.stop();
    saved(this.lastFilm, `${fileName(this.run.title)}.webm`);
    this.say(said("The film is saved: {} MB.", decimal(this.lastFilm.size / 1e6, 1)));
  }

  #listen(root) {
    const { parts } = this;
    parts.play.addEventListener("click", () => (this.playing ? this.pause() : this.play()));
    parts.time.addEventListener("input", () => this.seek(Number(parts.time.value)));
    parts.speed.addEventListener("change", () => (this.rate = Number(parts.speed.value)));
    parts.exaggeration.addEventListener("input", () => this.exaggerate(Number(parts.exaggeration.value)));
    parts.relief.addEventListener("input", () => this.deepen(Number(parts.relief.value)));
    parts.drawing.addEventListener("change", () => this.drawAs(parts.drawing.value));
    parts.views.addEventListener("click", (event) => event.target.dataset.view && this.look(event.target.dataset.view));
    parts.shown.addEventListener("change", (event) => this.show(event.target.dataset.show, event.target.checked));
    parts.film.addEventListener("click", () => (this.film ? this.pause() : this.startFilm()));
    parts.picture.addEventListener("click", async () => {
      saved(await this.picture(), `${fileName(this.run.title)}-${this.time.toFixed(2)}s.png`);
      this.say(said("The picture is saved."));
    });
    const isMeant = (target) => target === document.body || root.contains(target); // where nothing has the focus, too
    document.addEventListener("keydown", (event) => isMeant(event.target) && this.#key(event));
    this.#fingers();
  }

  /** Drag to turn, wheel or two fingers to come nearer. */
  #fingers() {
    const { canvas } = this.parts;
    const down = new Map();
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      down.set(event.pointerId, [event.clientX, event.clientY]);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!down.has(event.pointerId)) return;
      const [x, y] = down.get(event.pointerId);
      const apart = spread(down);
      down.set(event.pointerId, [event.clientX, event.clientY]);
      if (down.size === 1) this.turn(-0.006 * (event.clientX - x), 0.006 * (event.clientY - y));
      else if (apart > 0) this.nearer(apart / spread(down));
    });
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => down.delete(event.pointerId));
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.nearer(Math.exp(0.001 * event.deltaY));
    }, { passive: false });
  }

  #key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { target } = event;
    const step = event.shiftKey ? LARGE_STEP : STEP;
    const ownKeys = target.tagName === "SELECT" || (target.type === "range" && target !== this.parts.time);
    const presses = ["BUTTON", "SUMMARY", "A"].includes(target.tagName) || target.type === "checkbox";
    const deeds = {
      " ": presses || ownKeys ? null : () => (this.playing ? this.pause() : this.play()),
      ArrowLeft: ownKeys ? null : () => this.seek(this.time - step),
      ArrowRight: ownKeys ? null : () => this.seek(this.time + step),
      Home: ownKeys ? null : () => this.seek(this.start),
      End: ownKeys ? null : () => this.seek(this.end),
      "+": () => this.nearer(0.85),
      "=": () => this.nearer(0.85),
      "-": () => this.nearer(1 / 0.85),
      a: () => this.turn(-0.1, 0),
      d: () => this.turn(0.1, 0),
      w: () => this.turn(0, 0.08),
      s: () => this.turn(0, -0.08),
      x: () => this.exaggerate(this.exaggeration - 1),
      c: () => this.exaggerate(this.exaggeration + 1),
      v: () => this.deepen(this.relief - 1),
      b: () => this.deepen(this.relief + 1),
      g: () => this.show("groove", !this.shown.groove),
      m: () => this.show("marks", !this.shown.marks),
      f: () => this.show("forces", !this.shown.forces),
      o: () => this.show("ghost", !this.shown.ghost),
      t: () => this.show("track", !this.shown.track),
    };
    VIEWS.forEach((view, i) => (deeds[String(i + 1)] = () => this.look(view)));
    const deed = target.tagName === "SELECT" ? null : deeds[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!deed) return;
    event.preventDefault();
    deed();
  }

  /** Both edges of a ski as they are drawn, for whoever checks them. */
  edgesAt(time, ski, exaggeration = 1) {
    return edges(this.run, time, ski, exaggeration);
  }
}

const duration = (run) => run.arrays.time.values.at(-1) - run.arrays.time.values[0];

function spread(down) {
  const [one, other] = [...down.values()];
  return other ? Math.hypot(one[0] - other[0], one[1] - other[1]) : 0;
}

function inView(element) {
  const { top, bottom } = element.getBoundingClientRect();
  return bottom > 0 && top < window.innerHeight;
}

const fileName = (title) => title.replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "") || "replay";
