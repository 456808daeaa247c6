/// Shows whether the array emits, and mutes it with a button.

import { find, setText } from "../dom";
import type { PageMessage } from "../messages";
import { outputOf, type Output } from "../panels/words";
import type { Frame } from "../wire";

const kMoment = 400; // [ms]
const kWords: Record<Output["state"], string> = {
  on: "Output on", off: "Output off", muted: "Muted", unknown: "Output unknown",
};

export class OutputSign {
  private readonly button = find<HTMLButtonElement>("mute");
  private muted = false;
  private sounded = -Infinity; // when the array last emitted [ms]

  constructor(private readonly send: (message: PageMessage) => void) {
    this.button.addEventListener("click", () => this.toggle());
    this.show({ state: "unknown", why: "" });
  }

  toggle(): void {
    if (!this.button.matches(":disabled")) this.send({ type: "mute", on: !this.muted });
  }

  frame(frame: Frame): void {
    this.muted = frame.run.muted;
    this.button.setAttribute("aria-pressed", String(this.muted));
    setText(this.button.querySelector("span")!, this.muted ? "Unmute" : "Mute");
    // modulated output has silent moments, which are ignored
    const now = performance.now(), output = outputOf(frame);
    if (output.state === "on") this.sounded = now;
    if (output.state !== "off" || now - this.sounded > kMoment) this.show(output);
  }
  lost(): void {
    this.sounded = -Infinity;
    this.show({ state: "unknown", why: "not connected" });
  }

  private show({ state, why }: Output): void {
    find("output").dataset.output = state;
    setText(find("output-word"), kWords[state]);
    setText(find("output-why"), why);
  }
}
