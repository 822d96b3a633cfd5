// The whole run from above on a small canvas: path, current place, fall line downwards, and a scale of 10 m.

import { css, TRACK } from "./colours.js";
import { said } from "./words.js";

const SIZE = 150; // px of the page
const MARGIN = 16;

/** A canvas with `show(place)`; it is drawn twice as fine as it is shown. */
export function miniMap(run) {
  const canvas = document.createElement("canvas");
  canvas.className = "replay-map";
  canvas.width = canvas.height = 2 * SIZE;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", said("The run from above, the fall line downwards; a bar of 10 m"));
  const frame = framed(run.arrays.place.values);
  const still = ground(run, frame);
  const pen = canvas.getContext("2d");
  return {
    canvas,
    show([x, y]) {
      pen.clearRect(0, 0, 2 * SIZE, 2 * SIZE);
      pen.drawImage(still, 0, 0);
      pen.fillStyle = "#d55e00";
      pen.beginPath();
      pen.arc(...frame.at(x, y), 10, 0, 2 * Math.PI);
      pen.fill();
    },
  };
}

/** From metres to pixels: x down, y to the right as one who looks uphill sees it, the same scale along both. */
function framed(path) {
  const [low, high] = [[Infinity, Infinity], [-Infinity, -Infinity]];
  for (let i = 0; i < path.length; i += 3) {
    for (const axis of [0, 1]) {
      low[axis] = Math.min(low[axis], path[i + axis]);
      high[axis] = Math.max(high[axis], path[i + axis]);
    }
  }
  const scale = (2 * (SIZE - 2 * MARGIN)) / Math.max(high[0] - low[0], high[1] - low[1], 1);
  const middle = [0, 1].map((axis) => (low[axis] + high[axis]) / 2);
  return { scale, at: (x, y) => [SIZE + scale * (y - middle[1]), SIZE + scale * (x - middle[0])] };
}

function ground(run, frame) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 2 * SIZE;
  const pen = canvas.getContext("2d");
  line(pen, run.arrays.place.values, frame, "#10202e");
  if (run.arrays.track_place) line(pen, run.arrays.track_place.values, frame, css(TRACK));
  pen.fillStyle = pen.strokeStyle = "#0b4f8a";
  pen.lineWidth = 4;
  pen.beginPath(); // the fall line
  pen.moveTo(20, 14);
  pen.lineTo(20, 56);
  pen.stroke();
  pen.beginPath();
  pen.moveTo(9, 52);
  pen.lineTo(31, 52);
  pen.lineTo(20, 74);
  pen.fill();
  const bar = 10 * frame.scale <= 1.6 * SIZE ? 10 : 1;
  pen.fillStyle = "#10202e";
  pen.fillRect(14, 2 * SIZE - 16, bar * frame.scale, 5);
  pen.font = "600 24px system-ui, sans-serif";
  pen.fillText(`${bar} m`, 14, 2 * SIZE - 24);
  return canvas;
}

function line(pen, places, frame, colour) {
  pen.strokeStyle = colour;
  pen.lineWidth = 5;
  pen.lineJoin = "round";
  pen.beginPath();
  for (let i = 0; i < places.length; i += 3) pen.lineTo(...frame.at(places[i], places[i + 1]));
  pen.stroke();
}
