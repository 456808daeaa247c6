/// The button that mutes the array.

import { find, setText } from "../dom";
import type { PageMessage } from "../messages";
import type { Frame } from "../wire";

export class Mute {
  private readonly button = find<HTMLButtonElement>("mute");
  private muted = false;

  constructor(private readonly send: (message: PageMessage) => void) {
    this.button.addEventListener("click", () => this.toggle());
  }

  toggle(): void {
    if (!this.button.matches(":disabled")) this.send({ type: "mute", on: !this.muted });
  }

  frame(frame: Frame): void {
    this.muted = frame.run.muted;
    this.button.setAttribute("aria-pressed", String(this.muted));
    setText(this.button.querySelector("span")!, this.muted ? "Unmute" : "Mute");
  }
}
