import { describe, expect, it } from "vitest";
import type { KeyPress } from "../../src/keyboard";
import { answerOf } from "../../src/study/answer_keys";

const press = (key: string, code: string, shiftKey = false): KeyPress => ({ key, code, shiftKey });
const first = { do: "answer", first: true }, second = { do: "answer", first: false };

describe("yes and no", () => {
  it.each([
    ["y", "KeyY", first], ["Y", "KeyY", first], ["y", "KeyZ", first], ["z", "KeyY", null], ["n", "KeyN", second], ["N", "KeyN", second],
    ["н", "KeyY", first], ["т", "KeyN", second], ["υ", "KeyY", first], ["ν", "KeyN", second], ["Υ", "KeyY", first], ["ט", "KeyY", first],
    ["Dead", "KeyN", second], ["Process", "KeyY", first], ["ArrowRight", "ArrowRight", first], ["PageUp", "PageUp", second],
    ["1", "Digit1", null], ["m", "KeyM", null],
  ])("are %s at %s", (key, code, act) => {
    expect(answerOf(press(key, code), "identification")).toEqual(act);
    expect(answerOf(press(key, code), "judgement")).toEqual(act);
  });
});

describe("the first and the second", () => {
  it.each([
    ["1", "Digit1", first], ["2", "Digit2", second], ["&", "Digit1", first], ["é", "Digit2", second], ["+", "Digit1", first], ["ě", "Digit2", second],
    ["!", "Digit1", first], ["@", "Digit2", second], ["١", "Digit1", first], ["1", "Numpad1", first], ["2", "Numpad2", second],
    ["End", "Numpad1", first], ["ArrowDown", "Numpad2", second], ["ArrowLeft", "Numpad4", first], ["3", "Digit3", null], ["y", "KeyY", null],
  ])("are %s at %s", (key, code, act) => expect(answerOf(press(key, code), "forced-choice")).toEqual(act));
});

describe("tuning", () => {
  const tune = (to: string, coarse = false) => ({ do: "tune", to, coarse });
  it("is by arrows and signs, on the keypad, too", () => {
    expect(answerOf(press("ArrowUp", "ArrowUp"), "adjustment")).toEqual(tune("more"));
    expect(answerOf(press("ArrowLeft", "ArrowLeft", true), "adjustment")).toEqual(tune("less", true));
    expect(answerOf(press("+", "Equal", true), "adjustment")).toEqual(tune("more"));
    expect(answerOf(press("+", "Digit1"), "adjustment")).toEqual(tune("more")); // Czech
    expect(answerOf(press("-", "Digit6"), "adjustment")).toEqual(tune("less")); // AZERTY
    expect(answerOf(press("-", "NumpadSubtract"), "adjustment")).toEqual(tune("less"));
    expect(answerOf(press("Enter", "NumpadEnter"), "adjustment")).toEqual({ do: "accept" });
    expect(answerOf(press("y", "KeyY"), "adjustment")).toBeNull();
  });
});
