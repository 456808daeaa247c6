/// The side view's scale, and the smoke summed along the line of sight.

import type { Smoke } from "../wire";

export interface SideBox {
  x: number; // its smallest x in D [m]
  z: number; // its smallest height [m]
  edge: number; // [m]
}
export interface SideLayout {
  pixels: number; // per metre
  x(p: number): number; // horizontal pixel of a position in D [m]
  y(z: number): number; // vertical pixel of a height [m]
}

const kBelow = 0.02; // what is shown below the array [m]

/// Places the array and the box in the middle, as large as they fit.
/// @param room the margins for numbers at the left and the right [pixels].
export function sideLayout(box: SideBox, width: number, height: number, room: number): SideLayout {
  const top = box.z + box.edge;
  const pixels = Math.max(1, Math.min((width - 2 * room) / box.edge, height / (top + kBelow)));
  const middle = box.x + box.edge / 2, foot = (height + (top - kBelow) * pixels) / 2;
  return { pixels, x: (p) => width / 2 + (p - middle) * pixels, y: (z) => foot - z * pixels };
}

/// Mean density along y, from 0 to 1; n × n values, x fastest, then z.
export function densityAlongY({ n, density }: Smoke): Float32Array {
  const mean = new Float32Array(n * n);
  for (let z = 0; z < n; ++z) for (let y = 0; y < n; ++y) for (let x = 0; x < n; ++x) {
    mean[z * n + x]! += density[(z * n + y) * n + x]! / (255 * n);
  }
  return mean;
}
