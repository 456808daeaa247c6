/// The keys for answers and tuning: letters, digits, arrows, and those of foot switches and remote controls.

import { keyAmong, type KeyPress } from "../keyboard";
import type { Controls } from "./messages";

const kYes = ["y", "ArrowRight", "PageDown"], kNo = ["n", "ArrowLeft", "PageUp"];
const kBefore = ["ArrowLeft", "PageUp"], kAfter = ["ArrowRight", "PageDown"];
const kMore = ["+", "ArrowUp", "ArrowRight", "PageDown"], kLess = ["-", "ArrowDown", "ArrowLeft", "PageUp"];

export type AnswerAct =
  | { do: "answer"; button: number } // index from 0 at the left
  | { do: "tune"; to: "less" | "more"; coarse: boolean }
  | { do: "accept" };

/// The keys of each button: its number, and arrows for the leftmost and rightmost button.
function keysOf({ form, words }: Buttons): string[][] {
  if (form === "yes-no") return [kYes, kNo];
  return words.map((_, i) => [`${i + 1}`, ...(i === 0 ? kBefore : i === words.length - 1 ? kAfter : [])]);
}

export type Buttons = Pick<Controls, "form" | "words">;

/// The action of a key under these controls; null for none.
export function answerOf(press: KeyPress, controls: Buttons): AnswerAct | null {
  if (controls.form === "tuned") {
    const key = keyAmong(press, [...kMore, ...kLess, "Enter"]);
    if (key === undefined) return null;
    if (key === "Enter") return { do: "accept" };
    return { do: "tune", to: kMore.includes(key) ? "more" : "less", coarse: press.shiftKey && key !== "+" };
  }
  const keys = keysOf(controls);
  const key = keyAmong(press, keys.flat());
  return key === undefined ? null : { do: "answer", button: keys.findIndex((of) => of.includes(key)) };
}
