import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { onPoint, type Place } from "../../src/pointing";

type Change = Partial<Pick<PointerEvent, "pointerType" | "pointerId" | "isPrimary" | "buttons" | "clientX" | "clientY">>;

let page: EventTarget, part: EventTarget, seen: (Place | null)[];
beforeEach(() => {
  page = new EventTarget();
  part = new EventTarget();
  seen = [];
  vi.stubGlobal("document", page);
  onPoint(part, (place) => seen.push(place));
});
afterEach(() => vi.unstubAllGlobals());

const event = (name: string, change: Change) =>
  Object.assign(new Event(name), { pointerType: "touch", pointerId: 1, isPrimary: true, buttons: 1, clientX: 50, clientY: 60 }, change);
/// In the order of a browser: first the page, then the element.
function send(name: string, change: Change = {}): void {
  page.dispatchEvent(event(name, change));
  part.dispatchEvent(event(name, change));
}
const mouse = { pointerType: "mouse", buttons: 0 };
const last = () => seen[seen.length - 1];
const end = () => ["pointerup", "pointerleave"].forEach((name) => send(name));

describe("a mouse", () => {
  it("points unless a button is pressed", () => {
    send("pointermove", { ...mouse, clientX: 7, clientY: 8 });
    expect(last()).toEqual({ x: 7, y: 8, tapped: false });
    send("pointermove", { ...mouse, buttons: 1 });
    expect(last()).toBeNull();
    send("pointermove", mouse);
    send("pointerleave", mouse);
    expect(last()).toBeNull();
  });
  it("does not point by a click", () => {
    for (const name of ["pointerdown", "pointerup"]) send(name, mouse);
    expect(seen).toEqual([]);
  });
});

describe("a finger", () => {
  it("points where it tapped, until the next touch anywhere", () => {
    send("pointerdown");
    send("pointermove", { clientX: 54 });
    end();
    expect(seen).toEqual([{ x: 50, y: 60, tapped: true }]);
    page.dispatchEvent(event("pointerdown", {}));
    expect(last()).toBeNull();
  });
  it("does not point while it drags", () => {
    send("pointerdown");
    send("pointermove", { clientX: 80 });
    send("pointermove", { clientX: 50 });
    end();
    expect(seen).toEqual([]);
  });
  it("does not point while it scrolls, nor with another finger", () => {
    send("pointerdown");
    send("pointercancel");
    send("pointerdown");
    send("pointerdown", { pointerId: 2, isPrimary: false });
    send("pointerup", { pointerId: 2, isPrimary: false });
    end();
    expect(seen).toEqual([]);
  });
  it("yields to a mouse", () => {
    send("pointerdown");
    end();
    send("pointermove", mouse);
    page.dispatchEvent(event("pointerdown", mouse));
    expect(last()).toEqual({ x: 50, y: 60, tapped: false });
  });
});
