// Words in the picture that face the reader.

import * as THREE from "./three.module.min.js";

/** A word, as high on the picture wherever it stands: `height` is a share of the picture's, about. */
export function sprite(text, height, colour = "#0b4f8a") {
  const canvas = document.createElement("canvas");
  const pen = canvas.getContext("2d");
  const font = "600 44px system-ui, sans-serif";
  pen.font = font;
  canvas.width = Math.ceil(pen.measureText(text).width) + 24;
  canvas.height = 60;
  pen.font = font;
  pen.textBaseline = "middle";
  pen.lineWidth = 8;
  pen.strokeStyle = "rgba(255, 255, 255, 0.9)";
  pen.strokeText(text, 12, 31);
  pen.fillStyle = colour;
  pen.fillText(text, 12, 31);
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  const found = new THREE.Sprite(new THREE.SpriteMaterial({ map, depthTest: false, depthWrite: false, transparent: true, sizeAttenuation: false }));
  found.scale.set((height * canvas.width) / canvas.height, height, 1);
  found.renderOrder = 9;
  return found;
}
