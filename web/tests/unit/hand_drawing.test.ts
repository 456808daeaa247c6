import { describe, expect, it } from "vitest";
import { readFileSync } from "node:fs";
import { kBox } from "../../src/study/hand_drawing";

/// Jets of scenes in the program's table that are placed by numbers: x, y and radius [mm].
function jets(): number[][] {
  const table = readFileSync(new URL("../../../src/prostm/pipeline/smoke/scene.cpp", import.meta.url), "utf8");
  const number = (text: string) => 1000 * Number(text.replace("_mm", "e-3"));
  return [...table.matchAll(/SmokeJet\{Vec2\(([\d._m-]+), ([\d._m-]+)\), ([\d._m]+)_mm/g)]
    .map(([, x, y, r]) => [number(x!), number(y!), Number(r)]);
}

describe("the drawing of a question", () => {
  it("shows the wide plumes of all scenes whole", () => {
    const found = jets();
    expect(found.map(([, , r]) => r)).toEqual([106.4, 30]);
    for (const [x, y, r] of found as [number, number, number][]) {
      expect(x - r).toBeGreaterThan(kBox.x);
      expect(x + r).toBeLessThan(kBox.x + kBox.width);
      expect(-y - r).toBeGreaterThan(kBox.y);
      expect(-y + r).toBeLessThan(kBox.y + kBox.height);
    }
  });
});
