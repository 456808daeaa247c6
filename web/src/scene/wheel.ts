/// Turns of a mouse's wheel, and pinches of a touchpad, which browsers send as turns with Ctrl.

export type Turn = Pick<WheelEvent, "deltaY" | "deltaMode" | "ctrlKey">;

const kLine = 33; // of a wheel that turns by lines, three a notch [pixels]
const kTurn = { most: 60, rate: 0.002 }; // of one event [pixels]; of the distance's logarithm [1/pixel]
// a notch with Ctrl is some 120 pixels, a step of a pinch some 2 to 10
const kPinch = { most: 30, rate: 0.01 };

/// How far it goes down [pixels]. @param page height that a wheel which turns by pages goes [pixels].
export function pixelsOf({ deltaY, deltaMode }: Turn, page: number): number {
  return deltaY * (deltaMode === 1 ? kLine : deltaMode === 2 ? page : 1);
}

/// Factor of the eye's distance.
export function zoomOf(turn: Turn, page: number): number {
  const { most, rate } = turn.ctrlKey ? kPinch : kTurn;
  return Math.exp(rate * Math.max(-most, Math.min(most, pixelsOf(turn, page))));
}
