import { describe, expect, it } from "vitest";
import { caption } from "../../src/controls/caption";
import { commandLine } from "../../src/controls/command_line";
import { RateWatch } from "../../src/panels/rates";
import { advice, outputOf, placeOf, sourceOf } from "../../src/panels/words";
import { handLength } from "../../src/scene/hand_bones";
import { frameWith, paths, scene, speed, stateWith } from "../support/frames";
import { skeleton } from "../support/skeleton";
import { Matrix4 } from "three";

describe("the output's sign", () => {
  it("shows whether the array emits, and why not", () => {
    const said = (run: Parameters<typeof frameWith>[0], intensity: number) => Object.values(outputOf(frameWith(run, { intensity }))).join(": ");
    expect(said({ handInSight: true }, 0.4)).toBe("on: ");
    expect(said({ handInSight: true, muted: true }, 0.4)).toMatch(/^muted: by/);
    expect(said({ handInSight: true, calibrating: true }, 0)).toMatch(/^muted: for the calibration/);
    expect(said({ handInSight: true, hot: true }, 0)).toBe("muted: because the array is too hot");
    expect(said({ handInSight: false }, 0)).toBe("off: no hand in sight");
    expect(said({ handInSight: true, paused: true }, 0)).toBe("off: paused");
    expect(said({ handInSight: true, fading: true }, 0)).toBe("off: no new plan");
    expect(said({ handInSight: true }, 0)).toBe("off: no pressure on the hand");
    // a device that does not report its output
    expect(said({ handInSight: true }, NaN)).toBe("on: ");
    expect(said({ handInSight: false }, NaN)).toBe("off: no hand in sight");
  });
});

describe("the source of the hands", () => {
  const { transport } = stateWith([]);
  it("distinguishes this page's hand from another's", () => {
    expect(sourceOf(transport, 1)).toBe("scripted hand");
    expect(sourceOf({ ...transport, source: "page", hand_page: 1 }, 1)).toBe("hand from this page");
    expect(sourceOf({ ...transport, source: "page", hand_page: 2 }, 1)).toBe("hand from another page");
    expect(sourceOf({ ...transport, source: "page", page_hand: "hidden" }, 1)).toBe("no page’s hand; the page that held the hand is hidden");
    expect(sourceOf({ ...transport, page_hand: "hidden" }, 1)).toBe("scripted hand; the page that held the hand is hidden");
    expect(sourceOf({ ...transport, page_hand: "late" }, 1)).toBe("scripted hand; the page that held the hand is late");
  });
  it("has its own advice if no hand is in sight", () => {
    const tracker = { connected: false, sentence: "no tracker at 127.0.0.1", frames: 0, dropped: 0, repeated: 0, dropped_hands: 0, unsure: 0, frozen: 0 };
    expect(advice(stateWith([], { tracker }))).toBe("no tracker at 127.0.0.1");
    expect(advice(stateWith([], { tracker: { ...tracker, connected: true } }))).toContain("over the array");
    expect(advice(stateWith([], { transport: { ...transport, base: "page" } }))).toContain("mouse");
  });
});

describe("the place in a recording", () => {
  it("shows the length, and that it repeats", () => {
    expect(placeOf(2.54, 8)).toBe("2.5 / 8.0 s · repeats");
  });
});

describe("missed rates", () => {
  const rates = { world_hz: 50, plan_hz: 25, advice: null };
  const after = (seconds: number, numbers: Record<string, number>, drawing = false, paused = false) => {
    const watch = new RateWatch();
    let sentence = "";
    for (let t = 0; t < seconds; t += 0.1) {
      watch.add(frameWith({ paused }, numbers), t);
      sentence = watch.sentence(rates, t, drawing);
    }
    return sentence;
  };
  const quick = { track_ms: 0.1, hand_ms: 1, world_ms: 7, contact_ms: 2, plan_ms: 3, lift_ms: 0.5 };
  it("are reported with the slowest stage", () => {
    expect(after(10, { ...quick, world_hz: 43.5, plan_hz: 21.8, world_ms: 21 })).toBe(
      "Rates not held: smoke 43.5 of 50 Hz, plans 21.8 of 25 Hz, because a step takes 23 ms but has only 20 ms; the smoke alone takes 21 ms.");
    expect(after(10, { ...quick, world_hz: 50, plan_hz: 20, plan_ms: 45 })).toContain("a plan takes 46 ms but has only 40 ms; the planner alone takes 45 ms");
    expect(after(10, { ...quick, world_hz: 40, plan_hz: 20, world_ms: 16.5 })).toContain("a step takes 19 of its 20 ms; the smoke alone takes 17 ms");
    expect(after(10, { ...quick, world_hz: 40, plan_hz: 20 })).toContain("because other work has the processor");
    expect(after(10, { ...quick, world_hz: 40, plan_hz: 20 }, true)).toContain("because this page's picture and other work have");
  });
  it("are not reported at once, while paused, or when met", () => {
    const slow = { ...quick, world_hz: 30, plan_hz: 15 };
    expect(after(3, slow)).toBe("");
    expect(after(10, slow, false, true)).toBe("");
    expect(after(10, { ...quick, world_hz: 49.5, plan_hz: 24.8 })).toBe("");
  });
});

describe("the command line", () => {
  it("has an option for each setting that has one", () => {
    expect(commandLine(stateWith([scene, speed, { ...paths, value: 2 }]))).toEqual({
      command: "prostm run --view --scene one-plume --paths 2 --hand scripted", note: "",
    });
    expect(commandLine(stateWith([scene], { settings: "[pipeline]\nscene = \"one-plume\"\n" })).command).not.toContain("--settings");
  });
  it("reports what else is needed", () => {
    const made = commandLine(stateWith([scene, { ...paths, enabled: false }], {
      settings: "[plan]\nspeed = 4\n", transport: { ...stateWith([]).transport, base: "recording" },
    }));
    expect(made.command).toBe("prostm run --view --scene one-plume --settings prostm.toml");
    expect(made.note).toMatch(/recording's file.*prostm\.toml/);
  });
});

describe("a picture's caption", () => {
  it("has the date, the scale and the relevant settings", () => {
    const modulation = { ...speed, id: "am_frequency", label: "Modulation", unit: "Hz", value: 200, enabled: false };
    const { title, parts } = caption(frameWith({ time: 12.345 }, { skill_0: 0.82, sensation_level: -8 }), stateWith([scene, speed, modulation]), 0.6, new Date("2026-01-02T03:04:05Z"));
    expect(title).toBe("prostm · 12.35 s of the run · 2026-01-02 03:04:05 UTC");
    expect(parts).toContain("Shape by Eq. (1) 0.82");
    expect(parts).toContain("Felt strength -8 dB");
    expect(parts.join("\n")).toContain("colours: 0 to 0.60 Pa");
    expect(parts).toContain("Scene One wide plume");
    expect(parts).toContain("Speed 7 m/s");
    expect(parts.join()).not.toContain("Modulation");
  });
});

describe("a hand's length", () => {
  it("is the same in any pose", () => {
    const length = (closure: number) => handLength(skeleton(new Matrix4(), closure, "right"));
    expect(length(0)).toBeGreaterThan(160);
    expect(length(0)).toBeLessThan(200);
    expect(length(1)).toBeCloseTo(length(0), 3);
  });
});
