/// Layout of the hands' planes on a canvas, and the cell at a position of it.

import type { Patch } from "../wire";

export interface Placed {
  patch: Patch;
  top: number; // upper edge of this hand's band [pixels]
  height: number;
  pixels: number; // pixels per metre
  x(p: number): number; // horizontal pixel of a position in P [m]
  y(p: number): number;
}

/// All hands at one scale, one below the other.
export function layOut(field: Patch[], width: number, height: number): Placed[] {
  const band = height / Math.max(1, field.length);
  const wanted = (p: Patch) => Math.ceil((Math.max(p.rows, (p.cols * band) / width) * p.cell + 0.008) / 0.02) * 0.02;
  const extent = Math.max(0.2, ...field.map(wanted)); // height of a band [m]
  const pixels = band / extent;
  return field.map((patch, k) => {
    const middleX = patch.centre[0] + ((patch.cols - 1) / 2) * patch.cell;
    const middleY = patch.centre[1] + ((patch.rows - 1) / 2) * patch.cell;
    return {
      patch, top: k * band, height: band, pixels,
      x: (p) => width / 2 + (p - middleX) * pixels,
      y: (p) => (k + 0.5) * band - (p - middleY) * pixels,
    };
  });
}

/// Cell of a patch at a position in its plane; −1 outside, and where there is no skin.
export function cellAt(patch: Patch, x: number, y: number): number {
  const col = Math.round((x - patch.centre[0]) / patch.cell), row = Math.round((y - patch.centre[1]) / patch.cell);
  if (col < 0 || row < 0 || col >= patch.cols || row >= patch.rows) return -1;
  const cell = row * patch.cols + col;
  return patch.skin[cell] ? cell : -1;
}

export interface Under {
  patch: Patch;
  cell: number;
  x: number; // position in P [m]
  y: number;
}

export function under(placed: Placed[], px: number, py: number): Under | null {
  for (const { patch, top, height, pixels, x, y } of placed) {
    if (py < top || py >= top + height) continue;
    const at = { x: (px - x(0)) / pixels, y: (y(0) - py) / pixels };
    const cell = cellAt(patch, at.x, at.y);
    return cell < 0 ? null : { patch, cell, ...at };
  }
  return null;
}

/// Position in D of the skin at a position of the plane [m].
export function overArray({ patch, cell, x, y }: Under): [number, number, number] {
  const height = patch.height[cell]! * patch.heightScale;
  const row = (i: number) => patch.pose[4 * i]! * x + patch.pose[4 * i + 1]! * y + patch.pose[4 * i + 2]! * height + patch.pose[4 * i + 3]!;
  return [row(0), row(1), row(2)];
}

/// Target and reconstruction at a cell [Pa].
export function pressures(patch: Patch, cell: number): { target: number; rendered: number } {
  const unit = patch.scale / 65535;
  return { target: patch.target[cell]! * unit, rendered: patch.rendered[cell]! * unit };
}
