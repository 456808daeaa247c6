import { describe, expect, it } from "vitest";
import { Fallback } from "../../src/scene/fallback";
import { Pace } from "../../src/scene/pace";
import { densityAlongY, sideLayout } from "../../src/scene/side_layout";

/// Times at which the view flips [s], for conditions at each time [s].
function flips(seconds: number, off: (t: number, flat: boolean) => boolean, held: (t: number, flat: boolean) => boolean): number[] {
  const fallback = new Fallback(), times: number[] = [];
  for (let t = 0; t < seconds; t += 0.1) {
    const before = fallback.flat;
    fallback.update(1000 * t, off(t, before), held(t, before));
    if (fallback.flat !== before) times.push(Math.round(t));
  }
  return times;
}

describe("the side view", () => {
  it("replaces a picture that costs too much, and gives way when the run is calm", () => {
    expect(flips(100, (t) => t < 10, () => true)).toEqual([0, 20]);
    expect(flips(100, (t) => t >= 5 && t < 10, (t) => t > 30)).toEqual([5, 50]);
    expect(flips(100, () => false, () => false)).toEqual([]);
  });
  it("stays while the run misses its rates now and then", () => {
    expect(flips(300, (t) => t < 1, (t) => Math.floor(t) % 15 !== 0)).toEqual([0]);
  });
  it("does not flip if the load returns with the picture: it tries less and less often", () => {
    // off three seconds after each return
    let since = 0;
    const times = flips(2000, (t, flat) => {
      if (flat) since = t;
      return !flat && t - since > 3;
    }, (_, flat) => flat);
    const waits = times.filter((_, i) => i % 2 === 1).map((t, i) => t - times[2 * i]!);
    expect(waits.length).toBeGreaterThanOrEqual(7);
    waits.forEach((wait, i) => expect(Math.abs(wait - Math.min(320, 20 * 2 ** i))).toBeLessThanOrEqual(1));
  });
  it("is tried again at once when the user asks", () => {
    const fallback = new Fallback();
    fallback.update(0, true, true);
    expect(fallback.flat).toBe(true);
    fallback.reset();
    expect(fallback.flat).toBe(false);
    expect(fallback.update(100, false, false)).toBe(false);
  });
  it("comes and goes with a picture that is too slow for a while", () => {
    const pace = new Pace(true), fallback = new Fallback();
    let next = 0, pictures = 0;
    const seen: boolean[] = [];
    for (let t = 0; t < 120_000; t += 20) {
      const loaded = t < 30_000;
      const { interval, off } = pace.state(t, !loaded);
      if (fallback.update(t, off, !loaded)) pace.begin();
      seen.push(fallback.flat);
      if (fallback.flat || t < next) continue;
      pace.drew(40);
      ++pictures;
      next = t + interval;
    }
    const changes = seen.filter((flat, i) => i > 0 && flat !== seen[i - 1]).length;
    expect(seen[25_000 / 20]).toBe(true);
    expect(seen[seen.length - 1]).toBe(false);
    expect(changes).toBe(2);
    expect(pictures).toBeGreaterThan(50);
  });
});

describe("the side view's layout", () => {
  it("shows the whole box and the array's floor in any window", () => {
    for (const [width, height] of [[800, 300], [300, 800], [390, 390]] as const) {
      const box = { x: -0.18, z: 0, edge: 0.36 }, { pixels, x, y } = sideLayout(box, width, height, 60);
      expect(x(-0.18)).toBeGreaterThanOrEqual(60 - 1e-9);
      expect(x(0.18)).toBeLessThanOrEqual(width - 60 + 1e-9);
      expect(y(0.36)).toBeGreaterThanOrEqual(-1e-9);
      expect(y(-0.02)).toBeLessThanOrEqual(height + 1e-9);
      expect(x(0.1) - x(0)).toBeCloseTo(0.1 * pixels, 9);
      expect(y(0) - y(0.1)).toBeCloseTo(0.1 * pixels, 9);
    }
  });
  it("sums the smoke along the line of sight", () => {
    const density = new Uint8Array(8);
    density[0] = density[2] = 255; // x = 0, z = 0, both y
    density[7] = 51; // x = 1, y = 1, z = 1
    const mean = densityAlongY({ n: 2, corner: [0, 0, 0], edge: 1, density });
    expect([...mean].map((v) => Math.round(1000 * v) / 1000)).toEqual([1, 0, 0, 0.1]);
  });
});
