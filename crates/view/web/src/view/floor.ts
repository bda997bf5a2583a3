// A floor: a sheet that fades out, with lines at round distances.

import { CanvasTexture, Mesh, MeshStandardMaterial, PlaneGeometry, SRGBColorSpace } from "three";
import { roundLength } from "./furniture";

/** Of the picture on it [px]. */
const PIXELS = 1024;
const COLOUR = 0xb9bfca;

/** A level square with a side, in its own x and y; lines are as far apart as a round part of `size`. */
export function floor(side: number, size: number): Mesh<PlaneGeometry, MeshStandardMaterial> {
  const map = new CanvasTexture(grid(side, roundLength(0.5 * size)));
  map.colorSpace = SRGBColorSpace;
  map.anisotropy = 8;
  const material = new MeshStandardMaterial({ map, roughness: 0.9, transparent: true, opacity: 0.6 });
  // the texture goes with its material
  material.addEventListener("dispose", () => map.dispose());
  const mesh = new Mesh(new PlaneGeometry(side, side), material);
  mesh.receiveShadow = true;
  return mesh;
}

function grid(side: number, distance: number): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = PIXELS;
  const context = canvas.getContext("2d");
  if (!context) return canvas;
  context.fillStyle = `#${COLOUR.toString(16)}`;
  context.fillRect(0, 0, PIXELS, PIXELS);
  context.strokeStyle = "rgb(70 80 96 / 38%)";
  context.lineWidth = 1.2;
  const lines = Math.floor(side / 2 / distance);
  for (let line = -lines; line <= lines; line++) {
    const at = PIXELS * (0.5 + (line * distance) / side);
    context.strokeRect(at, -2, 0, PIXELS + 4);
    context.strokeRect(-2, at, PIXELS + 4, 0);
  }
  const fading = context.createRadialGradient(PIXELS / 2, PIXELS / 2, PIXELS / 8, PIXELS / 2, PIXELS / 2, PIXELS / 2);
  fading.addColorStop(0, "#000f");
  fading.addColorStop(1, "#0000");
  context.globalCompositeOperation = "destination-in";
  context.fillStyle = fading;
  context.fillRect(0, 0, PIXELS, PIXELS);
  return canvas;
}
