/// A text at a position of the scene.

import type { Vector3 } from "three";

export interface Label {
  text: string;
  at: Vector3; // position in D [m]
  side: "left" | "right" | "middle"; // side of the position on which the text stands
  strong?: boolean;
}

export type Box = Pick<DOMRect, "left" | "right" | "top" | "bottom">;

/// Whether a text is legible: entirely inside the picture, and not covered.
export function readable(text: Box, picture: Box, over: Box[]): boolean {
  const inside = text.left >= picture.left && text.right <= picture.right &&
    text.top >= picture.top && text.bottom <= picture.bottom;
  const apart = (a: Box, b: Box) => a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
  return inside && over.every((box) => apart(text, box));
}
