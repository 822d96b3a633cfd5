// To take away: the picture as PNG and a film as WebM, both with the readings written on them.

import { css } from "./colours.js";
import { asWritten } from "./words.js";

/** Draw the picture with words and scales of colours, each {title, colours, most, goesOn}, on a flat canvas of its own. */
export function composed(canvas, flat, words, scales) {
  if (flat.width !== canvas.width || flat.height !== canvas.height) {
    flat.width = canvas.width;
    flat.height = canvas.height;
  }
  const pen = flat.getContext("2d");
  pen.drawImage(canvas, 0, 0);
  const size = Math.max(13, Math.round(flat.height / 42));
  pen.font = `600 ${size}px system-ui, sans-serif`;
  pen.textBaseline = "top";
  const width = Math.max(...[...words, ...scales.map(({ title }) => title)].map((text) => pen.measureText(text).width));
  pen.fillStyle = "rgba(255, 255, 255, 0.86)";
  pen.fillRect(size * 0.6, size * 0.6, width + size * 1.2, (words.length + 2.9 * scales.length) * size * 1.4 + size * 0.4);
  pen.fillStyle = "#10202e";
  words.forEach((text, i) => pen.fillText(text, size * 1.2, size * (1.1 + 1.4 * i)));
  scales.forEach((scale, i) => {
    const line = words.length + 2.9 * i;
    pen.fillText(scale.title, size * 1.2, size * (1.1 + 1.4 * line));
    bar(pen, scale, size * 1.2, size * (2.5 + 1.4 * line), width, size);
  });
  return flat;
}

function bar(pen, { colours, most, goesOn }, left, top, width, size) {
  const shades = pen.createLinearGradient(left, 0, left + width, 0);
  colours.forEach((colour, i) => shades.addColorStop(i / (colours.length - 1), css(colour)));
  pen.fillStyle = shades;
  pen.fillRect(left, top, width, size * 0.8);
  pen.fillStyle = "#10202e";
  pen.fillText("0", left, top + size);
  const end = `${goesOn ? "≥ " : ""}${asWritten(most)}`;
  pen.fillText(end, left + width - pen.measureText(end).width, top + size);
}

export function saved(blob, name) {
  const address = URL.createObjectURL(blob);
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/** The film's format that this browser can write, or null. */
export function filmType() {
  if (typeof MediaRecorder === "undefined" || !HTMLCanvasElement.prototype.captureStream) return null;
  const types = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"];
  return types.find((type) => MediaRecorder.isTypeSupported(type)) ?? null;
}

const LINGER = 300; // ms that the last picture stands: an encoder on a slow machine has fewer pictures in hand than drawn

/** Record a canvas: `begun` is a promise of its start, `stop()` one of the film. */
export function recording(flat) {
  const recorder = new MediaRecorder(flat.captureStream(30), { mimeType: filmType(), videoBitsPerSecond: 6_000_000 });
  const pieces = [];
  recorder.ondataavailable = (event) => pieces.push(event.data);
  const film = new Promise((resolve, reject) => {
    recorder.onstop = () => resolve(new Blob(pieces, { type: "video/webm" }));
    recorder.onerror = (event) => reject(event.error);
  });
  const begun = new Promise((resolve) => recorder.addEventListener("start", resolve, { once: true }));
  recorder.start(500);
  return {
    begun,
    async stop() {
      await new Promise((resolve) => setTimeout(resolve, LINGER));
      if (recorder.state !== "inactive") recorder.stop();
      return film;
    },
  };
}
