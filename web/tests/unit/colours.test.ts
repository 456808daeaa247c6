import { describe, expect, it } from "vitest";
import { differenceColour, fieldColour, pathColour, table, type Rgb } from "../../src/colours";

const linear = (v: number) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
/// Lightness of CIE L*a*b*, 0 to 100.
const lightness = ([r, g, b]: Rgb) => {
  const y = 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
  return 116 * (y > 0.008856 ? Math.cbrt(y) : 7.787 * y + 16 / 116) - 16;
};

describe("colours", () => {
  it("of pressures increase evenly in lightness, so that they can be read in grey", () => {
    const steps = Array.from({ length: 32 }, (_, i) => lightness(fieldColour((i + 1) / 32)) - lightness(fieldColour(i / 32)));
    expect(Math.min(...steps)).toBeGreaterThan(1);
    expect(Math.max(...steps)).toBeLessThan(4);
  });
  it("of pressures match the figures", () => {
    // values of src/figure/colours.cpp
    const figures: [number, Rgb][] = [[0, [0.182, 0, 0.3083]], [0.3, [0, 0.3522, 0.5578]], [0.7, [0, 0.7749, 0.5425]], [1, [1, 0.9358, 0.4371]]];
    for (const [t, colour] of figures) fieldColour(t).forEach((v, i) => expect(v).toBeCloseTo(colour[i]!, 3));
  });
  it("of differences are equally light for too little and too much", () => {
    for (const dark of [false, true]) {
      for (const t of [0.25, 0.5, 1]) {
        expect(Math.abs(lightness(differenceColour(t, dark)) - lightness(differenceColour(-t, dark)))).toBeLessThan(6);
        expect(differenceColour(t, dark)).not.toEqual(differenceColour(-t, dark));
      }
    }
  });
  it("of paths repeat after eight", () => expect(pathColour(9)).toEqual(pathColour(1)));
  it("are displayable", () => {
    for (const v of table(fieldColour, -1, 2)) expect(v).toBeLessThanOrEqual(255);
    expect([...table(fieldColour, 0, 1).subarray(0, 4)]).toEqual([...table(fieldColour, -1, 1).subarray(0, 4)]);
  });
});
