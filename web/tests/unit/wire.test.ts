import { describe, expect, it } from "vitest";
import { Decoder, WireError, kJoints, kNumbers, numberOf, type Gate, type Hand, type Patch, type Path, type Smoke } from "../../src/wire";
import { encode } from "../support/encode";

const hand: Hand = { id: 7, side: "right", confidence: 0.5, joints: Float32Array.from({ length: 8 * kJoints }, (_, i) => i / 8) };
const smoke: Smoke = { n: 3, corner: [-0.25, -0.125, 0.5], edge: 0.375, density: Uint8Array.from({ length: 27 }, (_, i) => i) };
const patch: Patch = {
  rows: 3, cols: 5, cell: 0.005, centre: [0.25, -0.5], pose: Float32Array.from({ length: 12 }, (_, i) => i), scale: 8, heightScale: 0.5,
  target: Uint16Array.from({ length: 15 }, (_, i) => 1000 * i), rendered: Uint16Array.from({ length: 15 }, (_, i) => 65535 - i),
  height: Int16Array.from({ length: 15 }, (_, i) => i - 7), skin: Uint8Array.from({ length: 15 }, (_, i) => i % 2),
};
const path: Path = { kind: "path", patch: 0, count: 4, length: 0.125, speed: 7, period: 0.5, loop: 1.5, phase: 0, points: Float32Array.from({ length: 24 }, (_, i) => i) };
const focus: Path = { kind: "focus", patch: 1, count: 1, length: 0, speed: 0, period: 0.005, loop: 0, phase: 0.25, points: Float32Array.from([1, 2, 3, 4, 5, 6]) };
const gate: Gate = { passed: true, share: 0.75, maxima: 4, balance: 0.875, saddle: 0.5, area: 0.0625, force: 0.125, problem: "none", sentence: "64 cm² are pressed." };
const whole = () =>
  encode({ sequence: 12, run: { time: 3.5, recordingTime: 1.25, worldSteps: 175, planUpdates: 87, paused: true, handInSight: true, muted: true }, unknown: 13,
    numbers: kNumbers.map((_, i) => i), hands: [hand, { ...hand, side: "left" }], smoke, field: [patch, patch], plan: [path, focus], gate });

/// Float32 rounds numbers that are not multiples of a power of two.
const rounded = (p: Patch): Patch => ({ ...p, cell: Math.fround(p.cell) });

describe("a whole frame", () => {
  it("is read as it was written", () => {
    const frame = new Decoder().decode(whole());
    expect(frame.sequence).toBe(12);
    expect(frame.run).toEqual({ time: 3.5, recordingTime: 1.25, worldSteps: 175, planUpdates: 87, paused: true, pageHand: false, handInSight: true, fading: false, muted: true, calibrating: false, hot: false, deviceLost: false });
    expect(numberOf(frame, "plan_ms")).toBe(4);
    expect(numberOf(frame, "saturated")).toBe(29);
    expect(frame.hands).toEqual([hand, { ...hand, side: "left" }]);
    expect(frame.smoke).toEqual(smoke);
    expect(frame.field).toEqual([rounded(patch), rounded(patch)]);
    expect(frame.gate).toEqual(gate);
    expect(frame.plan).toEqual([path, { ...focus, period: Math.fround(0.005) }]);
  });

  it("keeps the smoke and the field of the previous frame until new ones arrive", () => {
    const decoder = new Decoder();
    decoder.decode(whole());
    const next = decoder.decode(encode({ sequence: 13, plan: [] }));
    expect([next.smoke, next.smokeSequence, next.fieldSequence]).toEqual([smoke, 12, 12]);
    expect(next.hands).toEqual([]);
    expect(next.gate).toBeNull();
    expect(decoder.decode(encode({ sequence: 14, field: [] })).field).toEqual([]);
  });

  it("has NaN for numbers that an older program does not send", () => {
    const frame = new Decoder().decode(encode({ numbers: [1, 2] }));
    expect(numberOf(frame, "hand_ms")).toBe(2);
    expect(numberOf(frame, "plan_ms")).toBeNaN();
  });
});

describe("a malformed message", () => {
  const refused = (message: ArrayBuffer) => expect(() => new Decoder().decode(message)).toThrow(WireError);
  const changed = (change: (view: DataView) => void) => {
    const message = whole();
    change(new DataView(message));
    return message;
  };
  /// offset of the section with this id
  const find = (message: ArrayBuffer, id: number): number => {
    const view = new DataView(message);
    let at = 16;
    while (view.getUint16(at, true) !== id) at += 8 + Math.ceil(view.getUint32(at + 4, true) / 8) * 8;
    return at;
  };

  it("is rejected wherever it is cut off", () => {
    const message = whole();
    for (let length = 0; length < message.byteLength; length += length < 64 ? 1 : 7) {
      refused(message.slice(0, length));
      // also if its length field is wrong
      const cut = message.slice(0, length);
      if (length >= 16 && length < message.byteLength - 8) {
        new DataView(cut).setUint32(12, length, true);
        refused(cut);
      }
    }
  });
  it("of another version is rejected with a sentence that says so", () => {
    expect(() => new Decoder().decode(encode({ version: 3 }))).toThrow(/version 3 .* version 2/);
  });
  it("with another magic number is rejected", () => refused(changed((v) => v.setUint8(0, 0x51))));
  it("with more sections than it holds is rejected", () => refused(changed((v) => v.setUint16(6, 60000, true))));
  it("without a run is rejected", () => refused(changed((v) => v.setUint16(16, 77, true))));
  it("with absurd lengths is rejected without allocation", () => {
    for (const [id, offset] of [[4, 8], [5, 8], [5, 12], [6, 16], [7, 36]] as const) {
      for (const value of [0xffffffff, 0x7fffffff, 100000]) {
        refused(changed((v) => v.setUint32(find(v.buffer as ArrayBuffer, id) + offset, value, true)));
      }
    }
    for (const id of [1, 2, 3, 4, 5, 6, 7]) refused(changed((v) => v.setUint32(find(v.buffer as ArrayBuffer, id) + 4, 0xfffffff0, true)));
    for (const id of [2, 3, 5, 6]) refused(changed((v) => v.setUint16(find(v.buffer as ArrayBuffer, id) + 2, 65535, true)));
  });
  it("with joints, boxes or paths that are not finite is rejected", () => {
    for (const [id, offset] of [[3, 24], [4, 12], [5, 16], [6, 32], [7, 20]] as const) {
      refused(changed((v) => v.setFloat32(find(v.buffer as ArrayBuffer, id) + offset, NaN, true)));
    }
  });
  it("does not change the state", () => {
    const decoder = new Decoder();
    decoder.decode(whole());
    const bad = encode({ sequence: 13, smoke: { ...smoke, n: 1, density: Uint8Array.of(9) }, plan: [path] });
    new DataView(bad).setUint32(find(bad, 6) + 16, 5000, true);
    expect(() => decoder.decode(bad)).toThrow(WireError);
    expect(decoder.decode(encode({ sequence: 14 })).smoke).toEqual(smoke);
  });
  it("of random bytes is always rejected or read", () => {
    let seed = 1;
    const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;
    for (let round = 0; round < 3000; ++round) {
      const message = whole();
      const bytes = new Uint8Array(message);
      for (let i = 0; i < 4; ++i) bytes[16 + Math.floor(random() * (bytes.length - 16))] = Math.floor(random() * 256);
      try {
        new Decoder().decode(message);
      } catch (error) {
        expect(error).toBeInstanceOf(WireError);
      }
    }
  });
});
