/// The verdict on a moment of the run: whether the array plays, why not, and what is felt.

import type { Hello, State } from "../messages";
import { fixed } from "../text";
import { numberOf, type Frame } from "../wire";
import { advice, outputOf } from "./words";

export type Sensation = Hello["sensation"];

/// The facts that a verdict is about.
export interface Moment {
  connected: boolean;
  frame: Frame | null;
  state: State | null;
  sensation: Sensation | null; // interval of the felt strength
  dropouts: number; // missed blocks in the last second
  ratesMissed: boolean; // smoke or plans are slower than set
}

export interface Verdict {
  state: "playing" | "flawed" | "silent" | "muted" | "unknown"; // "flawed": plays, but not as intended
  word: string;
  why: string;
  shape: Felt;
  strength: Felt;
}
/// A number of the percept, and its meaning; both are empty without a percept.
export interface Felt {
  value: string;
  words: string;
}

const kNothing: Felt = { value: "–", words: "" };
const kShapes = [
  { least: 0.8, words: "close to the target" }, { least: 0.5, words: "resembles the target" },
  { least: 0.2, words: "hardly resembles the target" }, { least: -Infinity, words: "no better than an even field" },
] as const;

/// @param shape on the scale of Eq. (1): 1 is perfect, 0 is no better than an even field.
export function shapeWords(shape: number): Felt {
  if (!Number.isFinite(shape)) return kNothing;
  const rounded = Math.round(100 * shape) / 100; // as it is shown
  return { value: fixed(rounded, 2), words: kShapes.find((s) => rounded >= s.least)!.words };
}

const signed = (decibels: number): string => {
  const whole = Math.round(decibels);
  return whole < 0 ? `−${-whole}` : String(whole);
};

/// The words of src/prostm/acoustics/skin/sensation_level.cpp.
function meaning(level: number, { below_db: below, above_db: above }: Sensation): string {
  if (level - below >= 0) return "nearly everyone feels it";
  if (level >= 0) return "most people feel it, some may not";
  if (level + above >= 0) return "most people do not feel it, some may";
  return "hardly anyone feels it";
}

/// @param level above the threshold of touch [dB].
export function strengthWords(level: number, sensation: Sensation | null): Felt {
  if (!Number.isFinite(level) || sensation === null) return kNothing;
  const side = Math.round(level) < 0 ? "below" : "above";
  const interval = `${signed(level - sensation.below_db)} to ${signed(level + sensation.above_db)} dB`;
  const nominal = sensation.sound === "nominal" ? "; nominal, since no sound level of this array was measured" : "";
  return {
    value: `${Math.abs(Math.round(level))} dB ${side} the threshold of touch`,
    words: `${interval}: ${meaning(level, sensation)}${nominal}`,
  };
}

/// Why the array is silent, with what to do about it.
function silence(frame: Frame, state: State | null, why: string): string {
  const { run, gate } = frame;
  if (!run.handInSight && !run.paused) return [why, advice(state)].filter((part) => part !== "").join(". ");
  if (run.handInSight && !run.paused && !run.fading && gate?.passed === false) return `${why}. ${gate.sentence}`;
  return why;
}

/// Names a flaw of the output while the array plays; "" without one.
function flaw({ frame, dropouts, ratesMissed }: Moment): string {
  if (dropouts >= 0.5) {
    const count = Math.round(dropouts);
    return `late: ${count} ${count === 1 ? "block of samples was" : "blocks of samples were"} missed in the last second`;
  }
  if (frame?.gate?.passed === false) return `not the stimulus of the scene. ${frame.gate.sentence}`;
  return ratesMissed ? "late: smoke or plans are slower than set" : "";
}

export function verdictOf(moment: Moment): Verdict {
  const { connected, frame, state, sensation } = moment;
  const nothing = { shape: kNothing, strength: kNothing };
  if (!connected || frame === null) {
    const why = connected ? "waiting for the first frame" : "what you see has stopped";
    return { state: "unknown", word: connected ? "No data" : "Not connected", why, ...nothing };
  }
  const felt = !frame.run.handInSight ? nothing : {
    shape: shapeWords(numberOf(frame, "felt_skill")),
    strength: strengthWords(numberOf(frame, "sensation_level"), sensation),
  };
  const output = outputOf(frame);
  if (output.state !== "on") {
    const muted = output.state === "muted";
    const why = muted ? `muted ${output.why}` : silence(frame, state, output.why);
    return { state: muted ? "muted" : "silent", word: "Not playing", why, ...felt };
  }
  const wrong = flaw(moment);
  const why = wrong === "" && frame.gate?.passed === true ? "the stimulus of the scene" : wrong;
  return { state: wrong === "" ? "playing" : "flawed", word: "Playing", why, ...felt };
}
