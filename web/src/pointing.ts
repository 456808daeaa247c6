/// The position on the page that the user points at: with a mouse without buttons pressed, or with a tap.

export interface Place {
  x: number; // in the window [pixels]
  y: number;
  tapped: boolean; // the finger has lifted; the position stays until the next touch or click
}

const kStill = 10; // pixels that a finger may move in a tap

/// Calls `at` with each position in the element that the user points at, and with null when the pointing ends.
export function onPoint(element: EventTarget, at: (place: Place | null) => void): void {
  let touch: { id: number; x: number; y: number } | null = null; // the only finger, while it is still
  let tapped = false; // a tapped position is in force
  const listen = (name: string, to: (event: PointerEvent) => void) => {
    element.addEventListener(name, (event) => to(event as PointerEvent));
  };
  const byFinger = (event: PointerEvent) => event.pointerType === "touch";

  // before the element's own listeners, wherever the press is
  document.addEventListener("pointerdown", () => {
    if (tapped) at(null);
    tapped = false;
  }, { capture: true });
  listen("pointerdown", (event) => {
    const { pointerId: id, clientX: x, clientY: y } = event;
    touch = byFinger(event) && event.isPrimary ? { id, x, y } : null;
  });
  listen("pointermove", ({ pointerType, buttons, clientX: x, clientY: y }) => {
    if (pointerType === "touch") {
      if (touch !== null && Math.hypot(x - touch.x, y - touch.y) > kStill) touch = null;
    } else {
      tapped = false;
      at(buttons === 0 ? { x, y, tapped } : null); // no reading during a drag
    }
  });
  listen("pointerup", ({ pointerId, clientX: x, clientY: y }) => {
    tapped = touch?.id === pointerId;
    if (tapped) at({ x, y, tapped });
    touch = null;
  });
  listen("pointercancel", () => (touch = null));
  listen("pointerleave", (event) => {
    if (!byFinger(event)) at(null);
  });
}
