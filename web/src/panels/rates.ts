/// Watches whether the run meets its rates, and states the reason if it does not.

import type { Rates } from "../messages";
import { fixed } from "../text";
import { numberOf, type Frame } from "../wire";

const kHeld = 0.98; // fraction of a rate that counts as met
const kOver = 3; // time over which rates and durations are averaged [s]
const kFull = 0.85; // fraction of the available time above which the work itself is too much
const kSure = 2; // time for which rates must be missed before it is reported [s]

interface Sample {
  time: number; // [s]
  smoke: number; // [Hz]
  plans: number;
  stages: Record<Stage, number>; // [ms]
}
type Stage = "track" | "hand" | "fluid" | "contact" | "plan" | "lift";
const kNames: Record<Stage, string> = {
  track: "the tracking", hand: "the hand on its grid", fluid: "the smoke", contact: "the pressure on the skin",
  plan: "the planner", lift: "lifting the paths onto the skin",
};

export class RateWatch {
  private samples: Sample[] = [];
  private missedSince: number | null = null;

  /// @param now the page's clock [s].
  add(frame: Frame, now: number): void {
    // rates cover the last second, so they mean nothing in a pause and right after it
    if (frame.run.paused) return this.forget();
    const ms = (name: Parameters<typeof numberOf>[1]) => {
      const value = numberOf(frame, name);
      return Number.isFinite(value) ? value : 0;
    };
    this.samples.push({
      time: now, smoke: ms("world_hz"), plans: ms("plan_hz"),
      stages: {
        track: ms("track_ms"), hand: ms("hand_ms"), fluid: ms("world_ms"), contact: ms("contact_ms"),
        plan: ms("plan_ms"), lift: ms("lift_ms"),
      },
    });
    this.samples = this.samples.filter((s) => s.time > now - kOver);
  }

  forget(): void {
    this.samples = [];
    this.missedSince = null;
  }

  private mean(of: (s: Sample) => number): number {
    return this.samples.reduce((sum, s) => sum + of(s), 0) / Math.max(1, this.samples.length);
  }

  /// Why the rates are missed; "" if they are met, or if it is too early to tell.
  /// @param drawing whether the processor draws this page's picture.
  sentence(rates: Rates, now: number, drawing: boolean): string {
    const first = this.samples[0];
    const known = first !== undefined && first.time < now - 0.7 * kOver;
    const smoke = this.mean((s) => s.smoke), plans = this.mean((s) => s.plans);
    if (!known || (smoke >= kHeld * rates.world_hz && plans >= kHeld * rates.plan_hz)) {
      this.missedSince = null;
      return "";
    }
    this.missedSince ??= now;
    if (now - this.missedSince < kSure) return "";
    const hertz = (is: number, set: number) => `${fixed(is, 1)} of ${fixed(set, Number.isInteger(set) ? 0 : 1)} Hz`;
    return `Rates not held: smoke ${hertz(smoke, rates.world_hz)}, plans ${hertz(plans, rates.plan_hz)}, ` +
      `because ${this.reason(rates, drawing)}.`;
  }

  /// The stages of the two threads, which run one after the other, and the time available.
  private work(rates: Rates): { name: "a step" | "a plan"; sum: number; room: number; parts: [Stage, number][] }[] {
    const stage = (name: Stage) => this.mean((s) => s.stages[name]);
    const perStep = rates.plan_hz / rates.world_hz; // plans per step
    const step: [Stage, number][] = [
      ["track", stage("track")], ["hand", stage("hand")], ["fluid", stage("fluid")],
      ["contact", perStep * stage("contact")],
    ];
    const plan: [Stage, number][] = [["plan", stage("plan")], ["lift", stage("lift")]];
    const sum = (parts: [Stage, number][]) => parts.reduce((all, [, ms]) => all + ms, 0);
    return [
      { name: "a step", sum: sum(step), room: 1000 / rates.world_hz, parts: step },
      { name: "a plan", sum: sum(plan), room: 1000 / rates.plan_hz, parts: plan },
    ];
  }
  private tooMuch(rates: Rates) {
    return this.work(rates).find(({ sum, room }) => sum >= kFull * room);
  }

  private reason(rates: Rates, drawing: boolean): string {
    const over = this.tooMuch(rates);
    if (over !== undefined) {
      const { name, sum, room, parts } = over;
      const [slowest, ms] = parts.reduce((a, b) => (b[1] > a[1] ? b : a));
      const takes = sum > room ? `${fixed(sum, 0)} ms but has only ${fixed(room, 0)} ms` : `${fixed(sum, 0)} of its ${fixed(room, 0)} ms`;
      return `${name} takes ${takes}; ${kNames[slowest]} alone takes ${fixed(ms, 0)} ms`;
    }
    const { sum, room } = this.work(rates)[0]!;
    const others = drawing ? "this page's picture and other work have" : "other work has";
    return `${others} the processor (the stages of a step take ${fixed(sum, 0)} of ${fixed(room, 0)} ms)`;
  }
}
