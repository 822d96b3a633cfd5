// A replay's bytes, as skisnow.replay.page writes them, made into arrays of numbers.

const MAGIC = "SKRP";
const FORMAT = 2;

/** The header with `arrays`: {name: {values: Float32Array, shape, unit, lowest, highest}}. */
export function decoded(buffer) {
  const bytes = new Uint8Array(buffer);
  if (String.fromCharCode(...bytes.subarray(0, 4)) !== MAGIC) throw new Error("These bytes are no replay.");
  const length = new DataView(buffer).getUint32(4, true);
  const header = JSON.parse(new TextDecoder().decode(bytes.subarray(8, 8 + length)));
  if (header.format !== FORMAT) throw new Error(`The replay has format ${header.format}; this page reads ${FORMAT}.`);
  const arrays = {};
  for (const [name, each] of Object.entries(header.arrays)) arrays[name] = array(buffer, 8 + length, each);
  return { ...header, arrays };
}

function array(buffer, base, each) {
  const count = each.shape.reduce((product, size) => product * size, 1);
  const values = new Float32Array(count);
  const view = new DataView(buffer, base + each.start);
  if (each.type === "float32") {
    for (let i = 0; i < count; i++) values[i] = view.getFloat32(4 * i, true);
  } else {
    for (let i = 0; i < count; i++) values[i] = each.lowest + each.step * view.getUint16(2 * i, true);
  }
  return { values, shape: each.shape, unit: each.unit };
}

/** The largest of many numbers; a spread argument would overflow the stack. */
export function largest(values) {
  let most = -Infinity;
  for (const value of values) if (value > most) most = value;
  return most;
}
