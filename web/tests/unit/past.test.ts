import { setFlagsFromString } from "node:v8";
import { runInNewContext } from "node:vm";
import { describe, expect, it } from "vitest";
import { History } from "../../src/panels/history";
import { kMostBytes, kPast, Past } from "../../src/panels/past";
import { stripTable } from "../../src/panels/strip_table";
import { kStrips } from "../../src/panels/strip_specs";
import type { Patch, Path } from "../../src/wire";
import { flatPatch, frameWith } from "../support/frames";

const kMegabyte = 1 << 20;
setFlagsFromString("--expose-gc");
const collect = runInNewContext("gc") as () => void;
const path: Path = { kind: "path", patch: 0, count: 128, length: 0.1, speed: 7, period: 0.02, loop: 0, phase: 0, points: new Float32Array(6 * 128) };

/// Some seconds of frames at 5 Hz, each with a new field.
function filled(seconds: number, patches: () => Patch[]): Past {
  const past = new Past();
  const empty = frameWith({});
  for (let i = 0; i < 5 * seconds; ++i) {
    // new arrays, as decoding makes them
    const plan = [path, path, path, path].map((p) => ({ ...p, points: p.points.slice() }));
    past.add({ ...empty, numbers: empty.numbers.slice(), field: patches(), plan }, i / 5);
  }
  return past;
}

describe("the past", () => {
  it("keeps five minutes, five frames a second, without smoke", () => {
    const smoke = { n: 2, corner: [0, 0, 0] as [number, number, number], edge: 1, density: new Uint8Array(8) };
    const past = new Past();
    for (let i = 0; i < 30 * 400; ++i) past.add(frameWith({ time: i / 30 }, {}, i % 30 === 0 ? { smoke } : {}), i / 30);
    expect(past.oldest).toBeGreaterThanOrEqual(400 - kPast - 0.3);
    expect(past.oldest).toBeLessThanOrEqual(400 - kPast + 0.3);
    expect(past.length).toBeGreaterThan(4 * kPast);
    expect(past.at(250)!.run.time).toBeCloseTo(250, 0);
    expect(Math.abs(past.at(250)!.run.time - 250)).toBeLessThanOrEqual(0.11);
    expect(past.at(0)!.run.time).toBeCloseTo(past.oldest!, 6);
    expect(past.at(1000)!.run.time).toBeGreaterThan(399.7);
    expect(past.at(250)!.smoke).toBeNull();
    expect(new Past().at(3)).toBeNull();
  });
  it("takes at most 64 MB of memory, with two hands in large fields, and still covers five minutes", () => {
    collect();
    const before = process.memoryUsage();
    const past = filled(330, () => [flatPatch(96, 96, [0, 0, 0.2]), flatPatch(96, 96, [0.1, 0, 0.2])]);
    collect();
    collect();
    const after = process.memoryUsage();
    const megabytes = (after.arrayBuffers + after.heapUsed - before.arrayBuffers - before.heapUsed) / kMegabyte;
    console.log(`the past: ${past.length} frames, ${(past.bytes / kMegabyte).toFixed(1)} MB counted, ${megabytes.toFixed(1)} MB measured`);
    expect(past.bytes).toBeLessThanOrEqual(kMostBytes);
    expect(past.bytes).toBeGreaterThan(0.3 * kMostBytes);
    expect(330 - past.oldest!).toBeGreaterThan(kPast - 5);
    expect(megabytes).toBeLessThanOrEqual(64);
    expect(megabytes).toBeGreaterThan(0.8 * past.bytes / kMegabyte);
  }, 60_000);
  it("counts a field that several frames share once", () => {
    const past = new Past(), frame = frameWith({}, {}, { field: [flatPatch(100, 100, [0, 0, 0.2])] });
    for (let i = 0; i < 10; ++i) past.add(frame, i);
    expect(past.bytes).toBeLessThan(2 * 70_000);
    expect(past.bytes).toBeGreaterThan(70_000);
  });
});

describe("the table of the strips", () => {
  it("has names and units, the run time first, and a row a sample", () => {
    const spec = { ...kStrips[0]!, title: "Stages", unit: "ms", series: kStrips[0]!.series.slice(0, 2) };
    const history = new History(2), odd = new History(1);
    history.add(1, [2.5, NaN]);
    history.add(2, [1 / 3, 4]);
    history.add(3, [5, 6]);
    for (const v of [1, 2, 3]) odd.add(v, [v]);
    const strange = { ...spec, title: "A, \"b\"", unit: "", series: spec.series.slice(0, 1) };
    expect(stripTable([0.02, 0.04, 0.04], [{ spec, history }, { spec: strange, history: odd }])).toBe(
      'run time [s],Stages: fluid [ms],Stages: plan [ms],"A, ""b"": fluid"\r\n0.02,2.5,,1\r\n0.04,0.3333333,4,2\r\n');
  });
});
