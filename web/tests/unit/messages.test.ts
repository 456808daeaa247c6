import { describe, expect, it } from "vitest";
import { parseMessage } from "../../src/messages";

const control = { id: "paths", group: "plan", label: "Paths", kind: "number", value: 4, default: 4, min: 1, max: 8, step: 1, help: "", enabled: true };
const transport = { playing: true, recording: null, source: "scripted", base: "scripted", hand_page: null, page_hand: "free" };
const state = { type: "state", controls: [control], transport, rates: { world_hz: 50, plan_hz: 25 }, settings: "" };

describe("parseMessage", () => {
  it("accepts a state, and treats a missing tracker or calibration as none", () => {
    expect(parseMessage(JSON.stringify(state))).toMatchObject({ tracker: null, calibration: null, controls: [control] });
  });
  it("accepts advice for missed rates", () => {
    const advice = { sentence: "Use --grid 48.", set: { id: "grid", value: 48, label: "Turn the smoke's grid down to 48 cells" } };
    const withAdvice = (a: unknown) => parseMessage(JSON.stringify({ ...state, rates: { ...state.rates, advice: a } }));
    expect(withAdvice(advice)).toMatchObject({ rates: { advice } });
    expect(withAdvice({ ...advice, set: null })).toMatchObject({ rates: { advice: { set: null } } });
    expect(withAdvice(undefined)).toMatchObject({ rates: { advice: null } });
    expect(withAdvice({ sentence: "Use --grid 48." })).toBeNull();
    expect(withAdvice("Use --grid 48.")).toBeNull();
  });
  it("accepts a hello and an error", () => {
    const hello = { type: "hello", version: 1, page: 3, prostm: "0.1.0", device: "simulated usx", numbers: ["rmse"], array: { name: "usx", transducers_mm: [[0, 0, 0]] }, box_mm: { origin: [0, 0, 0], edge: 250 }, sensation: { below_db: 9, above_db: 8, sound: "measured" } };
    expect(parseMessage(JSON.stringify(hello))).toEqual(hello);
    expect(parseMessage(JSON.stringify({ ...hello, sensation: undefined }))).toBeNull();
    expect(parseMessage('{"type":"error","sentence":"no"}')).toEqual({ type: "error", sentence: "no" });
    expect(parseMessage('{"type":"error","id":"gain","sentence":"no"}')).toEqual({ type: "error", id: "gain", sentence: "no" });
  });
  it.each([
    "", "{", "null", "[]", "3", '{"type":"hello"}', '{"type":"error"}', '{"type":"other"}',
    '{"type":"error","id":3,"sentence":"no"}',
    JSON.stringify({ ...state, controls: [{ ...control, kind: "dial" }] }),
    JSON.stringify({ ...state, controls: [{ ...control, max: "8" }] }),
    JSON.stringify({ ...state, controls: [{ ...control, default: "4" }] }),
    JSON.stringify({ ...state, controls: [{ ...control, kind: "choice", value: "a" }] }),
    JSON.stringify({ ...state, transport: { ...transport, playing: 1 } }),
    JSON.stringify({ ...state, transport: { ...transport, hand_page: "1" } }),
    JSON.stringify({ ...state, transport: { ...transport, page_hand: null } }),
    JSON.stringify({ ...state, rates: { world_hz: 50 } }),
    JSON.stringify({ ...state, rates: { world_hz: 0, plan_hz: 25 } }),
    JSON.stringify({ ...state, settings: null }),
    JSON.stringify({ ...state, calibration: { marks: [{ name: "a", p_mm: [1, 2] }] } }),
    JSON.stringify({ type: "hello", version: 1, page: 1, prostm: "", device: "", numbers: [], array: { name: "usx", transducers_mm: [[0, 0]] }, box_mm: { origin: [0, 0, 0], edge: 1 } }),
  ])("takes nothing else: %s", (text) => expect(parseMessage(text)).toBeNull());
});
