import { describe, expect, it } from "vitest";
import { pixelsOf, zoomOf } from "../../src/scene/wheel";

const turn = (deltaY: number, ctrlKey = false, deltaMode = 0) => ({ deltaY, deltaMode, ctrlKey });

describe("a wheel", () => {
  it("scrolls as far by lines and pages as by pixels", () => {
    expect(pixelsOf(turn(100), 600)).toBe(100);
    expect(pixelsOf(turn(3, false, 1), 600)).toBeCloseTo(100, -1);
    expect(pixelsOf(turn(1, false, 2), 600)).toBe(600);
    expect(zoomOf(turn(3, false, 1), 600)).toBeCloseTo(zoomOf(turn(100), 600), 6);
  });
  it("zooms by about a tenth per notch, and back by as much", () => {
    expect(zoomOf(turn(120), 600)).toBeGreaterThan(1.1);
    expect(zoomOf(turn(120), 600)).toBeLessThan(1.2);
    expect(zoomOf(turn(120), 600) * zoomOf(turn(-120), 600)).toBeCloseTo(1, 12);
  });
});

describe("a pinch", () => {
  it("zooms with the distance of the fingers: twice as far apart is twice as near", () => {
    let distance = 1;
    for (let i = 0; i < 14; ++i) distance *= zoomOf(turn(-5, true), 600);
    expect(distance).toBeCloseTo(0.5, 1);
  });
  it("is a sensible step for a wheel with Ctrl", () => {
    expect(zoomOf(turn(-120, true), 600)).toBeGreaterThan(0.6);
    expect(zoomOf(turn(-120, true), 600)).toBeLessThan(0.8);
  });
});
