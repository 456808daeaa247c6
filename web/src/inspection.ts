/// The state of the page that may be read from outside, as window.prostm: by tests, and in the browser's console.

import type { State } from "./messages";
import type { Frame } from "./wire";

export interface Inspection {
  readonly frame: Frame | null;
  readonly state: State | null;
  readonly frames: number; // read
  readonly refused: number; // frames that were not read
  readonly connections: number; // made
  readonly pictures: number; // drawn
  readonly speed: { framesPerSecond: number; pixelRatio: number };
  readonly dark: boolean;
}

declare global {
  interface Window {
    prostm: Inspection;
  }
}
