/// The page's keys, wherever the focus is.

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
/// Whether somebody writes, or chooses by letters.
const takesLetters = (target: EventTarget | null) => inDialog(target) || isIn(target, 'input[type="number"], select');
/// Whether Space means something there.
const takesSpace = (target: EventTarget | null) => inDialog(target) || isIn(target, "input, select, button, summary");

export function listen(keys: Keys): void {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === "Escape" && !inDialog(event.target)) keys.letGo();
    if (event.key === "?") return keys.help();
    if (!takesLetters(event.target) && !event.repeat) {
      if (event.key.toLowerCase() === "m") return keys.mute();
      if (event.key.toLowerCase() === "f") return keys.freeze();
    }
    if (event.key === " " && !takesSpace(event.target)) {
      event.preventDefault();
      // the strips stand still where they have the focus, the run elsewhere
      if (isIn(event.target, "#strips-card")) keys.freeze();
      else keys.play();
    }
  });
}
