// Colours with a meaning: those of force and depth come with the run, so that every picture of it has the same.

export const GHOST = [124, 77, 190];
export const TRACK = [0, 110, 90];

function along(colours, share) {
  const at = Math.min(Math.max(share, 0), 1) * (colours.length - 1);
  const index = Math.min(Math.floor(at), colours.length - 2);
  return colours[index].map((part, i) => part + (at - index) * (colours[index + 1][i] - part));
}

/** Colour of a force per length; `most` is the end of the scale, `colours` those of a run. */
export function forceColour(force, most, colours) {
  return force <= colours.least_share * most ? colours.unloaded : along(colours.force, force / most);
}

export function depthColour(depth, most, colours) {
  return along(colours.depth, most > 0 ? depth / most : 0);
}

/** The next of 1, 2, 5 times a power of ten that is not below a number. */
export function roundAbove(value) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 1.5, 2, 3, 5, 10].find((digit) => digit * power >= value * 0.999999) * power;
}

export const css = ([r, g, b]) => `rgb(${Math.round(r)}, ${Math.round(g)}, ${Math.round(b)})`;

/** A CSS gradient of a scale, from nothing to the most. */
export function gradient(colours) {
  return `linear-gradient(to right, ${colours.map(css).join(", ")})`;
}
