// The words, buttons and sliders around the picture: made once, each with a name that a screen reader says.

import { css, GHOST, gradient, TRACK } from "./colours.js";
import { skiForces } from "./force_arrows.js";
import { edgeAngle, yaws } from "./motion.js";
import { settings } from "./sharpness.js";
import { asWritten, decimal, said } from "./words.js";

export const MOST_RELIEF = 30;
const speeds = () => [
  [1, said("true speed")], [0.5, said("half speed")], [0.25, said("a quarter")], [0.1, said("a tenth")],
];
const viewNames = () => ({
  chase: said("From behind"), boot: said("From the boot"), above: said("From above"), edge: said("Along the edge"), free: said("Free"),
});
export const marks = () => said("Squares 1 m, a dash of the path each metre");
export const forceTitle = () => said("Normal force of the snow on the ski (N/mm)");
export const depthTitle = () => said("Permanent groove depth (mm)");
const keysOf = () => [
  [said("Space"), said("play or pause")], ["← →", said("a twentieth of a second; with Shift half a second")],
  [said("Home End"), said("start, end")], ["1 2 3 4 5", said("behind, boot, above, edge, free")],
  ["+ −", said("nearer, farther")], ["A D W S", said("turn the free view")],
  ["X C", said("less, more exaggeration of bending and twist")], ["V B", said("the groove less, more deep")],
  ["G M F O T", said("groove, metre marks, forces, other run, measured track")],
];

/** An element with properties, attributes (`aria-…`, `data-…`, `for`) and children. */
export function made(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes("-") || name === "for" || name === "role") element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children);
  return element;
}

/** All parts of the page, by name. */
export function controls({ run, ghost }) {
  const parts = {
    canvas: made("canvas", { className: "replay-canvas", tabIndex: 0, role: "img", "aria-label": said("Replay of {}", run.title) }),
    readings: made("dl", { className: "replay-readings", "aria-label": said("Readings") }),
    legend: made("div", { className: "replay-legend" }),
    message: made("p", { className: "replay-message", role: "status" }),
    play: made("button", { type: "button", className: "replay-play", textContent: said("Play") }),
    time: slider(said("Time"), 0, 1, 0.001),
    speed: choice(said("Speed of play"), speeds()),
    exaggeration: slider(said("Exaggeration of bending and twist"), 1, 20, 1),
    exaggerated: made("output", { textContent: "1 ×" }),
    relief: slider(said("Exaggeration of the groove"), 1, MOST_RELIEF, 1),
    deepened: made("output", { textContent: "1 ×" }),
    drawing: choice(said("Drawing"), settings()),
    views: made("div", { className: "replay-views", role: "group", "aria-label": said("View") }),
    shown: made("div", { className: "replay-shown", role: "group", "aria-label": said("What is shown") }),
    picture: made("button", { type: "button", textContent: said("Picture (PNG)") }),
    film: made("button", { type: "button", textContent: said("Film (WebM)") }),
  };
  for (const [name, text] of Object.entries(viewNames())) {
    parts.views.append(made("button", { type: "button", textContent: text, "data-view": name, "aria-pressed": "false" }));
  }
  const toggles = [["groove", said("Groove"), null], ["marks", said("Metre marks"), null], ["forces", said("Forces"), null]];
  if (ghost) toggles.push(["ghost", said("Other run: {}", ghost.title), css(GHOST)]);
  if (run.track_name) toggles.push(["track", said("Measured: {}", run.track_name), css(TRACK)]);
  for (const [name, text, colour] of toggles) parts.shown.append(toggle(name, text, colour, name !== "forces"));
  return parts;
}

function slider(label, min, max, step) {
  return made("input", { type: "range", min, max, step, value: min, "aria-label": label });
}


function choice(label, entries) {
  const options = entries.map(([value, text]) => made("option", { value, textContent: text }));
  return made("select", { "aria-label": label }, ...options);
}

function toggle(name, text, colour, checked) {
  const box = made("input", { type: "checkbox", checked, "data-show": name });
  const mark = colour ? [made("span", { className: "replay-swatch", style: `background:${colour}` })] : [];
  return made("label", {}, box, ...mark, made("span", { textContent: text }));
}

/** Put the parts into the page. */
export function laidOut(root, parts, run) {
  const facts = made("dl", { className: "replay-facts" });
  for (const [name, value] of run.facts) facts.append(made("dt", { textContent: name }), made("dd", { textContent: value }));
  const field = (text, ...inputs) => made("div", { className: "replay-field" }, made("span", { textContent: text }), ...inputs);
  const keys = made("dl", { className: "replay-keys" });
  for (const [key, text] of keysOf()) keys.append(made("dt", { textContent: key }), made("dd", { textContent: text }));
  const takeAway = [parts.picture, parts.film].filter(Boolean);
  root.classList.add("replay");
  root.replaceChildren(
    made("div", { className: "replay-stage" }, parts.canvas, parts.readings, parts.legend, parts.map),
    made(
      "div",
      { className: "replay-controls", role: "group", "aria-label": said("Controls of the replay") },
      made("div", { className: "replay-row replay-playing" }, parts.play, parts.time, parts.speed),
      made("div", { className: "replay-row" }, parts.views, parts.shown),
      made("div", { className: "replay-row" }, field(said("Groove depth"), parts.relief, parts.deepened),
        field(said("Bending and twist"), parts.exaggeration, parts.exaggerated), field(said("Export"), ...takeAway)),
      parts.message,
      made("details", {}, made("summary", { textContent: said("Drawing, keys, and description of this run") }),
        field(said("Drawing"), parts.drawing), keys, facts),
    ),
  );
}

/** The legend of force and groove, with units, and what of a skier is drawn by assumption. */
export function fillLegend(element, scales, colours, hasSkier) {
  const bar = (kind, title, ticks) => {
    const ends = ticks.map((text) => made("span", { textContent: text }));
    return made("div", { className: "replay-scale" },
      made("span", { className: "replay-scale-title", textContent: title }),
      made("span", { className: "replay-bar", style: `background:${gradient(colours[kind])}` }),
      made("span", { className: "replay-ticks" }, ...ends));
  };
  element.replaceChildren(
    bar("force", forceTitle(), ticksOf(scales.force / 1000, scales.forceGoesOn)),
    scales.staysNothing
      ? made("span", { textContent: said("Elastic snow: no groove stays; the line is where the skis went") })
      : bar("depth", depthTitle(), ticksOf(scales.depth * 1000)),
    made("div", { className: "replay-notes" },
      made("span", { className: "replay-marks", textContent: marks() }),
      made("span", { className: "replay-arrows", hidden: true, textContent: said("Arrows: orange, normal force per length; purple, total force on the ski") }),
      ...(hasSkier ? [made("span", { textContent: said("Assumed: knees, trunk's bend, head, arms, poles") })] : [])),
  );
}

function ticksOf(most, goesOn = false) {
  const ticks = [0, most / 2, most].map((value) => asWritten(Number(value.toPrecision(3))));
  return goesOn ? [...ticks.slice(0, 2), `≥ ${ticks[2]}`] : ticks;
}

const LEFT = 0;

/** An angle (rad) in degrees, and to which side. */
function sided(angle, none = "0°") {
  const size = Math.abs((180 / Math.PI) * angle).toFixed(0);
  if (size === "0") return none;
  return angle > 0 ? said("{}° left", size) : said("{}° right", size);
}

/** A bar of a share, beside its number. */
export const meter = () => made("span", { className: "replay-meter", role: "meter", "aria-valuemin": 0, "aria-valuemax": 100 });

export function setMeter(element, { name, share }) {
  element.style.setProperty("--share", `${share}%`);
  element.setAttribute("aria-valuenow", share);
  element.setAttribute("aria-label", name);
}

/** Readings of a skier: edge angle, force of the snow over the weight, share of each ski (%), and how the skis are turned. */
function skierReadings(run, pose) {
  const forces = skiForces(run, pose.at);
  const force = Math.hypot(...[0, 1, 2].map((axis) => forces[0].vector[axis] + forces[1].vector[axis]));
  const [left, right] = forces.map(({ normal }) => Math.max(normal, 0));
  const share = left + right > 0 ? Math.round((100 * left) / (left + right)) : 0;
  const shares = left + right > 0 ? [share, 100 - share] : [0, 0];
  const names = [said("Load on left ski"), said("Load on right ski")];
  const { body, path } = yaws(run, pose);
  return [
    { name: said("Edge angle"), text: sided((edgeAngle(run, 0, pose.time) + edgeAngle(run, 1, pose.time)) / 2, said("flat")), large: true },
    { name: said("Load in body weights"), text: decimal(force / run.skier.weight, 1), large: true },
    ...shares.map((each, ski) => ({ name: names[ski], text: `${each} %`, share: each, large: false })),
    { name: said("Skis turned from body"), text: sided(body), large: false },
    { name: said("Skis turned from path"), text: sided(path), large: false },
  ];
}

/**
 * What is told of a moment, as {name, text, large, share}: the numbers that matter first and large. `outer` is the ski
 * that carries more; `gap` is told of two runs through gates, `forces` of both skis, {total, normal} (N) each, where they are shown.
 */
export function readings(run, pose, { row, outer, gap = null, forces = null }) {
  const of = (name, size = 1) => row(run.arrays[name].values, pose.at, size);
  const curvature = of("curvature")[0];
  const size = decimal(1 / Math.abs(curvature), 1);
  const turn = curvature > 0 ? said("{} m left", size) : said("{} m right", size);
  const radius = Math.abs(curvature) < 1e-3 ? said("straight") : turn;
  const depths = Array.from(of("depth", 2), (depth) => (depth > 0 ? `${decimal(1000 * depth, 1)} mm` : said("above the snow")));
  const depth = (ski, large) => ({ name: ski === LEFT ? said("Depth at left boot") : said("Depth at right boot"), text: depths[ski], large });
  const lines = [
    { name: said("Speed"), text: `${decimal(of("speed")[0], 2)} m/s`, large: true },
    { name: said("Turn radius"), text: radius, large: true },
    ...(gap ? [{ ...gap, large: true }] : []),
    ...(run.skier ? skierReadings(run, pose) : [depth(outer, true), depth(1 - outer, false)]),
    { name: said("Time"), text: `${decimal(pose.time, 2)} s`, large: false },
  ];
  if (!forces) return lines;
  const names = [
    { total: said("Total force on left ski"), normal: said("Normal force on left ski") },
    { total: said("Total force on right ski"), normal: said("Normal force on right ski") },
  ];
  const text = (force) => `${force.toFixed(0)} N`;
  return [...lines, ...["total", "normal"].flatMap((part) => forces.map((force, ski) => ({ name: names[ski][part], text: text(force[part]), large: false })))];
}
