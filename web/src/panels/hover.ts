/// A note at the pointer that describes what is there.

import { find } from "../dom";
import { millimetres, short } from "../text";
import type { Patch } from "../wire";
import { pressures } from "./plane_layout";

const note = find("hover");

/// @param lines an empty list hides the note.
export function say(lines: string[], clientX: number, clientY: number): void {
  note.hidden = lines.length === 0;
  if (note.hidden) return;
  note.textContent = lines.join("\n");
  const { width, height } = note.getBoundingClientRect();
  // next to the pointer, within the window
  const x = clientX + 16 + width > window.innerWidth ? clientX - 12 - width : clientX + 16;
  const y = Math.max(4, Math.min(clientY + 14, window.innerHeight - height - 4));
  note.style.setProperty("left", `${Math.max(4, x)}px`);
  note.style.setProperty("top", `${y}px`);
}

/// Describes a cell.
export function cellWords(patch: Patch, cell: number): string[] {
  const { target, rendered } = pressures(patch, cell);
  const difference = rendered - target;
  return [
    `target ${short(target)} Pa`, `reconstruction ${short(rendered)} Pa`,
    `difference ${difference < 0 ? "−" : "+"}${short(Math.abs(difference))} Pa`,
  ];
}

/// Describes a position over the array [m].
export function placeWords(x: number, y: number, z: number): string {
  return `x ${millimetres(x)}, y ${millimetres(y)} mm, ${millimetres(z)} mm over the array`;
}
