/// The page's texts about the run.

import type { State } from "../messages";
import { fixed } from "../text";
import { numberOf, type Frame } from "../wire";

export interface Output {
  state: "on" | "off" | "muted" | "unknown";
  why: string;
}

const kAudible = 0.005; // intensity of the strongest focal point, 0 to 1, above which the output counts as on

/// Returns the state of the output in a frame.
export function outputOf(frame: Frame): Output {
  const { run } = frame;
  if (run.deviceLost) return { state: "off", why: "the link to the array is lost; trying again" };
  if (run.muted) return { state: "muted", why: "by you or another page" };
  if (run.hot) return { state: "muted", why: "because the array is too hot" };
  if (run.calibrating) return { state: "muted", why: "for the calibration" };
  const intensity = numberOf(frame, "intensity");
  // for a device that does not report its output: it plays the plan
  const sounds = Number.isFinite(intensity) ? intensity > kAudible : run.handInSight && !run.paused && !run.fading;
  if (sounds) return { state: "on", why: "" };
  if (run.paused) return { state: "off", why: "paused" };
  if (!run.handInSight) return { state: "off", why: "no hand in sight" };
  if (run.fading) return { state: "off", why: "no new plan" };
  return { state: "off", why: "no pressure on the hand" };
}

const kSources: Record<string, string> = {
  scripted: "scripted hand", recording: "recorded hand", leap: "tracked hand (Leap)", openxr: "tracked hand (OpenXR)",
};

/// Why the program released the page's hand.
const kReleased: Record<State["transport"]["page_hand"], string> = {
  free: "", held: "", late: "; the page that held the hand is late", hidden: "; the page that held the hand is hidden",
};

/// Describes where the hands come from, for the page with this number.
export function sourceOf({ source, hand_page: holder, page_hand: hand }: State["transport"], page: number): string {
  if (source !== "page") return (kSources[source] ?? source) + kReleased[hand];
  if (holder === null) return "no page’s hand" + kReleased[hand];
  return holder === page ? "hand from this page" : "hand from another page";
}

/// Returns the position in a recording [s] as text.
export function placeOf(at: number, length: number): string {
  return `${fixed(at, 1)} / ${fixed(length, 1)} s · repeats`;
}

/// Returns what to do without a hand, depending on its source.
export function advice(state: State | null): string {
  if (state === null) return "";
  const { tracker, transport } = state;
  if (tracker !== null) return tracker.connected ? "Hold a hand over the array." : tracker.sentence;
  if (transport.base === "page") return "Switch on “Use my mouse as the hand”.";
  return "It comes back by itself; or use your mouse as the hand.";
}
