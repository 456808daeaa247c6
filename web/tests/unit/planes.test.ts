import { Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { cellAt, layOut, overArray, pressures, under } from "../../src/panels/plane_layout";
import { PressureScale, roundedUp } from "../../src/panels/scale";
import { pick } from "../../src/scene/pick";
import { flatPatch, frameWith } from "../support/frames";

const patch = flatPatch(4, 6, [0.1, -0.2, 0.3]);

describe("a plane on a canvas", () => {
  it("finds the cell at a position", () => {
    for (const patches of [[patch], [patch, patch]]) {
      const placed = layOut(patches, 300, 400);
      placed.forEach((place, k) => {
        const there = under(placed, place.x(0.03), place.y(0.01));
        expect(there?.cell).toBe(6 + 3);
        expect([there?.x, there?.y]).toEqual([expect.closeTo(0.03), expect.closeTo(0.01)]);
        expect(place.y(0.01)).toBeGreaterThan((k * 400) / patches.length);
        expect(place.y(0.01)).toBeLessThan(((k + 1) * 400) / patches.length);
      });
      expect(under(placed, -1, 10)).toBeNull();
    }
  });
  it("finds the skin over the array, at its height over the plane", () => {
    const height = new Int16Array(24).fill(2000); // 20 mm
    const there = { patch: { ...patch, height }, cell: 9, x: 0.03, y: 0.01 };
    expect(overArray(there)).toEqual([0.13, -0.19, 0.32].map((v) => expect.closeTo(v)));
    // an upright plane: its y axis points up, and its normal along −y
    const pose = Float32Array.from([1, 0, 0, 0.1, 0, 0, -1, -0.2, 0, 1, 0, 0.3]);
    expect(overArray({ ...there, patch: { ...patch, height, pose } })).toEqual([0.13, -0.22, 0.31].map((v) => expect.closeTo(v)));
  });
  it("is empty off the skin", () => {
    expect(cellAt(flatPatch(4, 6, [0, 0, 0], 0), 0.03, 0.01)).toBe(-1);
    expect(cellAt(patch, 0.056, 0.01)).toBe(-1);
  });
  it("gives the pressures of its cells", () => expect(pressures(patch, 9)).toEqual({ target: expect.closeTo(0.09), rendered: expect.closeTo(0.045) }));
});

describe("the scale of pressures", () => {
  it("ends at a round number", () => {
    expect([0.11, 0.15, 0.5, 0.61, 7.9, 9].map(roundedUp)).toEqual([0.15, 0.15, 0.5, 0.8, 8, 10].map((x) => expect.closeTo(x)));
    expect(roundedUp(0)).toBe(1);
  });
  it("grows at once, shrinks after a while, and stays when locked", () => {
    const scale = new PressureScale();
    const weak = { ...patch, scale: 0.095, target: Uint16Array.from(patch.target, () => 65535) }, strong = { ...weak, scale: 1.4 };
    scale.measure(frameWith({}, {}, { field: [strong] }), 0);
    expect(scale.end).toBeCloseTo(1.5);
    scale.measure(frameWith({}, {}, { field: [weak] }), 3000);
    expect(scale.end).toBeCloseTo(1.5);
    scale.measure(frameWith({}, {}, { field: [weak] }), 5000);
    expect(scale.end).toBeCloseTo(0.1);
    scale.locked = 0.6;
    scale.measure(frameWith({}, {}, { field: [strong] }), 6000);
    expect(scale.end).toBe(0.6);
  });
});

describe("a ray", () => {
  const down = new Vector3(0, 0, -1), above = new Vector3(0.1 + 0.03, -0.2 + 0.01, 0.9);
  it("hits the cell below it", () => {
    const hit = pick([patch], above, down);
    expect(hit?.cell).toBe(9);
    expect(hit?.point.distanceTo(new Vector3(0.13, -0.19, 0.3))).toBeLessThan(1e-6);
  });
  it("hits skin at its height over the plane, and the nearer of two", () => {
    const high = { ...patch, height: new Int16Array(24).fill(2000) }; // 20 mm
    expect(pick([patch, high], above, down)?.point.z).toBeCloseTo(0.32);
    // an oblique ray hits the skin before the plane
    const slant = new Vector3(1, 0, -1).normalize(), from = new Vector3(0.1 - 0.27, -0.19, 0.62);
    expect(pick([high], from, slant)?.cell).toBe(9);
  });
  it("misses off the skin, behind the camera, and parallel to the plane", () => {
    expect(pick([patch], new Vector3(0, 0, 0.9), down)).toBeNull();
    expect(pick([patch], new Vector3(0.13, -0.19, 0.1), down)).toBeNull();
    expect(pick([patch], above, new Vector3(1, 0, 0))).toBeNull();
  });
});
