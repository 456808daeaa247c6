/// Frames and controls for tests, built from the relevant values.
import type { Control, NumberControl, State } from "../../src/messages";
import { Decoder, kNumbers, type Frame, type NumberName, type Patch, type Run } from "../../src/wire";
import { encode, type Contents } from "./encode";

export function frameWith(run: Partial<Run>, numbers: Partial<Record<NumberName, number>> = {}, rest: Contents = {}): Frame {
  return new Decoder().decode(encode({ run, numbers: kNumbers.map((name) => numbers[name] ?? NaN), ...rest }));
}

/// Rows × cols cells of 10 mm in a plane that lies flat at a height [m], the first cell's centre at (x, y).
export function flatPatch(rows: number, cols: number, at: [number, number, number], skin = 1): Patch {
  const cells = rows * cols;
  return {
    rows, cols, cell: 0.01, centre: [0, 0], pose: Float32Array.from([1, 0, 0, at[0], 0, 1, 0, at[1], 0, 0, 1, at[2]]),
    scale: 0.65535, heightScale: 1e-5, target: Uint16Array.from({ length: cells }, (_, i) => 1000 * i),
    rendered: Uint16Array.from({ length: cells }, (_, i) => 500 * i), height: new Int16Array(cells),
    skin: new Uint8Array(cells).fill(skin),
  };
}

const base = { group: "Plan", help: "", enabled: true };
export const speed: NumberControl = { ...base, id: "speed", label: "Speed", unit: "m/s", kind: "number", value: 7, default: 7, min: 2, max: 8, step: 0.5 };
export const paths: NumberControl = { ...base, id: "paths", label: "Paths", kind: "number", value: 4, default: 4, min: 1, max: 8, step: 1 };
export const scene: Control = {
  ...base, id: "scene", label: "Scene", kind: "choice", value: "one-plume", default: "one-plume",
  choices: [{ value: "one-plume", label: "One wide plume" }, { value: "still-air", label: "Still air" }],
};
export const prediction: Control = { ...base, id: "prediction", label: "Prediction", kind: "switch", value: true, default: true };

export function stateWith(controls: Control[], change: Partial<State> = {}): State {
  return {
    type: "state", controls, rates: { world_hz: 50, plan_hz: 25, advice: null }, settings: "", tracker: null, calibration: null,
    transport: { playing: true, recording: null, source: "scripted", base: "scripted", hand_page: null, page_hand: "free" }, ...change,
  };
}
