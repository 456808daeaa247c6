/// Play, pause, step, and the position in a recording.

import { find, make, setText } from "../dom";
import type { PageMessage, State } from "../messages";
import { placeOf, sourceOf } from "../panels/words";
import { fixed } from "../text";
import type { Frame } from "../wire";

export class Transport {
  private readonly play = find<HTMLButtonElement>("play");
  private readonly step = find<HTMLButtonElement>("step");
  private readonly scrub = find<HTMLInputElement>("scrub");
  private readonly place = find("place");
  private playing = true;
  private length = 0;
  private held = 0; // until then the position set here is shown [ms]

  constructor(private readonly send: (message: PageMessage) => void) {
    this.play.addEventListener("click", () => this.toggle());
    this.step.addEventListener("click", () => send({ type: "transport", do: "step" }));
    this.scrub.addEventListener("input", () => {
      this.held = performance.now() + 500;
      this.showPlace(Number(this.scrub.value));
      send({ type: "transport", do: "seek", time_s: Number(this.scrub.value) });
    });
  }

  toggle(): void {
    if (!this.play.matches(":disabled")) this.send({ type: "transport", do: this.playing ? "pause" : "play" });
  }

  show(state: State, page: number): void {
    const { playing, recording } = state.transport;
    // unchanged buttons stay, so that they can be pressed
    if (playing !== this.playing || this.play.childElementCount === 0) {
      const icon = make("span", { class: `icon ${playing ? "pause" : "play"}`, "aria-hidden": "true" });
      this.play.replaceChildren(icon, playing ? "Pause" : "Play");
    }
    this.playing = playing;
    this.length = recording?.length_s ?? 0;
    this.scrub.hidden = this.place.hidden = recording === null;
    this.scrub.disabled = recording?.seekable !== true;
    this.scrub.max = String(this.length);
    setText(find("source"), sourceOf(state.transport, page));
    const { tracker } = state;
    const sentence = tracker === null ? "" : `${tracker.sentence} · ${tracker.frames} frames, ` +
      `${tracker.dropped} dropped, ${tracker.repeated} repeated; ` +
      `hands not taken: ${tracker.dropped_hands} dropped, ${tracker.unsure} unsure, ${tracker.frozen} frozen`;
    find("tracker").textContent = sentence;
    find("tracker").classList.toggle("bad", tracker !== null && !tracker.connected);
  }

  frame(frame: Frame): void {
    const at = frame.run.recordingTime;
    setText(find("time"), `${fixed(frame.run.time, 2)} s`);
    if (this.scrub.hidden || !Number.isFinite(at) || performance.now() < this.held) return;
    this.scrub.value = String(at);
    this.showPlace(at);
  }

  private showPlace(at: number): void {
    this.scrub.style.setProperty("--share", `${(100 * at) / (this.length || 1)}%`);
    this.scrub.setAttribute("aria-valuetext", `${fixed(at, 1)} of ${fixed(this.length, 1)} seconds`);
    setText(find("place-words"), placeOf(at, this.length));
  }
}
