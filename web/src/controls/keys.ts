/// The page's keys, wherever the focus is.

import { isCommand, keyAmong, takesText } from "../keyboard";

export interface Keys {
  help(): void;
  mute(): void;
  freeze(): void;
  play(): void;
  letGo(): void;
}

const isIn = (target: EventTarget | null, parts: string) =>
  target instanceof HTMLElement && target.closest(parts) !== null;

/// Whether a dialog takes the keys: it has the focus, or lies over the page.
function inDialog(target: EventTarget | null): boolean {
  return isIn(target, "dialog") || document.querySelector("dialog:modal") !== null;
}
/// Whether somebody enters a number, or chooses by letters.
const takesLetters = (target: EventTarget | null) => inDialog(target) || isIn(target, 'input[type="number"], select');
/// Whether Space means something there.
const takesSpace = (target: EventTarget | null) => inDialog(target) || isIn(target, "input, select, button, summary");

export function listen(keys: Keys): void {
  document.addEventListener("keydown", (event) => {
    const { target } = event;
    if (isCommand(event) || takesText(target)) return;
    const key = keyAmong(event, ["Escape", "?", "m", "f", " "]);
    if (key === "Escape" && !inDialog(target)) keys.letGo();
    if (key === "?" && !event.repeat) keys.help();
    if (key === "m") {
      event.preventDefault(); // a list would choose by the letter
      if (!event.repeat) keys.mute();
    }
    if (key === "f" && !event.repeat && !takesLetters(target)) keys.freeze();
    if (key === " " && !takesSpace(target)) {
      event.preventDefault();
      // the strips stand still where they have the focus, the run elsewhere
      if (isIn(target, "#strips-card")) keys.freeze();
      else keys.play();
    }
  });
}
