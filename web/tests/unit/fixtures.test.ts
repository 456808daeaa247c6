import { readdirSync, readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { Decoder, kNumbers, type Frame } from "../../src/wire";

const folder = new URL("../../fixtures/", import.meta.url);
const names = readdirSync(folder).filter((n) => n.endsWith(".bin")).map((n) => n.slice(0, -4));

/// A frame in the form of the files that the encoder's own tests write.
function inWords(frame: Frame): unknown {
  const known = (x: number) => (Number.isNaN(x) ? null : x);
  const { run } = frame;
  const flags = (run.paused ? 1 : 0) | (run.pageHand ? 2 : 0) | (run.handInSight ? 4 : 0) | (run.fading ? 8 : 0) |
    (run.muted ? 16 : 0) | (run.calibrating ? 32 : 0) | (run.hot ? 64 : 0) | (run.deviceLost ? 128 : 0);
  const rows = (values: Float32Array, width: number) => Array.from({ length: values.length / width }, (_, i) => [...values.subarray(width * i, width * (i + 1))]);
  return {
    version: 2,
    sequence: frame.sequence,
    run: { time: frame.run.time, recording_time: known(frame.run.recordingTime), world_steps: frame.run.worldSteps, plan_updates: frame.run.planUpdates, flags },
    numbers: Object.fromEntries(kNumbers.map((name, i) => [name, known(frame.numbers[i] ?? NaN)])),
    hands: frame.hands.map((h) => ({ id: h.id, side: h.side === "left" ? 0 : 1, confidence: h.confidence, joints: rows(h.joints, 8) })),
    smoke: frame.smoke && { n: frame.smoke.n, corner: frame.smoke.corner, edge: frame.smoke.edge, density: [...frame.smoke.density] },
    fields: frame.fieldSequence < 0 ? null : frame.field.map((p) => ({
      rows: p.rows, cols: p.cols, cell: p.cell, origin: p.centre, X_DP: [...p.pose], scale: p.scale, height_scale: p.heightScale,
      target: [...p.target], rendered: [...p.rendered], height: [...p.height], skin: [...p.skin],
    })),
    plan: frame.plan.map((p) => ({ kind: p.kind === "path" ? 0 : 1, patch: p.patch, length: p.length, speed: p.speed, period: p.period, loop: p.loop, phase: p.phase, points: rows(p.points, 6) })),
    gate: frame.gate,
  };
}

/// Files have −0 as 0, like JSON.
const plain = (x: unknown): unknown => JSON.parse(JSON.stringify(x));

describe("a frame of the program", () => {
  it("has fixtures", () => expect(names.length).toBeGreaterThanOrEqual(4));
  it.each(names)("is read here as it was written there: %s", (name) => {
    const bytes = readFileSync(new URL(`${name}.bin`, folder));
    const message = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) as ArrayBuffer;
    const expected: unknown = JSON.parse(readFileSync(new URL(`${name}.json`, folder), "utf8"));
    expect(plain(inWords(new Decoder().decode(message)))).toEqual(plain(expected));
  });
});
