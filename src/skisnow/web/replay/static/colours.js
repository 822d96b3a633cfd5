// Colours with a meaning: force along a ski, depth of a groove. Dark is much, so that both stand out on snow.

// yellow, orange, red, purple, near black: rising in darkness all the way, told apart without red or green as well
const FORCE = [[255, 233, 148], [253, 180, 83], [240, 105, 68], [190, 45, 92], [112, 20, 106], [45, 10, 70]];
const DEPTH = [[170, 196, 219], [95, 144, 190], [38, 92, 150], [12, 42, 92]];

/** A ski without load (sRGB, 0 to 255). */
export const UNLOADED = [214, 220, 226];
export const GHOST = [124, 77, 190];
export const TRACK = [0, 110, 90];

function along(colours, share) {
  const at = Math.min(Math.max(share, 0), 1) * (colours.length - 1);
  const index = Math.min(Math.floor(at), colours.length - 2);
  return colours[index].map((part, i) => part + (at - index) * (colours[index + 1][i] - part));
}

/** Colour of a force per length; `most` is the end of the scale. */
export function forceColour(force, most) {
  return force <= 0.002 * most ? UNLOADED : along(FORCE, force / most);
}

export function depthColour(depth, most) {
  return along(DEPTH, most > 0 ? depth / most : 0);
}

/** The next of 1, 2, 5 times a power of ten that is not below a number. */
export function roundAbove(value) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 1.5, 2, 3, 5, 10].find((digit) => digit * power >= value * 0.999999) * power;
}

export const css = ([r, g, b]) => `rgb(${Math.round(r)}, ${Math.round(g)}, ${Math.round(b)})`;

/** A CSS gradient of a scale, from nothing to the most. */
export function gradient(kind) {
  const colours = kind === "force" ? FORCE : DEPTH;
  return `linear-gradient(to right, ${colours.map(css).join(", ")})`;
}
