/// Keys of answers and of tuning: letters, digits, arrows, and those that foot switches and remote controls send.

import { keyAmong, type KeyPress } from "../keyboard";
import type { Task } from "./messages";

const kYes = ["y", "ArrowRight", "PageDown"], kNo = ["n", "ArrowLeft", "PageUp"];
const kFirst = ["1", "ArrowLeft", "PageUp"], kSecond = ["2", "ArrowRight", "PageDown"];
const kMore = ["+", "ArrowUp", "ArrowRight", "PageDown"], kLess = ["-", "ArrowDown", "ArrowLeft", "PageUp"];

export type AnswerAct =
  | { do: "answer"; first: boolean } // the left of two buttons, or the right one
  | { do: "tune"; to: "less" | "more"; coarse: boolean }
  | { do: "accept" };

/// The act of a key in a task; null for none.
export function answerOf(press: KeyPress, task: Task): AnswerAct | null {
  if (task === "adjustment") {
    const key = keyAmong(press, [...kMore, ...kLess, "Enter"]);
    if (key === undefined) return null;
    if (key === "Enter") return { do: "accept" };
    return { do: "tune", to: kMore.includes(key) ? "more" : "less", coarse: press.shiftKey && key !== "+" };
  }
  const [first, second] = task === "forced-choice" ? [kFirst, kSecond] : [kYes, kNo];
  const key = keyAmong(press, [...first, ...second]);
  return key === undefined ? null : { do: "answer", first: first.includes(key) };
}
