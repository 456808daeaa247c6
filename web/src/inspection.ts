/// The page's state that tests and the browser's console can read, as window.prostm.

import type { State } from "./messages";
import type { Frame } from "./wire";

export interface Inspection {
  readonly frame: Frame | null;
  readonly state: State | null;
  readonly frames: number; // decoded
  readonly refused: number; // frames that could not be decoded
  readonly connections: number; // connections made
  readonly pictures: number; // pictures drawn in three dimensions
  readonly sideViews: number; // side views drawn
  readonly speed: { framesPerSecond: number; pixelRatio: number };
  readonly past: { frames: number; bytes: number }; // kept for a look back
  readonly dark: boolean;
}

declare global {
  interface Window {
    prostm: Inspection;
  }
}
