/// A look back at the last minutes of the run, and the way back to the present.

import { find, setText } from "../dom";
import { kPast, type Past } from "../panels/past";
import { fixed } from "../text";
import type { Frame } from "../wire";

export interface Moments {
  /// Shows an earlier moment. @param frame null: the present. @param time of the page's clock [s].
  show(frame: Frame | null, time: number): void;
}

const kLeast = 1; // time that must have been kept [s]

export class Rewind {
  private readonly slider = find<HTMLInputElement>("rewind-at");
  private readonly button = find<HTMLButtonElement>("rewind-live");
  private then: number | null = null; // the moment shown, of the page's clock [s]
  private shown: Frame | null = null;

  constructor(private readonly past: Past, private readonly moments: Moments) {
    this.slider.addEventListener("input", () => {
      const before = Number(this.slider.value);
      if (before >= 0) this.live();
      else this.go(performance.now() / 1000 + before);
    });
    this.button.addEventListener("click", () => {
      this.live();
      this.slider.focus();
    });
    this.tell();
  }

  get active(): boolean { return this.then !== null; }

  live(): void {
    this.then = this.shown = null;
    this.slider.value = "0";
    this.moments.show(null, 0);
    this.tell();
  }

  /// Moves the slider on, since the moment shown grows older. @param now the page's clock [s].
  /// @param handHeld whether this page holds the hand, for which the present must be shown.
  update(now: number, handHeld: boolean): void {
    if (handHeld && this.active) this.live();
    const kept = Math.min(kPast, now - (this.past.oldest ?? now));
    this.slider.disabled = handHeld || (!this.active && kept < kLeast);
    if (this.slider.matches(":active")) return; // the user moves it
    this.slider.min = String(-Math.max(kLeast, Math.floor(kept)));
    this.slider.value = String((this.then ?? now) - now);
    this.tell();
  }

  private go(time: number): void {
    this.then = time;
    this.shown = this.past.at(time);
    if (this.shown === null) return this.live();
    this.moments.show(this.shown, time);
    this.tell();
  }

  private tell(): void {
    document.documentElement.dataset.moment = this.active ? "past" : "live";
    this.button.hidden = !this.active;
    const share = 1 - Number(this.slider.value) / Number(this.slider.min);
    this.slider.style.setProperty("--share", `${100 * share}%`);
    const before = performance.now() / 1000 - (this.then ?? 0);
    const words = this.then === null ? "live" : `not live: ${fixed(before, 1)} s ago, at ${fixed(this.shown?.run.time ?? NaN, 1)} s of the run`;
    setText(find("rewind-words"), words);
    this.slider.setAttribute("aria-valuetext", words);
  }
}
