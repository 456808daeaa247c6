/// The page's keys, wherever the focus is.

export interface Keys {
  help(): void;
  mute(): void;
  freeze(): void;
  play(): void;
  letGo(): void;
}

/// Whether somebody writes, or chooses by letters.
function takesLetters(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && target.closest('input[type="number"], select, dialog') !== null;
}
/// Whether Space means something there.
function takesSpace(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && target.closest("input, select, button, summary, dialog") !== null;
}

export function listen(keys: Keys): void {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === "Escape") keys.letGo();
    if (event.key === "?") return keys.help();
    if (!takesLetters(event.target) && !event.repeat) {
      if (event.key.toLowerCase() === "m") return keys.mute();
      if (event.key.toLowerCase() === "f") return keys.freeze();
    }
    if (event.key === " " && !takesSpace(event.target)) {
      event.preventDefault();
      // the strips stand still where they have the focus, the run elsewhere
      if (event.target instanceof HTMLElement && event.target.closest("#strips-card")) keys.freeze();
      else keys.play();
    }
  });
}
