/// Play, pause, step, and the place in a recording.

import { find, fixed, make } from "../dom";
import type { PageMessage, State } from "../messages";
import type { Frame } from "../wire";

const kSources: Record<string, string> = { scripted: "scripted hand", recording: "recorded hand", leap: "tracked hand (Leap)", openxr: "tracked hand (OpenXR)", page: "hand from this page" };

export class Transport {
  private readonly play = find<HTMLButtonElement>("play");
  private readonly step = find<HTMLButtonElement>("step");
  private readonly scrub = find<HTMLInputElement>("scrub");
  private readonly time = find("time");
  private readonly source = find("source");
  private playing = true;
  private length = 0;
  private held = 0; // until then the page's own place stands [ms]

  constructor(private readonly send: (message: PageMessage) => void) {
    this.play.addEventListener("click", () => this.toggle());
    this.step.addEventListener("click", () => send({ type: "transport", do: "step" }));
    this.scrub.addEventListener("input", () => {
      this.held = performance.now() + 500;
      send({ type: "transport", do: "seek", time_s: Number(this.scrub.value) });
    });
  }

  toggle(): void { this.send({ type: "transport", do: this.playing ? "pause" : "play" }); }

  show(state: State): void {
    const { playing, recording, source } = state.transport;
    // a button that is being pressed stays as it is
    if (playing !== this.playing || this.play.childElementCount === 0) {
      this.play.replaceChildren(make("span", { class: `icon ${playing ? "pause" : "play"}`, "aria-hidden": "true" }), playing ? "Pause" : "Play");
      this.play.setAttribute("aria-pressed", String(!playing));
    }
    this.playing = playing;
    this.length = recording?.length_s ?? 0;
    this.scrub.hidden = recording === null;
    this.scrub.disabled = recording?.seekable !== true;
    this.scrub.max = String(this.length);
    this.source.textContent = kSources[source] ?? source;
    const { tracker } = state;
    const sentence = tracker === null ? "" : `${tracker.sentence} · ${tracker.frames} frames, ` +
      `${tracker.dropped} dropped, ${tracker.repeated} repeated; hands not taken: ${tracker.unsure} unsure, ${tracker.frozen} frozen`;
    find("tracker").textContent = sentence;
    find("tracker").classList.toggle("bad", tracker !== null && !tracker.connected);
  }

  frame(frame: Frame): void {
    const at = frame.run.recordingTime;
    this.time.textContent = `${fixed(frame.run.time, 2)} s`;
    if (this.scrub.hidden || !Number.isFinite(at) || performance.now() < this.held) return;
    this.scrub.value = String(at);
    this.scrub.style.setProperty("--share", `${(100 * at) / (this.length || 1)}%`);
    this.scrub.setAttribute("aria-valuetext", `${fixed(at, 1)} of ${fixed(this.length, 1)} seconds`);
  }
}
