import { describe, expect, it } from "vitest";
import { beyond, History, PerSecond, robustTop } from "../../src/panels/history";

describe("the top of an axis", () => {
  it("exceeds the largest value if there is no outlier", () => {
    expect(robustTop([10, 11, 12, 13], 5)).toBeCloseTo(14.04);
    expect(robustTop([1, 2], 10)).toBe(10);
    expect(robustTop([], 3)).toBe(3);
    expect(robustTop([NaN, 20], 3)).toBeCloseTo(21.6);
  });
  it("ignores single outliers among a thousand values", () => {
    const values = Array.from({ length: 900 }, (_, i) => 10 + (i % 5));
    values[100] = values[500] = 1000;
    expect(robustTop(values, 5)).toBeCloseTo(1.08 * 14);
  });
});

describe("values outside an axis", () => {
  it("are found above and below", () => {
    const cut = beyond([-3, -2, -1, 0], [[0.9, -0.2, NaN, 0], [1.3, 0.4, 1, -4]], 0, 1);
    expect(cut).toEqual({ above: [-3], below: [-2, 0] });
    expect(beyond([-1, 0], [[-8, -31]], -30, 10)).toEqual({ above: [], below: [0] });
  });
});

describe("counts per second", () => {
  it("are the rate of a counter", () => {
    const rate = new PerSecond();
    let last = 0;
    for (let i = 0; i <= 90; ++i) last = rate.add(i / 30, 5 * Math.floor(i / 30));
    expect(last).toBeCloseTo(5, 0);
    for (let i = 91; i <= 150; ++i) last = rate.add(i / 30, 15);
    expect(last).toBe(0);
  });
  it("restart with the counter", () => {
    const rate = new PerSecond();
    rate.add(0, 1000);
    rate.add(1, 1010);
    expect(rate.add(2, 0)).toBe(0);
    expect(rate.add(3, 2)).toBe(2);
    expect(rate.add(4, NaN)).toBeNaN();
  });
});

describe("a history", () => {
  const history = new History(1);
  for (let i = 0; i <= 12000; ++i) history.add(i / 20, [i]);
  it("keeps seven minutes", () => {
    expect(history.times[0]).toBeGreaterThan(600 - 421 - 64 / 20 - 0.1);
    expect(history.times[0]).toBeLessThanOrEqual(600 - 421);
    expect(history.values[0]!.length).toBe(history.times.length);
  });
  it("finds the sample nearest to a time", () => {
    for (const [time, value] of [[550, 11000], [550.02, 11000], [550.03, 11001], [900, 12000]] as const) {
      expect(history.values[0]![history.nearest(time)]).toBe(value);
    }
    expect(new History(1).nearest(3)).toBe(-1);
  });
  it("can be copied, and continues independently of the copy", () => {
    const copy = history.copy();
    history.add(201, [7]);
    expect(copy.times[copy.times.length - 1]).toBe(600);
  });
});
