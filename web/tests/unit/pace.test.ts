import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { SettingsSender } from "../../src/controls/settings_sender";
import { Pace } from "../../src/scene/pace";

/// Draws pictures of this cost for some seconds.
function drawn(pace: Pace, cost: number, seconds: number, held: boolean, from = 0): { interval: number; off: boolean; at: number } {
  let off = false, interval = 0, next = from, t = from;
  for (; t < from + 1000 * seconds; t += 20) {
    const state = pace.state(t, held);
    ({ interval } = state);
    off ||= state.off;
    if (t < next) continue;
    pace.drew(cost);
    next = t + interval;
  }
  return { interval, off, at: t };
}

describe("the pace of pictures", () => {
  it("is free if they are fast", () => expect(drawn(new Pace(false), 16, 30, false)).toMatchObject({ interval: 0, off: false }));
  it("leaves seven eighths of the time to a processor that draws", () => {
    expect(drawn(new Pace(true), 100, 10, true)).toMatchObject({ interval: 800, off: false });
  });
  it("slows down first if the run suffers, and switches off last", () => {
    const pace = new Pace(true);
    const first = drawn(pace, 40, 4, false);
    expect(first.interval).toBeGreaterThanOrEqual(320);
    expect(first.off).toBe(false);
    const last = drawn(pace, 40, 20, false, first.at);
    expect(last.off).toBe(true);
    pace.begin();
    expect(pace.state(last.at, false)).toEqual({ interval: 80, off: false });
  });
  it("switches off if a picture takes so long that it is of no use", () => {
    expect(drawn(new Pace(true), 300, 5, true).off).toBe(false);
    expect(drawn(new Pace(true), 500, 20, true).off).toBe(true);
  });
});

describe("settings on their way", () => {
  beforeEach(() => {
    vi.useFakeTimers();
    vi.stubGlobal("window", globalThis);
  });
  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  it("are sent at once, and then the newest of each control at most twenty times a second", () => {
    const sent: [string, unknown, number][] = [];
    const begun = performance.now();
    const sender = new SettingsSender((id, value) => sent.push([id, value, performance.now() - begun]));
    for (let i = 0; i < 400; ++i) {
      sender.set("speed", i);
      if (i % 2 === 0) sender.set("gain", -i);
      vi.advanceTimersByTime(1);
    }
    vi.advanceTimersByTime(100);
    const speeds = sent.filter(([id]) => id === "speed");
    expect(speeds[0]![2]).toBeLessThanOrEqual(1);
    expect(speeds.length).toBeLessThanOrEqual(10);
    expect(speeds[speeds.length - 1]![1]).toBe(399);
    expect(sent.filter(([id]) => id === "gain").pop()![1]).toBe(-398);
    for (let i = 1; i < speeds.length; ++i) expect(speeds[i]![2] - speeds[i - 1]![2]).toBeGreaterThanOrEqual(49);
  });
  it("are discarded with the connection", () => {
    const sent: string[] = [];
    const sender = new SettingsSender((id) => sent.push(id));
    sender.set("speed", 1);
    sender.forget();
    vi.advanceTimersByTime(100);
    expect(sent).toEqual([]);
  });
});
