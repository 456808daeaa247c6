/// The place of the page that somebody points at: with a mouse that no button holds, or with a tap.

export interface Place {
  x: number; // of the window [pixels]
  y: number;
  tapped: boolean; // the finger is gone, and the place stays until the next touch or click
}

const kStill = 10; // pixels that a finger may move and still tap

/// Calls `at` with each place of the element that somebody points at, and with null when nobody points there any more.
export function onPoint(element: EventTarget, at: (place: Place | null) => void): void {
  let touch: { id: number; x: number; y: number } | null = null; // the only finger, while it has not moved
  let tapped = false; // a tapped place stands
  const listen = (name: string, to: (event: PointerEvent) => void) => {
    element.addEventListener(name, (event) => to(event as PointerEvent));
  };
  const byFinger = (event: PointerEvent) => event.pointerType === "touch";

  // before the part's own listeners, and whatever is pressed
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
      at(buttons === 0 ? { x, y, tapped } : null); // who drags does not read
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
