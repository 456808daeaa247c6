import { describe, expect, it } from "vitest";
import { shapeWords, strengthWords, verdictOf, type Moment } from "../../src/panels/verdict";
import type { Gate, NumberName, Run } from "../../src/wire";
import { frameWith, stateWith } from "../support/frames";

const sensation = { below_db: 9.3, above_db: 8.7, sound: "measured" };
const gate: Gate = {
  passed: true, share: 1, maxima: 4, balance: 1, saddle: 0.5, area: 0.006, force: 5e-4, problem: "none", sentence: "64 cm² are pressed.",
};
const plays = { intensity: 0.4, felt_skill: 0.82, sensation_level: -6.6 };

function verdict(run: Partial<Run>, numbers: Partial<Record<NumberName, number>> = {}, more: Partial<Moment> = {}, held: Gate | null = null) {
  const frame = frameWith({ handInSight: true, ...run }, { ...plays, ...numbers }, held === null ? {} : { gate: held });
  return verdictOf({ connected: true, frame, state: stateWith([]), sensation, dropouts: 0, ratesMissed: false, ...more });
}
const says = (...of: Parameters<typeof verdict>) => {
  const { state, word, why } = verdict(...of);
  return `${state}: ${word}: ${why}`;
};

describe("the verdict", () => {
  it("is that the array plays", () => {
    expect(says({})).toBe("playing: Playing: ");
    expect(says({}, {}, {}, gate)).toBe("playing: Playing: the stimulus of the scene");
  });
  it("says why it does not", () => {
    expect(says({ handInSight: false }, { intensity: 0 })).toMatch(/^silent: Not playing: no hand in sight\. It comes back by itself/);
    expect(says({}, { intensity: 0 })).toBe("silent: Not playing: no pressure on the hand");
    expect(says({ paused: true }, { intensity: 0 })).toBe("silent: Not playing: paused");
    expect(says({ fading: true }, { intensity: 0 })).toBe("silent: Not playing: no new plan");
    expect(says({ muted: true })).toBe("muted: Not playing: muted by you or another page");
    expect(says({ hot: true })).toBe("muted: Not playing: muted because the array is too hot");
    expect(says({ calibrating: true })).toBe("muted: Not playing: muted for the calibration");
    expect(says({ deviceLost: true })).toBe("silent: Not playing: the link to the array is lost; trying again");
    expect(says({}, {}, { connected: false })).toBe("unknown: Not connected: what you see has stopped");
    expect(says({}, {}, { frame: null })).toBe("unknown: No data: waiting for the first frame");
  });
  it("says what is wrong while it plays", () => {
    const failed = { ...gate, passed: false, sentence: "Stretch the fingers." };
    expect(says({}, {}, {}, failed)).toBe("flawed: Playing: not the stimulus of the scene. Stretch the fingers.");
    expect(says({}, { intensity: 0 }, {}, failed)).toBe("silent: Not playing: no pressure on the hand. Stretch the fingers.");
    expect(says({}, {}, { dropouts: 3.2 })).toBe("flawed: Playing: late: 3 blocks of samples were missed in the last second");
    expect(says({}, {}, { dropouts: 1 })).toContain("1 block of samples was missed");
    expect(says({}, {}, { ratesMissed: true })).toBe("flawed: Playing: late: smoke or plans are slower than set");
  });
  it("changes with the tracker's own reason", () => {
    const tracker = { connected: false, sentence: "No tracker at 127.0.0.1.", frames: 0, dropped: 0, repeated: 0, dropped_hands: 0, unsure: 0, frozen: 0 };
    expect(says({ handInSight: false }, { intensity: 0 }, { state: stateWith([], { tracker }) })).toContain("no hand in sight. No tracker at 127.0.0.1.");
  });
});

describe("the felt shape", () => {
  it("follows its number", () => {
    expect(verdict({}).shape).toEqual({ value: "0.82", words: "close to the target" });
    expect(verdict({}, { felt_skill: 0.796 }).shape).toEqual({ value: "0.80", words: "close to the target" });
    expect(verdict({}, { felt_skill: 0.794 }).shape).toEqual({ value: "0.79", words: "resembles the target" });
    expect(shapeWords(0.3).words).toBe("hardly resembles the target");
    expect(shapeWords(0.1).words).toBe("no better than an even field");
    expect(shapeWords(-0.4)).toEqual({ value: "-0.40", words: "no better than an even field" });
    expect(verdict({}, { felt_skill: NaN }).shape).toEqual({ value: "–", words: "" });
    expect(verdict({ handInSight: false }).shape.value).toBe("–");
  });
});

describe("the felt strength", () => {
  it("follows its number and the interval", () => {
    expect(verdict({}).strength).toEqual({ value: "7 dB below the threshold of touch", words: "−16 to 2 dB: most people do not feel it, some may" });
    expect(verdict({}, { sensation_level: 2 }).strength).toEqual({ value: "2 dB above the threshold of touch", words: "−7 to 11 dB: most people feel it, some may not" });
    expect(strengthWords(12, sensation).words).toBe("3 to 21 dB: nearly everyone feels it");
    expect(strengthWords(-12, sensation).words).toBe("−21 to −3 dB: hardly anyone feels it");
    expect(strengthWords(-12, { ...sensation, above_db: 13 }).words).toBe("−21 to 1 dB: most people do not feel it, some may");
    expect(strengthWords(-0.3, sensation).value).toBe("0 dB above the threshold of touch");
    expect(strengthWords(3, { ...sensation, sound: "nominal" }).words).toMatch(/nominal, since no sound level of this array was measured$/);
    expect(strengthWords(NaN, sensation).value).toBe("–");
    expect(strengthWords(3, null).value).toBe("–");
  });
});
