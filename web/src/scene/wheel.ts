/// Turns of a mouse wheel, and pinches on a touchpad, which browsers report as turns with Ctrl.

export type Turn = Pick<WheelEvent, "deltaY" | "deltaMode" | "ctrlKey">;

const kLine = 33; // pixels per line for a wheel that reports lines, three a notch
const kTurn = { most: 60, rate: 0.002 }; // limit per event [pixels]; change of log distance [1/pixel]
// a notch with Ctrl is about 120 pixels, a step of a pinch about 2 to 10
const kPinch = { most: 30, rate: 0.01 };

/// Downward motion [pixels]. @param page height for a wheel that reports pages [pixels].
export function pixelsOf({ deltaY, deltaMode }: Turn, page: number): number {
  return deltaY * (deltaMode === 1 ? kLine : deltaMode === 2 ? page : 1);
}

/// Factor for the camera's distance.
export function zoomOf(turn: Turn, page: number): number {
  const { most, rate } = turn.ctrlKey ? kPinch : kTurn;
  return Math.exp(rate * Math.max(-most, Math.min(most, pixelsOf(turn, page))));
}
