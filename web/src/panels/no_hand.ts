/// Shows over the picture and the planes that no hand is in sight, and what to do about it.

import { find, setText } from "../dom";
import type { State } from "../messages";
import type { Frame } from "../wire";
import { advice } from "./words";

export function showNoHand(frame: Frame | null, state: State | null): void {
  const missing = frame !== null && !frame.run.handInSight;
  for (const id of ["no-hand", "no-hand-planes"]) find(id).hidden = !missing;
  if (missing) setText(find("no-hand-advice"), advice(state));
}
