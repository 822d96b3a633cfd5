// Two runs through the same gates: which one was there first, and by how much.

import { decimal, said } from "./words.js";

const APART = 0.05; // m between the poles of gates that are the same

/** The gap at the last gate that both have behind them at a time, as {name, text}; null where they share no course. */
export function gapAt(run, ghost, time) {
  if (!ghost || !haveSameGates(run, ghost)) return null;
  const [own, other] = [run, ghost].map((each) => each.arrays.gate_time.values);
  const since = time - run.arrays.time.values[0];
  let last = -1;
  own.forEach((at, i) => {
    if (Math.max(at, other[i]) <= since) last = i; // the time of a gate that was not reached is NaN
  });
  if (last < 0) return { name: said("Gap at the first gate"), text: said("not yet") };
  const late = own[last] - other[last];
  const size = decimal(Math.abs(late), 2);
  const words = late > 0 ? said("{} s behind", size) : said("{} s ahead", size);
  return { name: said("Gap at gate {}", last + 1), text: Math.abs(late) < 0.005 ? said("level") : words };
}

function haveSameGates(run, ghost) {
  const [one, other] = [run, ghost].map(({ arrays }) => (arrays.gate_time ? arrays.gate_place.values : null));
  return Boolean(one && other) && one.length === other.length && one.every((part, i) => Math.abs(part - other[i]) < APART);
}
