import { describe, expect, it } from "vitest";
import { parseMessage } from "../../src/messages";

const control = { id: "paths", group: "plan", label: "Paths", kind: "number", value: 4, min: 1, max: 8, step: 1, help: "", enabled: true };
const transport = { playing: true, recording: null, source: "scripted", base: "scripted" };

describe("parseMessage", () => {
  it("takes a state, and a missing tracker or calibration as none", () => {
    expect(parseMessage(JSON.stringify({ type: "state", controls: [control], transport }))).toMatchObject({ tracker: null, calibration: null, controls: [control] });
  });
  it("takes a hello and an error", () => {
    const hello = { type: "hello", version: 1, prostm: "0.1.0", device: "simulated usx", numbers: ["rmse"], array: { name: "usx", transducers_mm: [[0, 0, 0]] }, box_mm: { origin: [0, 0, 0], edge: 250 } };
    expect(parseMessage(JSON.stringify(hello))).toEqual(hello);
    expect(parseMessage('{"type":"error","sentence":"no"}')).toEqual({ type: "error", sentence: "no" });
  });
  it.each([
    "", "{", "null", "[]", "3", '{"type":"hello"}', '{"type":"error"}', '{"type":"other"}',
    JSON.stringify({ type: "state", controls: [{ ...control, kind: "dial" }], transport }),
    JSON.stringify({ type: "state", controls: [{ ...control, max: "8" }], transport }),
    JSON.stringify({ type: "state", controls: [{ ...control, kind: "choice", value: "a" }], transport }),
    JSON.stringify({ type: "state", controls: [], transport: { ...transport, playing: 1 } }),
    JSON.stringify({ type: "state", controls: [], transport, calibration: { marks: [{ name: "a", p_mm: [1, 2] }] } }),
    JSON.stringify({ type: "hello", version: 1, prostm: "", device: "", numbers: [], array: { name: "usx", transducers_mm: [[0, 0]] }, box_mm: { origin: [0, 0, 0], edge: 1 } }),
  ])("takes nothing else: %s", (text) => expect(parseMessage(text)).toBeNull());
});
