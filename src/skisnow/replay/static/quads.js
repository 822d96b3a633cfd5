// Rectangles that lie on the snow, many in one geometry: pieces of grooves and of lines.

import * as THREE from "./three.module.min.js";

const CORNERS = [[-1, -1], [1, -1], [1, 1], [-1, 1]];
const SIZES = { position: 3, beside: 3, along: 3, tint: 3, corner: 2 };

/**
 * Pieces as rectangles: middle, half across, half ahead, colour (0 to 255), and `own` numbers of each piece by their
 * names, as a shader takes them.
 */
export function quads(pieces, own = []) {
  const names = Object.fromEntries([...Object.keys(SIZES), ...own].map((name) => [name, []]));
  const indices = [];
  pieces.forEach((piece, i) => {
    const first = 4 * i;
    indices.push(first, first + 1, first + 2, first, first + 2, first + 3);
    const tint = piece.colour.map((part) => part / 255);
    for (const corner of CORNERS) {
      names.position.push(...piece.middle);
      names.beside.push(...piece.beside);
      names.along.push(...piece.along);
      names.tint.push(...tint);
      names.corner.push(...corner);
      for (const name of own) names[name].push(piece[name]);
    }
  });
  const geometry = new THREE.BufferGeometry();
  for (const [name, values] of Object.entries(names)) {
    geometry.setAttribute(name, new THREE.Float32BufferAttribute(values, SIZES[name] ?? 1));
  }
  geometry.setIndex(indices);
  return geometry;
}
