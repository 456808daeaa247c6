import { statSync, readFileSync } from "node:fs";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import "../../src/inspection";
import { kNumbers } from "../../src/wire";
import { clean, openBrowser, Program, until, Watch, writeRecording, type Json } from "./program";

const program = new Program(["--grid", "32", "--scene", "four-plumes", "--hand", writeRecording(6), "--seconds", "3600"]);
let browser: Browser, page: Page, watch: Watch;

beforeAll(async () => {
  browser = await openBrowser();
  await program.start();
  page = await browser.newPage({ viewport: { width: 1280, height: 720 }, colorScheme: "light" });
  watch = new Watch(page);
});
afterAll(async () => {
  await browser?.close();
  await program.stop();
  clean();
});

// a frame may take long if the picture is drawn in software
const kSoon = { timeout: 30_000, interval: 100 };
// every group open, and the picture drawn however long it takes
const kHash = "/#folded=&picture=on";

const frameCount = () => page.evaluate(() => window.prostm.frames);
/// Waits until frames arrive after this point.
async function newFrames(of: Page = page, count = 2): Promise<void> {
  const now = await of.evaluate(() => window.prostm.frames);
  await until(of, (n) => window.prostm.frames >= n, now + count, "new frames");
}
const value = (id: string) => page.evaluate((i) => window.prostm.state?.controls.find((c) => c.id === i)?.value, id);
const becomes = (id: string, wanted: string | number | boolean) =>
  until(page, ({ id, wanted }) => {
    const now = window.prostm.state?.controls.find((c) => c.id === id)?.value;
    return typeof now === "number" && typeof wanted === "number" ? Math.abs(now - wanted) < 1e-9 : now === wanted;
  }, { id, wanted }, `${id} becomes ${wanted}`);

/// Changes a control as a user with a keyboard or a mouse would.
async function turn(id: string, to: string | number | boolean): Promise<void> {
  const field = page.locator(`[data-control="${id}"]`);
  if (typeof to === "number") {
    await field.locator("input[type=number]").fill(String(to));
    await field.locator("input[type=number]").press("Enter");
  } else if (typeof to === "boolean") {
    await field.locator("input[type=checkbox]").setChecked(to);
  } else if ((await field.locator("select").count()) > 0) {
    await field.locator("select").selectOption(to);
  } else {
    await field.locator(`label[for="control-${id}-${to}"]`).click();
  }
  await becomes(id, to);
}

describe("an opened page", () => {
  it("soon shows a moving scene", async () => {
    const start = Date.now();
    await page.goto(program.address + kHash);
    await until(page, () => (window.prostm?.frames ?? 0) >= 3 && window.prostm.pictures >= 2 && (window.prostm.frame?.hands.length ?? 0) > 0, 0, "frames and pictures");
    console.log(`the first pictures came ${Date.now() - start} ms after opening`);

    // content of the picture: many colours, skin among them, and not the same twice
    const look = () => page.evaluate(() => {
      const view = document.getElementById("view") as HTMLCanvasElement;
      const small = document.createElement("canvas");
      [small.width, small.height] = [160, 120];
      const context = small.getContext("2d", { willReadFrequently: true })!;
      return new Promise<number[]>((resolve) => requestAnimationFrame(() => {
        // the picture can be read right after it is drawn
        const drawn = window.prostm.pictures;
        const wait = () => {
          if (window.prostm.pictures === drawn) return void requestAnimationFrame(wait);
          context.drawImage(view, 0, 0, 160, 120);
          resolve([...context.getImageData(0, 0, 160, 120).data]);
        };
        wait();
      }));
    });
    const first = await look();
    const colours = new Set<number>();
    for (let i = 0; i < first.length; i += 4) colours.add((first[i]! << 16) | (first[i + 1]! << 8) | first[i + 2]!);
    expect(colours.size).toBeGreaterThan(400);
    await newFrames(page, 10);
    const second = await look();
    const changed = first.filter((v, i) => Math.abs(v - second[i]!) > 8).length;
    expect(changed).toBeGreaterThan(100);
  });

  it("has planes with fields, and strips with lines", async () => {
    for (const kind of ["target", "rendered", "difference"]) {
      await until(page, (k) => {
        const canvas = document.querySelector<HTMLCanvasElement>(`canvas[data-kind=${k}]`)!;
        const data = canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height).data;
        return data.filter((v, i) => i % 4 === 3 && v > 0).length > 0.1 * canvas.width * canvas.height;
      }, kind, `a hand in the plane of the ${kind}`);
    }
    await until(page, () => document.querySelectorAll(".strip canvas").length === 8, 0, "eight strips");
  });
});

describe("numbers", () => {
  it("on a paused page are those of the program", async () => {
    let theirs: Json = {}, ours: { run: Record<string, string>; numbers: [string, string][] } = { run: {}, numbers: [] };
    const pause = async () => {
      await page.locator("#play").click();
      await until(page, () => window.prostm.state?.transport.playing === false && window.prostm.frame?.run.paused === true, 0, "a pause");
      // the same frame on both sides
      await expect.poll(async () => {
        theirs = await program.numbers();
        ours = await page.evaluate(() => ({
          run: Object.fromEntries([...document.querySelectorAll<HTMLElement>("[data-run]")].map((e) => [e.dataset.run!, e.textContent!])),
          numbers: [...document.querySelectorAll<HTMLElement>("[data-number]")].map((e): [string, string] => [e.dataset.number!, e.textContent!]),
        }));
        return ours.run.sequence === String(theirs.sequence);
      }, { timeout: 30_000, interval: 20 }).toBe(true);
    };
    // at a moment with a plan: the recording has none at its ends
    await pause();
    for (let round = 0; round < 5 && (theirs.numbers as Json).rmse === null; ++round) {
      await page.locator("#play").click();
      await newFrames(page, 20);
      await pause();
    }

    const run = theirs.run as Json, numbers = theirs.numbers as Json;
    expect(Number(ours.run.world_steps)).toBe(run.world_steps);
    expect(Number(ours.run.plan_updates)).toBe(run.plan_updates);
    let compared = 0;
    for (const [name, text] of ours.numbers) {
      const there = numbers[name];
      if (there === null) {
        expect(text, name).toBe("–");
        continue;
      }
      // a page writes the digits that it shows, six in the table
      const digits = (text.split(".")[1] ?? "").length;
      expect(Math.abs(Number(text) - Number(there)), name).toBeLessThanOrEqual(Math.max(0.5001 * 10 ** -digits, 1e-5 * Math.abs(Number(there))));
      ++compared;
    }
    expect(new Set(ours.numbers.map(([name]) => name))).toEqual(new Set(kNumbers));
    expect(compared).toBeGreaterThan(25);
  });

  it("advance by one plan with Step, and stop without", async () => {
    const step = async () => {
      const before = await page.evaluate(() => window.prostm.frame!.run);
      await page.locator("#step").click();
      await until(page, (n) => window.prostm.frame!.run.planUpdates > n, before.planUpdates, "a step");
      const after = await page.evaluate(() => window.prostm.frame!.run);
      expect(after.planUpdates).toBe(before.planUpdates + 1);
      expect(after.paused).toBe(true);
      return { worldSteps: after.worldSteps - before.worldSteps, time: after.time - before.time };
    };
    for (let i = 0; i < 3; ++i) {
      const made = await step();
      expect(made.worldSteps).toBe(2);
      expect(made.time).toBeCloseTo(0.04, 6);
    }
    const still = await page.evaluate(() => window.prostm.frame!.run.time);
    await newFrames();
    expect(await page.evaluate(() => window.prostm.frame!.run.time)).toBe(still);
  });

  it("follow the position in the recording", async () => {
    const scrub = page.locator("#scrub");
    await scrub.focus();
    for (const [key, place] of [["Home", 0], ["End", 6]] as const) {
      await scrub.press(key);
      await until(page, (p) => Math.abs((window.prostm.frame?.run.recordingTime ?? NaN) - p) < 0.1, place, `the recording at ${place} s`);
    }
    await scrub.fill("2.5");
    await until(page, () => Math.abs((window.prostm.frame?.run.recordingTime ?? NaN) - 2.5) < 0.1, 0, "the recording at 2.5 s");
    await page.locator("#play").click();
    await until(page, () => window.prostm.state?.transport.playing === true && (window.prostm.frame?.run.recordingTime ?? 0) > 2.7, 0, "the recording goes on");
  });
});

describe("controls", () => {
  it("each send the value shown to the program, which answers", async () => {
    const controls = await page.evaluate(() => window.prostm.state!.controls);
    expect(controls.length).toBeGreaterThan(8);
    for (const control of controls.filter((c) => c.enabled && c.id !== "source")) {
      const now = control.kind === "choice" ? control.choices.find((c) => c.value !== control.value)?.value
        : control.kind === "switch" ? !control.value
        : control.value + control.step <= control.max ? Number((control.value + control.step).toFixed(6)) : Number((control.value - control.step).toFixed(6));
      if (now === undefined) continue;
      await turn(control.id, now);
      const shown = await page.locator(`[data-control="${control.id}"]`).getAttribute("data-value");
      if (typeof now === "number") expect(Number(shown)).toBeCloseTo(now, 9);
      else expect(shown).toBe(String(now));
      await turn(control.id, control.value);
    }
  }, 300_000);

  it("explain rejected values", async () => {
    const speed = await value("speed");
    await page.locator('[data-control="speed"] input[type=number]').fill("9999");
    await page.locator('[data-control="speed"] input[type=number]').press("Enter");
    await until(page, () => (document.querySelector('[data-control="speed"] .error')?.textContent ?? "").includes("between"), 0, "a sentence beside the control");
    expect(await value("speed")).toBe(speed);
    // the box shows the value in force again
    expect(await page.locator('[data-control="speed"] input[type=number]').inputValue()).toBe(String(speed));
    expect(await page.locator('[data-control="speed"] input[type=range]').inputValue()).toBe(String(speed));
    await turn("speed", Number(speed) - 1);
    expect(await page.locator('[data-control="speed"] .error').textContent()).toBe("");
    await turn("speed", Number(speed));
  });

  it("restore the value in force when their box is emptied, and report it", async () => {
    const box = page.locator('[data-control="paths"] input[type=number]');
    await box.fill("");
    await box.press("Enter");
    await until(page, () => (document.querySelector('[data-control="paths"] .error')?.textContent ?? "").includes("Give a number from 1 to 8"), 0, "a sentence beside the control");
    expect(await box.inputValue()).toBe("4");
    await turn("paths", 3);
    await turn("paths", 4);
  });

  const planHas = (count: number, kind: "path" | "focus") =>
    until(page, ({ count, kind }) => window.prostm.frame!.plan.length === count && window.prostm.frame!.plan.every((p) => p.kind === kind), { count, kind }, `${count} of kind ${kind}`);

  it("change the number of paths in the plan", async () => {
    await planHas(4, "path");
    await turn("paths", 2);
    await planHas(2, "path");
    await turn("paths", 4);
    await planHas(4, "path");
  });
  it("change the method, and its frequency", async () => {
    await turn("method", "am");
    await planHas(4, "focus");
    await turn("am_frequency", 100);
    await until(page, () => window.prostm.frame!.plan.every((p) => Math.abs(p.period - 0.01) < 1e-4), 0, "a period of 10 ms");
    await turn("am_frequency", 200);
    await turn("method", "pro-stm");
    await planHas(4, "path");
  });
  it("bring the paths in step with preset felt", async () => {
    const inStep = (wanted: boolean) =>
      until(page, (w) => window.prostm.frame!.plan.length > 0 && window.prostm.frame!.plan.every((p) => p.loop > 0 === w), wanted, `paths in step: ${wanted}`);
    const works = (id: string) => page.evaluate((i) => window.prostm.state!.controls.find((c) => c.id === i)!.enabled, id);
    await inStep(false);
    expect([await works("strength_weight"), await works("am_felt_weight")]).toEqual([false, false]);
    await turn("preset", "felt");
    await inStep(true);
    expect([await works("strength_weight"), await works("am_felt_weight")]).toEqual([true, false]);
    await turn("preset", "best");
    await inStep(false);
  });
  it("delay foci with the felt weight", async () => {
    await turn("method", "am");
    await turn("am_felt_weight", 0.9);
    await until(page, () => window.prostm.frame!.plan.some((p) => p.kind === "focus" && p.phase > 0), 0, "foci with phases");
    await turn("am_felt_weight", 0);
    await until(page, () => window.prostm.frame!.plan.length > 0 && window.prostm.frame!.plan.every((p) => p.phase === 0), 0, "foci in phase");
    await turn("method", "pro-stm");
    await planHas(4, "path");
  });
  it("change the speed of the focal points", async () => {
    await turn("speed", 4);
    await until(page, () => window.prostm.frame!.plan.length > 0 && window.prostm.frame!.plan.every((p) => Math.abs(p.speed - 4) < 0.01), 0, "paths at 4 m/s");
    await turn("speed", 7);
    await until(page, () => window.prostm.frame!.plan.some((p) => Math.abs(p.speed - 7) < 0.01), 0, "paths at 7 m/s");
  });
  it("change the width used for planning: with a wide one all of the target lies near a path", async () => {
    const sigma = Number(await value("sigma"));
    await turn("sigma", 20);
    await until(page, () => (window.prostm.frame!.numbers[19] ?? 0) > 0.97, 0, "coverage near 1");
    await turn("sigma", sigma);
  });
  it("change the gain: the same field from paths with more pressure", async () => {
    const ratio = () => page.evaluate(() => {
      const frame = window.prostm.frame!;
      return Math.max(0, ...frame.plan.flatMap((p) => Array.from({ length: p.count }, (_, i) => p.points[6 * i + 2]!))) / (frame.numbers[24] || 1);
    });
    await turn("gain", 0.5);
    await newFrames(page, 20);
    const low = await ratio();
    await turn("gain", 3);
    await expect.poll(ratio, kSoon).toBeGreaterThan(2.5 * low);
    await turn("gain", 1);
  });
  it("change the scene with its full scale", async () => {
    const scale = () => page.evaluate(() => window.prostm.frame!.numbers[25]!);
    await newFrames(page, 3);
    const thin = await scale();
    await turn("scene", "two-plumes");
    await expect.poll(scale, kSoon).not.toBeCloseTo(thin, 3);
    await turn("scene", "four-plumes");
    await expect.poll(scale, kSoon).toBeCloseTo(thin, 3);
  });
  it("suggest a coarser grid if it is too fine for the machine", async () => {
    await turn("scene", "ring"); // without a stimulus every coarser grid is allowed
    await turn("grid", 160);
    await page.locator("#turn-down").waitFor({ timeout: 30000 });
    expect(await page.locator("#rates").textContent()).toMatch(/^Rates not held: smoke .* of 50 Hz/);
    expect(await page.locator("#turn-down").textContent()).toMatch(/^Turn the smoke's grid down to \d+ cells$/);
    await page.locator("#turn-down").click();
    const grid = () => page.evaluate(() => window.prostm.state!.controls.find((c) => c.id === "grid")!.value as number);
    await expect.poll(grid, kSoon).toBeLessThan(160);
    await turn("grid", 32);
    await expect.poll(() => page.locator("#missed").isHidden(), { timeout: 30000 }).toBe(true);
    await turn("scene", "four-plumes");
  });
  it("change the jets: without them the pressure disappears", async () => {
    const pressure = () => page.evaluate(() => window.prostm.frame!.numbers[24]!);
    let before = 0;
    await expect.poll(async () => (before = await pressure()), kSoon).toBeGreaterThan(0.07);
    await turn("jet_speed", 0);
    await expect.poll(pressure, kSoon).toBeLessThan(0.5 * before);
    await turn("jet_speed", 1);
  });
  it("change the field on the skin and the speed of focal points, in the page alone", async () => {
    for (const mode of ["target", "difference", "none", "rendered"]) {
      await page.locator(`label[for="skin-${mode}"]`).click();
      expect(await page.locator(`#skin-${mode}`).isChecked()).toBe(true);
    }
    await page.locator("#slow-motion").focus();
    await page.keyboard.press("Home");
    expect(await page.locator("#slow-motion-value").textContent()).toBe("1/1");
    await page.keyboard.press("End");
    expect(await page.locator("#slow-motion-value").textContent()).toBe("1/100");
  });
});

describe("the page's hand", () => {
  const palm = () => page.evaluate(() => [...window.prostm.frame!.hands[0]!.joints.subarray(0, 3)].map((v) => 1000 * v));
  const near = (wanted: number[], what: string) =>
    until(page, (w) => {
      const hand = window.prostm.frame!.hands[0];
      return window.prostm.frame!.run.pageHand && hand !== undefined && w.every((v, i) => Math.abs(1000 * hand.joints[i]! - v) < 1.5);
    }, wanted, what);

  it("replaces the source, follows keys, and is released", async () => {
    await page.locator("#page-hand").check();
    await near([0, 0, 190], "the hand in the middle");
    expect(await page.evaluate(() => document.activeElement?.id)).toBe("view");
    for (let i = 0; i < 6; ++i) await page.keyboard.press("ArrowRight");
    for (let i = 0; i < 4; ++i) await page.keyboard.press("ArrowUp");
    for (let i = 0; i < 3; ++i) await page.keyboard.press("PageDown");
    await near([30, 20, 175], "the hand where the keys sent it");
    await page.keyboard.press("l");
    await until(page, () => window.prostm.frame!.hands[0]?.side === "left", 0, "a left hand");
    await page.keyboard.press("l");
    await page.keyboard.press("Escape");
    await until(page, () => window.prostm.frame!.run.pageHand === false && window.prostm.state!.transport.source !== "page", 0, "the hand lets go");
    expect(await page.locator("#page-hand").isChecked()).toBe(false);
  });

  it("follows the mouse, and the wheel for height", async () => {
    await page.locator("#page-hand").check();
    await until(page, () => window.prostm.frame!.run.pageHand, 0, "the page's hand");
    await near([30, 20, 175], "the hand where it was left");
    const box = (await page.locator("#view").boundingBox())!;
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 - 60, box.y + box.height / 2, { steps: 6 });
    await page.mouse.up();
    await until(page, () => window.prostm.frame!.hands[0]!.joints[0]! < 0.015, 0, "the hand further to the left");
    const height = (await palm())[2]!;
    await page.mouse.wheel(0, -240);
    await until(page, (h) => 1000 * window.prostm.frame!.hands[0]!.joints[2]! > h + 4, height, "the hand higher up");
    await page.locator("#page-hand").uncheck();
    await until(page, () => !window.prostm.frame!.run.pageHand, 0, "the hand lets go");
  });
});

describe("two pages", () => {
  it("both get frames, and see each other's changes", async () => {
    const other = await browser.newPage({ viewport: { width: 1280, height: 720 }, colorScheme: "dark" });
    const seen = new Watch(other);
    await other.goto(program.address + kHash);
    await until(other, () => (window.prostm?.frames ?? 0) > 2, 0, "frames in the other page");
    await turn("paths", 3);
    await until(other, () => window.prostm.state?.controls.find((c) => c.id === "paths")?.value === 3 && window.prostm.frame?.plan.length === 3, 0, "three paths in the other page");
    const before = await frameCount();
    await newFrames(other, 5);
    expect(await frameCount()).toBeGreaterThan(before);
    await turn("paths", 4);

    // the hand passes from page to page, and the page that loses it is notified
    await page.locator("#page-hand").check();
    await until(other, () => document.getElementById("source")!.textContent === "hand from another page", 0, "the other page's hand");
    await expect.poll(() => page.locator("#source").textContent(), kSoon).toBe("hand from this page");
    await other.locator("#page-hand").check();
    await until(page, () => document.getElementById("source")!.textContent === "hand from another page", 0, "the hand taken away");
    await expect.poll(() => page.locator("#page-hand").isChecked(), kSoon).toBe(false);
    await expect.poll(() => page.locator("#notice").textContent(), kSoon).toMatch(/another page has the hand/i);
    await expect.poll(() => other.locator("#source").textContent(), kSoon).toBe("hand from this page");
    await other.locator("#page-hand").uncheck();
    await until(page, () => !window.prostm.frame!.run.pageHand, 0, "the hand lets go");
    expect(seen.complaints).toEqual([]);
    await other.close();
  });
});

describe("a page with a slow connection", () => {
  it("keeps a value just set when an earlier state arrives", async () => {
    const far = await browser.newPage({ viewport: { width: 1280, height: 720 } });
    let state = "", delayed = 0;
    await far.routeWebSocket(/.*/, (socket) => {
      const server = socket.connectToServer();
      server.onMessage((message) => {
        if (typeof message === "string" && JSON.parse(message).type === "state") state = message;
        socket.send(message);
      });
      socket.onMessage((message) => {
        if (JSON.parse(String(message)).type !== "set") return server.send(message);
        ++delayed;
        socket.send(state);
        setTimeout(() => server.send(message), 200);
      });
    });
    await far.goto(program.address + kHash);
    await until(far, () => (window.prostm?.frames ?? 0) > 2, 0, "frames in the page");
    const box = far.locator('[data-control="array_width"] input');
    const before = await box.isChecked();
    for (const to of [!before, before]) {
      await box.click();
      for (let i = 0; i < 20; ++i) expect(await box.isChecked()).toBe(to);
      await becomes("array_width", to);
    }
    expect(delayed).toBe(2);
    await far.close();
  });
});

describe("looks", () => {
  /// Contrast by WCAG 2.2 between two colours of the page.
  const contrast = (front: string, back: string) => page.evaluate(([f, b]) => {
    const context = document.createElement("canvas").getContext("2d", { willReadFrequently: true })!;
    const luminance = (name: string) => {
      context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
      context.fillRect(0, 0, 1, 1);
      const [r, g, bl] = [...context.getImageData(0, 0, 1, 1).data].map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4));
      return 0.2126 * r! + 0.7152 * g! + 0.0722 * bl!;
    };
    const [x, y] = [luminance(f!), luminance(b!)].sort((p, q) => q - p);
    return (x! + 0.05) / (y! + 0.05);
  }, [front, back]);

  it.each(["dark", "light"])("have contrast enough for reading when %s", async (theme) => {
    await page.locator("#theme").selectOption(theme);
    expect(await page.evaluate(() => window.prostm.dark)).toBe(theme === "dark");
    for (const [front, back] of [["--ink", "--ground"], ["--ink", "--card"], ["--ink", "--raised"], ["--faint", "--card"], ["--faint", "--ground"], ["--on-accent", "--accent"], ["--bad", "--card"]] as const) {
      expect(await contrast(front, back), `${front} on ${back}`).toBeGreaterThanOrEqual(4.5);
    }
    for (const [front, back] of [["--edge", "--card"], ["--focus", "--card"], ["--accent", "--card"]] as const) {
      expect(await contrast(front, back), `${front} on ${back}`).toBeGreaterThanOrEqual(3);
    }
  });

  it("can have large type", async () => {
    await page.locator("#large-type").check();
    expect(await page.evaluate(() => parseFloat(getComputedStyle(document.documentElement).fontSize))).toBeGreaterThanOrEqual(18);
    await page.locator("#large-type").uncheck();
  });

  it("make everything reachable by keyboard, with visible focus", async () => {
    const wanted = await page.evaluate(() => {
      const shown = (e: HTMLElement) => e.checkVisibility() && !(e as HTMLInputElement).disabled;
      const all = [...document.querySelectorAll<HTMLElement>("button, select, summary, canvas[tabindex], input:not([type=radio])")].filter(shown).map((e) => e.id || e.outerHTML.slice(0, 80));
      const groups = [...document.querySelectorAll<HTMLInputElement>("input[type=radio]:checked")].filter(shown).map((e) => e.id);
      return [...all, ...groups];
    });
    await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
    const reached = new Set<string>();
    for (let i = 0; i < wanted.length + 20; ++i) {
      await page.keyboard.press("Tab");
      const here = await page.evaluate(() => {
        const e = document.activeElement as HTMLElement;
        const marked = (e as HTMLInputElement).type === "radio" ? (e.nextElementSibling as HTMLElement) : e;
        return { name: e.id || e.outerHTML.slice(0, 80), outline: parseFloat(getComputedStyle(marked).outlineWidth), tag: e.tagName };
      });
      if (here.tag === "BODY") continue;
      if (wanted.includes(here.name)) expect(here.outline, here.name).toBeGreaterThanOrEqual(2);
      reached.add(here.name);
    }
    expect(wanted.filter((name) => !reached.has(name))).toEqual([]);
    const unnamed = await page.evaluate(() => [...document.querySelectorAll<HTMLElement>("button, select, input, canvas:not([aria-hidden])")]
      .filter((e) => !(e.getAttribute("aria-label") || e.textContent?.trim() || (e as HTMLInputElement).labels?.length || e.closest(".strip")))
      .map((e) => e.outerHTML.slice(0, 80)));
    expect(unnamed).toEqual([]);
  });
});

describe("screenshots of the page", () => {
  it("have their texts in place, including those of the strips", async () => {
    const texts = await page.evaluate(() => {
      const drawn: { text: string; left: number; right: number; y: number }[] = [];
      const whole = CanvasRenderingContext2D.prototype.fillText;
      CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
        if (!this.canvas.isConnected) drawn.push({ text, left: x, right: x + this.measureText(text).width, y });
        whole.call(this, text, x, y);
      };
      document.getElementById("screenshot")!.click();
      CanvasRenderingContext2D.prototype.fillText = whole;
      return drawn;
    });
    for (const word of ["Reconstruction", "Stages", "fluid", "lift", "RMSE"]) expect(texts.map((t) => t.text)).toContain(word);
    const over = texts.flatMap((a, i) => texts.slice(i + 1)
      .filter((b) => Math.abs(a.y - b.y) < 8 && a.left < b.right - 1 && b.left < a.right - 1).map((b) => `${a.text} over ${b.text}`));
    expect(over).toEqual([]);
  });
  it("can be taken as PNG", async () => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#screenshot").click()]);
    const file = await download.path();
    expect(readFileSync(file).subarray(1, 4).toString()).toBe("PNG");
    expect(statSync(file).size).toBeGreaterThan(50_000);
  });
  it("can be recorded as films, if the browser can", async () => {
    const film = page.locator("#film");
    if (await film.isDisabled()) {
      expect(await page.locator('[aria-label="About Record"]').count()).toBe(1);
      return;
    }
    await film.click();
    const drawn = await page.evaluate(() => window.prostm.pictures);
    await until(page, (n) => window.prostm.pictures > n + 5, drawn, "pictures to film");
    const [download] = await Promise.all([page.waitForEvent("download"), film.click()]);
    expect(readFileSync(await download.path()).subarray(0, 4).toString("hex")).toBe("1a45dfa3");
  });
});

describe("during all tests", () => {
  it("the page contacted no other host, read every frame, and reported no errors", async () => {
    expect(watch.requests.length).toBeGreaterThan(3);
    for (const address of watch.requests.filter((a) => !a.startsWith("blob:"))) expect(new URL(address).host).toBe(new URL(program.address).host);
    expect(await page.evaluate(() => window.prostm.refused)).toBe(0);
    expect(watch.complaints).toEqual([]);
  });
});

describe("a program that dies under an open page", () => {
  it("is reported, and reconnected when it is back", async () => {
    const { port } = program;
    await program.stop();
    await until(page, () => document.documentElement.dataset.link === "lost" && (document.getElementById("link")?.textContent ?? "").includes("does not answer"), 0, "a sentence that it is gone");
    for (const control of ["#mute", "#play", "#control-paths", "#page-hand"]) expect(await page.locator(control).isDisabled(), control).toBe(true);
    expect(await page.locator(".lost-sign").isVisible()).toBe(true);
    expect(await page.locator("#verdict-word").textContent()).toBe("Not connected");
    await program.start(port);
    const before = await frameCount();
    await until(page, (n) => document.documentElement.dataset.link === "open" && window.prostm.frames > n + 2 && window.prostm.connections >= 2, before, "frames of the new program");
    expect(await page.locator("#link").textContent()).toBe("");
    for (const control of ["#mute", "#play", "#control-paths", "#page-hand"]) expect(await page.locator(control).isDisabled(), control).toBe(false);
    expect(await page.locator(".lost-sign").isVisible()).toBe(false);
  });
});
