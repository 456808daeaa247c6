import { expect, it } from "vitest";
import type { Phase } from "../../src/study/messages";
import { progress } from "../../src/study/progress";

it("counts trials and practice trials, and neither training nor consent", () => {
  const at = (phase: Phase, done = 0, open = false, practice = 0) => progress({ phase, done, trials: 16, open, practice });
  expect((["consent", "about", "training"] as const).map((phase) => at(phase))).toEqual(["", "", "Training"]);
  expect((["ready", "settling", "presenting", "break"] as const).map((phase) => at(phase))).toEqual(Array(4).fill("Trial 1 of 16"));
  expect(at("settling", 15)).toBe("Trial 16 of 16");
  expect([at("done", 16), at("done", 9, true), at("presenting", 3, true)]).toEqual(["All 16 trials done", "All 9 trials done", "Trial 4"]);
  expect([at("ready", 0, false, 1), at("presenting", 0, false, 3)]).toEqual(["Practice 1", "Practice 3"]);
});
