import { describe, expect, it } from "vitest";
import type { KeyPress } from "../../src/keyboard";
import { answerOf, type Buttons } from "../../src/study/answer_keys";

const press = (key: string, code: string, shiftKey = false): KeyPress => ({ key, code, shiftKey });
const first = { do: "answer", button: 0 }, second = { do: "answer", button: 1 };
const yesNo: Buttons = { form: "yes-no", words: ["Yes", "No"] }, tuned: Buttons = { form: "tuned", words: [] };
const intervals = (...words: string[]): Buttons => ({ form: "interval", words });

describe("yes and no", () => {
  it.each([
    ["y", "KeyY", first], ["Y", "KeyY", first], ["y", "KeyZ", first], ["z", "KeyY", null], ["n", "KeyN", second], ["N", "KeyN", second],
    ["н", "KeyY", first], ["т", "KeyN", second], ["υ", "KeyY", first], ["ν", "KeyN", second], ["Υ", "KeyY", first], ["ט", "KeyY", first],
    ["Dead", "KeyN", second], ["Process", "KeyY", first], ["ArrowRight", "ArrowRight", first], ["PageUp", "PageUp", second],
    ["1", "Digit1", null], ["m", "KeyM", null],
  ])("are %s at %s", (key, code, act) => {
    expect(answerOf(press(key, code), yesNo)).toEqual(act);
  });
});

describe("the first and the second", () => {
  it.each([
    ["1", "Digit1", first], ["2", "Digit2", second], ["&", "Digit1", first], ["é", "Digit2", second], ["+", "Digit1", first], ["ě", "Digit2", second],
    ["!", "Digit1", first], ["@", "Digit2", second], ["١", "Digit1", first], ["1", "Numpad1", first], ["2", "Numpad2", second],
    ["End", "Numpad1", first], ["ArrowDown", "Numpad2", second], ["ArrowLeft", "Numpad4", first], ["3", "Digit3", null], ["y", "KeyY", null],
  ])("are %s at %s", (key, code, act) => expect(answerOf(press(key, code), intervals("The first", "The second"))).toEqual(act));
});

describe("three intervals", () => {
  it.each([["1", "Digit1", 0], ["2", "Digit2", 1], ["3", "Digit3", 2], ["ArrowLeft", "ArrowLeft", 0], ["ArrowRight", "ArrowRight", 2]])(
    "have a key each: %s", (key, code, button) => expect(answerOf(press(key, code), intervals("1", "2", "3"))).toEqual({ do: "answer", button }));
});

describe("tuning", () => {
  const tune = (to: string, coarse = false) => ({ do: "tune", to, coarse });
  it("uses arrows and signs, also on the keypad", () => {
    expect(answerOf(press("ArrowUp", "ArrowUp"), tuned)).toEqual(tune("more"));
    expect(answerOf(press("ArrowLeft", "ArrowLeft", true), tuned)).toEqual(tune("less", true));
    expect(answerOf(press("+", "Equal", true), tuned)).toEqual(tune("more"));
    expect(answerOf(press("+", "Digit1"), tuned)).toEqual(tune("more")); // Czech
    expect(answerOf(press("-", "Digit6"), tuned)).toEqual(tune("less")); // AZERTY
    expect(answerOf(press("-", "NumpadSubtract"), tuned)).toEqual(tune("less"));
    expect(answerOf(press("Enter", "NumpadEnter"), tuned)).toEqual({ do: "accept" });
    expect(answerOf(press("y", "KeyY"), tuned)).toBeNull();
  });
});
