// Two runs through the same gates: which one was there first, and by how much.

const APART = 0.05; // m between the poles of gates that are the same

/** The gap at the last gate that both have behind them at a time, as {name, text}; null where they share no course. */
export function gapAt(run, ghost, time) {
  if (!ghost || !haveSameGates(run, ghost)) return null;
  const [own, other] = [run, ghost].map((each) => each.arrays.gate_time.values);
  const since = time - run.arrays.time.values[0];
  let last = -1;
  own.forEach((at, i) => {
    if (Math.max(at, other[i]) <= since) last = i; // of a gate that was not reached the time is no number
  });
  if (last < 0) return { name: "Gap at the first gate", text: "not yet" };
  const late = own[last] - other[last];
  const words = Math.abs(late) < 0.005 ? "level" : `${Math.abs(late).toFixed(2)} s ${late > 0 ? "behind" : "ahead"}`;
  return { name: `Gap at gate ${last + 1}`, text: words };
}

function haveSameGates(run, ghost) {
  const [one, other] = [run, ghost].map(({ arrays }) => (arrays.gate_time ? arrays.gate_place.values : null));
  return Boolean(one && other) && one.length === other.length && one.every((part, i) => Math.abs(part - other[i]) < APART);
}
