/// The page's shortcuts, which work wherever the focus is.

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

/// Whether a dialog receives the keys: it has the focus, or covers the page.
function inDialog(target: EventTarget | null): boolean {
  return isIn(target, "dialog") || document.querySelector("dialog:modal") !== null;
}
/// Whether the element takes numbers, or selects a choice by its letters.
const takesLetters = (target: EventTarget | null) => inDialog(target) || isIn(target, 'input[type="number"], select');
/// Whether Space activates the element.
const takesSpace = (target: EventTarget | null) => inDialog(target) || isIn(target, "input, select, button, summary");

export function listen(keys: Keys): void {
  document.addEventListener("keydown", (event) => {
    const { target } = event;
    if (isCommand(event) || takesText(target)) return;
    const key = keyAmong(event, ["Escape", "?", "m", "f", " "]);
    if (key === "Escape" && !inDialog(target)) keys.letGo();
    if (key === "?" && !event.repeat) keys.help();
    if (key === "m") {
      event.preventDefault(); // otherwise a list selects by the letter
      if (!event.repeat) keys.mute();
    }
    if (key === "f" && !event.repeat && !takesLetters(target)) keys.freeze();
    if (key === " " && !takesSpace(target)) {
      event.preventDefault();
      // freezes the strips if they have the focus, pauses the run otherwise
      if (isIn(target, "#strips-card")) keys.freeze();
      else keys.play();
    }
  });
}
