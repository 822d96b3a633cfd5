// The words, buttons and sliders around the picture: made once, each with a name that a screen reader says.

import { css, GHOST, gradient, TRACK } from "./colours.js";
import { edgeAngle } from "./motion.js";
import { SETTINGS } from "./sharpness.js";

export const MOST_RELIEF = 30;
export const SPEEDS = [[1, "true speed"], [0.5, "half speed"], [0.25, "a quarter"], [0.1, "a tenth"]];
export const VIEW_NAMES = { chase: "From behind", boot: "From the boot", above: "From above", edge: "Along the edge", free: "Free" };
const ARROWS = "Arrows: orange, force per length; purple, whole ski";
const SKIER = "Assumed: knees, trunk's bend, head, arms, poles";
export const MARKS = "Squares 1 m, a dash of the path each metre";
export const FORCE_TITLE = "Force of the snow on the ski (N/mm)";
export const DEPTH_TITLE = "Permanent groove depth (mm)";
const KEYS = [
  ["Space", "play or pause"], ["← →", "a twentieth of a second; with Shift half a second"], ["Home End", "start, end"],
  ["1 2 3 4 5", "behind, boot, above, edge, free"], ["+ −", "nearer, farther"], ["A D W S", "turn the free view"],
  ["X C", "less, more exaggeration of bending and twist"], ["V B", "the groove less, more deep"],
  ["G M F O T", "groove, metre marks, forces, other run, measured track"],
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
export function controls({ run, ghost, modelAddress, movingModelAddress }) {
  const parts = {
    canvas: made("canvas", { className: "replay-canvas", tabIndex: 0, role: "img", "aria-label": `Replay of ${run.title}` }),
    readings: made("dl", { className: "replay-readings", "aria-label": "Readings" }),
    legend: made("div", { className: "replay-legend" }),
    message: made("p", { className: "replay-message", role: "status" }),
    play: made("button", { type: "button", className: "replay-play", textContent: "Play" }),
    time: slider("Time", 0, 1, 0.001),
    speed: choice("Speed of play", SPEEDS),
    exaggeration: slider("Exaggeration of bending and twist", 1, 20, 1),
    exaggerated: made("output", { textContent: "1 ×" }),
    relief: slider("Exaggeration of the groove", 1, MOST_RELIEF, 1),
    deepened: made("output", { textContent: "1 ×" }),
    drawing: choice("Drawing", SETTINGS),
    views: made("div", { className: "replay-views", role: "group", "aria-label": "View" }),
    shown: made("div", { className: "replay-shown", role: "group", "aria-label": "What is shown" }),
    picture: made("button", { type: "button", textContent: "Picture (PNG)" }),
    film: made("button", { type: "button", textContent: "Film (WebM)" }),
    movingModel: movingModelAddress ? fileLink("Model that moves (glTF)") : null,
    model: modelAddress ? fileLink("Model of this moment (glTF)") : null,
  };
  for (const [name, text] of Object.entries(VIEW_NAMES)) {
    parts.views.append(made("button", { type: "button", textContent: text, "data-view": name, "aria-pressed": "false" }));
  }
  const toggles = [["groove", "Groove", null], ["marks", "Metre marks", null], ["forces", "Forces", null]];
  if (ghost) toggles.push(["ghost", `Other run: ${ghost.title}`, css(GHOST)]);
  if (run.track_name) toggles.push(["track", `Measured: ${run.track_name}`, css(TRACK)]);
  for (const [name, text, colour] of toggles) parts.shown.append(toggle(name, text, colour, name !== "forces"));
  return parts;
}

function slider(label, min, max, step) {
  return made("input", { type: "range", min, max, step, value: min, "aria-label": label });
}

const fileLink = (text) => made("a", { textContent: text, className: "replay-button", download: "" });

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
  for (const [key, text] of KEYS) keys.append(made("dt", { textContent: key }), made("dd", { textContent: text }));
  const takeAway = [parts.picture, parts.film, parts.movingModel, parts.model].filter(Boolean);
  root.classList.add("replay");
  root.replaceChildren(
    made("div", { className: "replay-stage" }, parts.canvas, parts.readings, parts.legend, parts.map),
    made(
      "div",
      { className: "replay-controls", role: "group", "aria-label": "Controls of the replay" },
      made("div", { className: "replay-row replay-playing" }, parts.play, parts.time, parts.speed),
      made("div", { className: "replay-row" }, parts.views, parts.shown),
      made("div", { className: "replay-row" }, field("Groove depth", parts.relief, parts.deepened),
        field("Bending and twist", parts.exaggeration, parts.exaggerated), field("Export", ...takeAway)),
      parts.message,
      made("details", {}, made("summary", { textContent: "Drawing, keys, and what this run is" }),
        field("Drawing", parts.drawing), keys, facts),
    ),
  );
}

/** The legend of force and groove, with units, and what of a skier is drawn by assumption. */
export function fillLegend(element, scales, colours, hasSkier) {
  const bar = (kind, title, ticks) => {
    const marks = ticks.map((text) => made("span", { textContent: text }));
    return made("div", { className: "replay-scale" },
      made("span", { className: "replay-scale-title", textContent: title }),
      made("span", { className: "replay-bar", style: `background:${gradient(colours[kind])}` }),
      made("span", { className: "replay-ticks" }, ...marks));
  };
  element.replaceChildren(
    bar("force", FORCE_TITLE, ticksOf(scales.force / 1000)),
    scales.staysNothing
      ? made("span", { textContent: "Elastic snow: no groove stays; the line is where the skis went" })
      : bar("depth", DEPTH_TITLE, ticksOf(scales.depth * 1000)),
    made("div", { className: "replay-notes" },
      made("span", { className: "replay-marks", textContent: MARKS }),
      made("span", { className: "replay-arrows", hidden: true, textContent: ARROWS }),
      ...(hasSkier ? [made("span", { textContent: SKIER })] : [])),
  );
}

function ticksOf(most) {
  return [0, most / 2, most].map((value) => String(Number(value.toPrecision(3))));
}

const SIDES = ["left", "right"];

/** Mean edge angle of both skis, and to which side. */
function edged(run, time) {
  const angle = (90 / Math.PI) * (edgeAngle(run, 0, time) + edgeAngle(run, 1, time));
  return Math.abs(angle) < 0.5 ? "flat" : `${Math.abs(angle).toFixed(0)}° ${SIDES[angle > 0 ? 0 : 1]}`;
}

/**
 * What is told of a moment, as {name, text, large, words}: the numbers that matter first and large. `outer` is the ski
 * that carries more; `gap` is told of two runs through gates, `forces` (N) of both skis where they are shown.
 */
export function readings(run, pose, { row, outer, gap = null, forces = null }) {
  const of = (name, size = 1) => row(run.arrays[name].values, pose.at, size);
  const curvature = of("curvature")[0];
  const radius = Math.abs(curvature) < 1e-3 ? "straight" : `${(1 / Math.abs(curvature)).toFixed(1)} m ${SIDES[curvature > 0 ? 0 : 1]}`;
  const depths = Array.from(of("depth", 2), (depth) => (depth > 0 ? `${(1000 * depth).toFixed(1)} mm` : "above the snow"));
  const depth = (ski, large) => ({ name: `Depth at ${SIDES[ski]} boot`, text: depths[ski], large: large && !run.skier });
  const lines = [
    { name: "Speed", text: `${of("speed")[0].toFixed(2)} m/s`, large: true },
    { name: "Turn radius", text: radius, large: true },
    ...(run.skier ? [{ name: "Edge angle", text: edged(run, pose.time), large: true }] : []),
    ...(gap ? [{ ...gap, large: true }] : []),
    depth(outer, true),
    depth(1 - outer, false),
    { name: "Time", text: `${pose.time.toFixed(2)} s`, large: false },
  ];
  if (!forces) return lines;
  return [...lines, ...SIDES.map((side, ski) => ({ name: `Force on ${side} ski`, text: `${forces[ski].toFixed(0)} N`, large: false }))];
}
