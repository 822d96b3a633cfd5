// A tile of snow in low sun, made once: how bright each place is, the same on opposite edges. Drawn, not computed with.

import * as THREE from "./three.module.min.js";

const SIZE = 256;
const TOWARD_SUN = [-0.57, 0.82]; // in the tile's own axes
const OCTAVES = [[4, 1], [9, 0.55], [19, 0.3], [41, 0.17], [83, 0.1]]; // waves across the tile, height

/** A picture of one channel: 0.5 is even snow. */
export function snowTile() {
  const heights = new Float32Array(SIZE * SIZE);
  for (const [waves, height] of OCTAVES) add(heights, waves, height);
  const bright = new Uint8Array(SIZE * SIZE);
  for (let j = 0; j < SIZE; j++) {
    for (let i = 0; i < SIZE; i++) {
      const rise = [at(heights, i + 1, j) - at(heights, i - 1, j), at(heights, i, j + 1) - at(heights, i, j - 1)];
      const light = 0.5 - 6.5 * (rise[0] * TOWARD_SUN[0] + rise[1] * TOWARD_SUN[1]);
      bright[j * SIZE + i] = 255 * Math.min(Math.max(light, 0), 1);
    }
  }
  const tile = new THREE.DataTexture(bright, SIZE, SIZE, THREE.RedFormat, THREE.UnsignedByteType);
  tile.wrapS = tile.wrapT = THREE.RepeatWrapping;
  tile.magFilter = THREE.LinearFilter;
  tile.minFilter = THREE.LinearMipmapLinearFilter;
  tile.generateMipmaps = true;
  tile.needsUpdate = true;
  return tile;
}

const at = (values, i, j) => values[((j + SIZE) % SIZE) * SIZE + ((i + SIZE) % SIZE)];

/** Smooth hills between numbers drawn for the corners of a coarser grid. */
function add(heights, waves, height) {
  const corners = Float32Array.from({ length: waves * waves }, (_, i) => drawn(i + 977 * waves));
  const corner = (i, j) => corners[(j % waves) * waves + (i % waves)];
  for (let j = 0; j < SIZE; j++) {
    const [below, up] = parts((j * waves) / SIZE);
    for (let i = 0; i < SIZE; i++) {
      const [left, right] = parts((i * waves) / SIZE);
      const low = (1 - right) * corner(left, below) + right * corner(left + 1, below);
      const high = (1 - right) * corner(left, below + 1) + right * corner(left + 1, below + 1);
      heights[j * SIZE + i] += (height / waves) * 4 * ((1 - up) * low + up * high);
    }
  }
}

function parts(value) {
  const whole = Math.floor(value);
  const share = value - whole;
  return [whole, share * share * (3 - 2 * share)];
}

/** A number from 0 to 1 that looks drawn and is the same each time. */
function drawn(seed) {
  const wave = Math.sin(seed * 12.9898) * 43758.5453;
  return wave - Math.floor(wave);
}
