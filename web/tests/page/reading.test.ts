import { readFileSync } from "node:fs";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import "../../src/inspection";
import { kNumbers } from "../../src/wire";
import { clean, openBrowser, Program, until, Watch } from "./program";

// no hand except the page's, which a test switches on
const program = new Program(["--grid", "32", "--scene", "four-plumes", "--hand", "page", "--seconds", "3600"]);
let browser: Browser, page: Page, watch: Watch;

beforeAll(async () => {
  browser = await openBrowser();
  await program.start();
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, permissions: ["clipboard-read", "clipboard-write"] });
  page = await context.newPage();
  watch = new Watch(page);
  await page.goto(`${program.address}/#folded=Numbers&picture=on`);
  await until(page, () => (window.prostm?.frames ?? 0) > 3 && window.prostm.pictures > 1, 0, "frames and pictures");
});
afterAll(async () => {
  await browser?.close();
  await program.stop();
  clean();
});

const text = (id: string) => page.locator(`#${id}`).textContent();
const says = (id: string, words: string) =>
  until(page, ({ id, words }) => (document.getElementById(id)?.textContent ?? "").includes(words), { id, words }, `#${id} says ${words}`);

describe("a page without a hand", () => {
  it("reports it over the picture and the planes, and has no latency", async () => {
    await page.locator("#no-hand").waitFor();
    expect(await text("no-hand-advice")).toContain("Use my mouse as the hand");
    expect(await page.locator("#no-hand-planes").isVisible()).toBe(true);
    // the sign lets the pointer through to the picture
    const under = await page.locator("#no-hand").evaluate((sign) => {
      const { left, top, width, height } = sign.getBoundingClientRect();
      return document.elementFromPoint(left + width / 2, top + height / 2)?.id;
    });
    expect(under).toBe("view");
    expect(await page.locator('#tiles [data-number="latency_p50_ms"]').textContent()).toBe("–");
    expect(await text("verdict-word")).toBe("Not playing");
    expect(await text("verdict-why")).toMatch(/^no hand in sight\. .*Use my mouse as the hand/);
  });
});

describe("explanations", () => {
  const shown = () => page.locator("#tip");
  it("are not native tooltips, which touch screens do not show", async () => {
    expect(await page.locator("[title]").count()).toBe(0);
    const controls = await page.evaluate(() => window.prostm.state!.controls.map((c) => c.label));
    const tips = await page.locator(".tip").evaluateAll((all) => all.map((e) => e.getAttribute("aria-label")));
    for (const name of [...controls, "Felt shape", "Felt strength", "Spill", "Lock"]) expect(tips).toContain(`About ${name}`);
  });
  it("open and close with the keyboard, and are read out", async () => {
    const button = page.locator('#verdict [aria-label="About Felt strength"]');
    await button.focus();
    await page.keyboard.press("Enter");
    expect(await shown().textContent()).toMatch(/threshold of touch/);
    expect(await shown().getAttribute("role")).toBe("status");
    expect(await button.getAttribute("aria-expanded")).toBe("true");
    expect(await button.getAttribute("aria-describedby")).toBe("tip");
    await page.keyboard.press("Escape");
    expect(await shown().isHidden()).toBe(true);
    expect(await button.getAttribute("aria-expanded")).toBe("false");
    await page.keyboard.press("Space");
    expect(await shown().isVisible()).toBe(true);
    await page.keyboard.press("Tab");
    expect(await shown().isHidden()).toBe(true);
    expect(await page.evaluate(() => window.prostm.state?.transport.playing)).toBe(true);
  });
  it("open under the mouse, within the window", async () => {
    const button = page.locator('[data-control="speed"] .tip');
    await button.hover();
    expect(await shown().textContent()).toBe(await page.evaluate(() => window.prostm.state!.controls.find((c) => c.id === "speed")!.help));
    const box = (await shown().boundingBox())!, window_ = page.viewportSize()!;
    expect(Math.min(box.x, box.y, window_.width - box.x - box.width, window_.height - box.y - box.height)).toBeGreaterThanOrEqual(0);
    await page.mouse.move(5, 5);
    expect(await shown().isHidden()).toBe(true);
  });
});

describe("the verdict", () => {
  it("is all that is shown of the numbers until they are unfolded, and the address keeps that", async () => {
    const other = await browser.newPage({ viewport: { width: 1440, height: 900 } });
    await other.goto(`${program.address}/#picture=off`);
    await until(other, () => (window.prostm?.frames ?? 0) > 1 && document.querySelector('[data-fold="Plan"]') !== null, 0, "frames and controls");
    expect(await other.locator("#verdict").isVisible()).toBe(true);
    expect(await other.locator("#tiles").isVisible()).toBe(false);
    await other.locator('[data-fold="Numbers"] > summary').click();
    expect(await other.locator("#tiles").isVisible()).toBe(true);
    const folded = () => other.evaluate(() => new URLSearchParams(location.hash.slice(1)).get("folded"));
    await expect.poll(folded).not.toBeNull();
    expect(await folded()).not.toContain("Numbers");
    await other.reload();
    await other.locator("#tiles").waitFor();
    await other.close();
  });
});

describe("a page with a hand", () => {
  beforeAll(async () => {
    await page.locator("#page-hand").check();
    await until(page, () => (window.prostm.frame?.plan.length ?? 0) > 0 && window.prostm.frame!.numbers[24]! > 0.06, 0, "pressure on the page's hand");
  });

  it("names the items drawn", async () => {
    const names = async () => (await page.locator("#things li:visible").allTextContents()).join("; ");
    await expect.poll(names).toMatch(/array.*box of the smoke, 360 mm wide.*hand, 1\d\d mm long.*reconstruction on the skin.*path.*focal point.*height.*under the palm/);
    await page.locator('label[for="skin-difference"]').click();
    await expect.poll(names).toContain("reconstruction less target");
    await page.locator('label[for="skin-rendered"]').click();
    const labels = () => page.locator("#labels span:visible").allTextContents();
    await expect.poll(labels).toContain("100");
    await expect.poll(labels).toContain("palm 190 mm");
  });

  it("explains why the hand does not receive the scene's stimulus", async () => {
    await page.locator("#view").focus();
    for (let i = 0; i < 40; ++i) await page.keyboard.press("c");
    await says("verdict-why", "Stretch the fingers");
    for (let i = 0; i < 60; ++i) await page.keyboard.press("o");
    await until(page, () => !document.getElementById("verdict-why")!.textContent!.includes("Stretch"), 0, "stretched fingers");
  });

  it("states how well and how strongly the target is felt", async () => {
    await until(page, () => Number.isFinite(window.prostm.frame!.numbers[34]) && Number.isFinite(window.prostm.frame!.numbers[38]), 0, "a percept");
    await expect.poll(() => text("felt-shape"), { timeout: 30_000 }).toMatch(/^-?\d\.\d\d$/);
    expect(await text("felt-strength")).toMatch(/^\d+ dB (below|above) the threshold of touch$/);
    expect(await text("felt-strength-words")).toMatch(/^−?\d+ to −?\d+ dB: .* feels? it/);
  });

  it("mutes the array with its button and with M", async () => {
    await says("verdict-word", "Playing");
    await page.locator("#mute").click();
    await says("verdict-why", "muted by you or another page");
    expect(await text("verdict-word")).toBe("Not playing");
    await expect.poll(async () => (await program.numbers() as { numbers: { intensity: number } }).numbers.intensity).toBe(0);
    expect(await page.locator("#mute").getAttribute("aria-pressed")).toBe("true");
    await page.locator("#view").focus();
    await page.keyboard.press("m");
    await until(page, () => document.getElementById("verdict-word")!.textContent === "Playing", 0, "the array plays");
    await expect.poll(async () => (await program.numbers() as { numbers: { intensity: number } }).numbers.intensity).toBeGreaterThan(0);
  });

  it("shows the pressure under the pointer, in the planes and on the skin", async () => {
    await expect.poll(async () => { // the layout may change while the page starts
      const box = (await page.locator('canvas[data-kind="rendered"]').boundingBox())!;
      await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
      return text("hover");
    }, { timeout: 30_000 }).toContain("Pa");
    expect(await text("hover")).toMatch(/^target \d+(\.\d+)? Pa\nreconstruction \d+(\.\d+)? Pa\ndifference [−+]\d+(\.\d+)? Pa\nx −?\d+, y −?\d+ mm, [12]\d\d mm over the array$/);
    // seen from below, the palm is in the middle
    await page.locator('[data-view="below"]').click();
    await page.waitForTimeout(1500);
    const view = (await page.locator("#view").boundingBox())!;
    const seen = async () => {
      for (const [dx, dy] of [[0, 0], [0, 30], [0, -30], [30, 0], [-30, 0], [0, 60]] as const) {
        await page.mouse.move(view.x + view.width / 2 + dx, view.y + view.height / 2 + dy);
        if (await page.locator("#hover").isVisible()) return text("hover");
      }
      return "";
    };
    await expect.poll(seen).toMatch(/^target .* Pa\nreconstruction .* Pa\ndifference .* Pa\nx −?\d+, y −?\d+ mm, 1\d\d mm over the array$/);
    await page.mouse.move(view.x + 5, view.y + view.height / 2);
    await expect.poll(() => page.locator("#hover").isHidden()).toBe(true);
    await page.locator('[data-view="home"]').click();
  });

  it("locks the colour scale", async () => {
    const end = await text("lock-scale");
    expect(end).toMatch(/^Lock at [\d.]+ Pa$/);
    await page.locator("#lock-scale").click();
    const locked = (await text("lock-scale"))!;
    expect(locked).toMatch(/^Locked at [\d.]+ Pa$/);
    await expect.poll(() => page.evaluate(() => location.hash)).toContain("scale=");
    await page.locator("#lock-scale").click();
    expect(await text("lock-scale")).toMatch(/^Lock at/);
  });

  it("shows all values at the pointer's time, freezes, and zooms in time", async () => {
    await page.waitForTimeout(2000);
    const plot = (await page.locator('[data-strip="latency"] .u-over').boundingBox())!;
    await page.mouse.move(plot.x + plot.width * 0.98, plot.y + plot.height / 2);
    await says("strips-at", "s ago");
    expect(await text("strips-at")).toBe("values 0.6 s ago");
    await page.keyboard.press("f");
    expect(await page.locator("#freeze").getAttribute("aria-pressed")).toBe("true");
    await page.waitForTimeout(400);
    const readings = () => page.locator("#strips .legend b").allTextContents();
    const before = await readings();
    expect(before.filter((v) => v !== "–").length).toBeGreaterThan(8);
    await page.waitForTimeout(1500);
    expect(await readings()).toEqual(before);
    await page.locator("#freeze").click();
    await page.mouse.move(10, 10);
    expect(await text("strips-at")).toBe("");
    for (const span of [120, 10, 30]) {
      await page.locator(`label[for="span-${span}"]`).click();
      expect(await page.locator(`#span-${span}`).isChecked()).toBe(true);
    }
  });

  it("saves all values over time as CSV", async () => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#save-csv").click()]);
    expect(download.suggestedFilename()).toMatch(/^prostm-.*\.csv$/);
    const lines = readFileSync(await download.path(), "utf8").trimEnd().split("\r\n"), rows = lines.map((l) => l.split(","));
    expect(lines[0]).toMatch(/^run time \[s\],Stages: fluid \[ms\],.*,Felt strength: strongest place \[dB above the threshold of touch\],RMSE: RMSE \[of the largest target\]$/);
    expect(rows.length).toBeGreaterThan(100);
    for (const row of rows) expect(row.length).toBe(rows[0]!.length);
    const times = rows.slice(1).map((r) => Number(r[0]));
    times.forEach((t, i) => expect(t).toBeGreaterThan(times[i - 1] ?? -1));
    const now = await page.evaluate(() => window.prostm.frame!.run.time);
    expect(times[times.length - 1]).toBeLessThanOrEqual(now);
    expect(times[times.length - 1]).toBeGreaterThan(now - 3);
    const column = rows[0]!.indexOf("Rates: smoke [Hz]");
    expect(rows.slice(1).some((r) => Number(r[column]) > 5)).toBe(true);
  });

  it("looks back at earlier moments, clearly not live, and returns", async () => {
    await page.locator("#page-hand").uncheck();
    await expect.poll(() => page.locator("#rewind-at").isEnabled()).toBe(true);
    await page.locator("#numbers-group > summary").click();
    const runTime = () => page.evaluate(() => Number(document.querySelector('[data-run="time_s"]')!.textContent));
    const plane = () => page.evaluate(() => document.querySelector<HTMLCanvasElement>('canvas[data-kind="rendered"]')!.toDataURL());
    await page.locator("#rewind-at").focus();
    for (let i = 0; i < 3; ++i) await page.keyboard.press("PageDown");
    await expect.poll(() => text("rewind-words")).toMatch(/^not live: \d+\.\d s ago, at \d+\.\d s of the run$/);
    for (const sign of await page.locator(".not-live").all()) expect(await sign.isVisible()).toBe(true);
    // the panels follow the words with their next drawing
    const moment = Number(/at ([\d.]+) s/.exec((await text("rewind-words"))!)![1]);
    await expect.poll(async () => Math.abs((await runTime()) - moment)).toBeLessThan(0.06);
    const seen = await runTime(), drawn = await plane();
    expect(await page.evaluate(() => window.prostm.frame!.run.time)).toBeGreaterThan(seen + 1);
    await page.waitForTimeout(1500);
    expect(await runTime()).toBe(seen);
    expect(await plane()).toBe(drawn);
    // the verdict and the run time at Pause stay live
    expect(Math.abs(parseFloat((await text("time"))!) - await page.evaluate(() => window.prostm.frame!.run.time))).toBeLessThan(1);
    expect(await text("verdict-why")).toContain("no hand in sight");
    const readings = () => page.locator('[data-strip="latency"] .legend b').allTextContents();
    const before = await readings();
    await page.waitForTimeout(500);
    expect(await readings()).toEqual(before);
    await page.locator("#rewind-live").click();
    expect(await text("rewind-words")).toBe("live");
    await expect.poll(runTime).toBeGreaterThan(seen + 2);
    for (const sign of await page.locator(".not-live").all()) expect(await sign.isVisible()).toBe(false);
    // the page's hand needs the present
    await page.locator("#rewind-at").focus();
    await page.keyboard.press("PageDown");
    await page.locator("#page-hand").check();
    await expect.poll(() => text("rewind-words")).toBe("live");
    expect(await page.locator("#rewind-at").isDisabled()).toBe(true);
    await page.locator("#numbers-group > summary").click();
    const { frames, bytes } = await page.evaluate(() => window.prostm.past);
    expect(frames).toBeGreaterThan(10);
    expect(bytes).toBeLessThan(48 << 20);
  });

  it("shows its help on ?", async () => {
    await page.keyboard.press("?");
    expect(await page.locator("#help").isVisible()).toBe(true);
    await page.keyboard.press("Escape");
    expect(await page.locator("#help").isVisible()).toBe(false);
    await page.locator("#show-help").click();
    await page.locator("#close-help").click();
    expect(await page.locator("#help").isVisible()).toBe(false);
  });

  it("keeps the page's hand while Esc closes the help, and mutes from there", async () => {
    await page.keyboard.press("?");
    // the text does not take the focus: the page's body has it then
    await page.locator("#help p").click();
    await page.keyboard.press("m");
    await page.keyboard.press("Escape");
    expect(await page.locator("#help").isVisible()).toBe(false);
    expect(await page.locator("#page-hand").isChecked()).toBe(true);
    await page.waitForFunction(() => window.prostm.frame!.run.pageHand && window.prostm.frame!.run.muted);
    await page.keyboard.press("m");
    await page.waitForFunction(() => window.prostm.frame!.run.pageHand && !window.prostm.frame!.run.muted);
  });

  it("uses one word each for the target and the reconstruction", async () => {
    expect(await page.locator("#planes figcaption").allTextContents()).toEqual(["Target", "Reconstruction", "Difference"]);
    expect(await page.locator("#skin-field label").allTextContents()).toEqual(["Target", "Reconstruction", "Difference", "None"]);
    await expect.poll(() => page.locator("#legend b").textContent()).toBe("Reconstruction");
    expect(await page.locator("body").evaluate((body) => body.textContent)).not.toMatch(/rendered/i);
  });
});

/// Presses, moves and lifts a finger.
async function swipe(on: Page, x: number, y: number, by: number): Promise<void> {
  const session = await on.context().newCDPSession(on);
  const touch = (type: "touchStart" | "touchMove" | "touchEnd", dx: number) =>
    session.send("Input.dispatchTouchEvent", { type, touchPoints: type === "touchEnd" ? [] : [{ x: x + dx, y }] });
  await touch("touchStart", 0);
  for (let i = 1; i <= 4; ++i) await touch("touchMove", (by * i) / 4);
  await touch("touchEnd", by);
}

describe("a page that is touched", () => {
  let touched: Page, seen: Watch;
  beforeAll(async () => {
    const context = await browser.newContext({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
    touched = await context.newPage();
    seen = new Watch(touched);
    await touched.goto(`${program.address}/#picture=on`);
    await until(touched, () => (window.prostm?.frame?.hands.length ?? 0) > 0 && window.prostm.pictures > 1, 0, "a hand and pictures");
    await touched.locator('[data-view="below"]').tap();
    await touched.waitForTimeout(2500);
  });
  afterAll(() => touched.context().close());
  const note = () => touched.locator("#hover");
  /// Taps until a condition holds: on a busy machine a tap takes so long that the browser takes it for a long press.
  const tapUntil = (selector: string, holds: () => Promise<boolean>) => expect.poll(async () => {
    await touched.locator(selector).tap();
    for (let i = 0; i < 20; ++i, await touched.waitForTimeout(50)) if (await holds()) return true; // the click follows
    return false;
  }, { timeout: 30_000 }).toBe(true);
  /// Taps the palm, which is in the middle when seen from below.
  const tapped = async () => {
    const view = (await touched.locator("#view").boundingBox())!;
    const x = view.x + view.width / 2, middle = view.y + view.height / 2;
    for (const y of [middle, middle + 30, middle - 30, middle + 60]) {
      await touched.touchscreen.tap(x, y);
      if (await note().isVisible()) return { x, y };
    }
    return null;
  };
  /// The hand moves, so a tap may miss it.
  const tappedPalm = async () => {
    let at: { x: number; y: number } | null = null;
    await expect.poll(async () => (at = await tapped()), { timeout: 20_000 }).not.toBeNull();
    return at!;
  };

  it("shows the pressure at a tap on the hand, until the next touch", async () => {
    await tappedPalm();
    await touched.waitForTimeout(1000);
    expect(await note().textContent()).toMatch(/^target .* Pa\nreconstruction .* Pa\ndifference .* Pa\nx −?\d+, y −?\d+ mm, 1\d\d mm over the array$/);
    await touched.locator("h1").tap();
    expect(await note().isHidden()).toBe(true);
  });
  it("turns the view with a drag, without a note", async () => {
    const at: { x: number; y: number } = await tappedPalm();
    const before = await touched.evaluate(() => location.hash);
    await swipe(touched, at.x, at.y, 40);
    expect(await note().isHidden()).toBe(true);
    await expect.poll(() => touched.evaluate(() => location.hash)).not.toBe(before);
  });
  it("explains names at a tap, until the next one", async () => {
    const shown = touched.locator("#tip");
    await tapUntil('#verdict [aria-label="About Felt shape"]', async () => /model of the skin/.test((await shown.textContent())!));
    await tapUntil("h1", () => shown.isHidden());
    await tapUntil('[data-control="gain"] .tip', () => shown.isVisible());
    await tapUntil('[data-control="gain"] .tip', () => shown.isHidden());
    const small = await touched.locator(".tip:visible").evaluateAll((all) => all.filter((e) => e.getBoundingClientRect().width < 24 || e.getBoundingClientRect().height < 24).length);
    expect(small).toBe(0);
  });
  it("shows the values at a tap on a plane and on a strip", async () => {
    // the text of an earlier note remains while it is hidden
    await tapUntil('canvas[data-kind="target"]', () => note().isVisible());
    expect(await note().textContent()).toMatch(/^target .* mm over the array$/s);
    await touched.locator('[data-strip="quality"] .u-over').tap();
    expect(await note().isHidden()).toBe(true);
    await expect.poll(() => touched.locator("#strips-at").textContent()).toMatch(/^values \d+\.\d s ago$/);
  });
  it("reports no errors", () => expect(seen.complaints).toEqual([]));
});

/// Changes a number in a frame of the program (docs/reference/wire.md).
function withNumber(frame: Buffer, place: number, value: number): Buffer {
  const made = Buffer.from(frame);
  for (let at = 16; at + 8 <= made.length; at += 8 + 8 * Math.ceil(made.readUInt32LE(at + 4) / 8)) {
    if (made.readUInt16LE(at) === 2) made.writeFloatLE(value, at + 8 + 4 * place);
  }
  return made;
}

describe("a page that receives a negative quality", () => {
  it("marks it at the bottom of the strip", async () => {
    const other = await browser.newPage({ colorScheme: "light" });
    let skill = 0.3;
    await other.routeWebSocket(/live/, (socket) => {
      const server = socket.connectToServer();
      server.onMessage((m) => socket.send(typeof m === "string" ? m : withNumber(m, kNumbers.indexOf("skill_0"), skill)));
    });
    await other.goto(`${program.address}/#picture=off`);
    // pixels in the marks' colour below the axis's 0, where no line is drawn
    const marked = () => other.evaluate(() => {
      const canvas = document.querySelector<HTMLCanvasElement>('[data-strip="quality"] canvas')!, box = canvas.getBoundingClientRect();
      const plot = document.querySelector('[data-strip="quality"] .u-over')!.getBoundingClientRect(), ratio = canvas.width / box.width;
      const area = [plot.left - box.left, plot.bottom - box.top + 1, plot.width, 3].map((v) => Math.round(v * ratio)) as [number, number, number, number];
      const { data } = canvas.getContext("2d")!.getImageData(...area);
      return data.filter((v, i) => i % 4 === 0 && v > 120 && data[i + 1]! < 90 && data[i + 2]! < 60 && data[i + 3]! > 200).length;
    });
    const reading = other.locator('[data-strip="quality"] [data-series="shape by Eq. (1)"] b');
    await expect.poll(() => reading.textContent()).toBe("0.30");
    expect(await marked()).toBe(0);
    skill = -0.4;
    await expect.poll(() => reading.textContent()).toBe("-0.40");
    await expect.poll(marked).toBeGreaterThan(4);
    await other.close();
  });
});

describe("a page's state", () => {
  const set = async (id: string, value: number) => {
    const box = page.locator(`[data-control="${id}"] input[type=number]`);
    await box.fill(String(value));
    await box.press("Enter");
    await until(page, ({ id, value }) => window.prostm.state?.controls.find((c) => c.id === id)?.value === value, { id, value }, `${id} is ${value}`);
  };
  const clipboard = () => page.evaluate(() => navigator.clipboard.readText());

  it("is kept in its address, and confirmed before a link changes a run", async () => {
    await set("paths", 2);
    await page.locator('[data-view="side"]').click();
    await expect.poll(() => page.evaluate(() => location.hash)).toMatch(/set\.paths=2.*eye=90,3,780/);
    await page.locator("#copy-link").click();
    await says("notice", "copied");
    const link = await clipboard();
    await set("paths", 4);
    await expect.poll(() => page.evaluate(() => location.hash)).not.toContain("set.paths");

    const other = await browser.newPage();
    await other.goto(link);
    await other.locator("#asked").waitFor();
    expect(await other.locator("#asked span").textContent()).toBe("This link asks for: Paths 2.");
    expect(await page.evaluate(() => window.prostm.state?.controls.find((c) => c.id === "paths")?.value)).toBe(4);
    await other.locator("#asked-apply").click();
    await until(page, () => window.prostm.state?.controls.find((c) => c.id === "paths")?.value === 2, 0, "two paths");
    await other.close();
  });

  it("can be copied as a command line and as a settings file, and reset", async () => {
    await set("speed", 5);
    await page.locator("#copy-command").click();
    await says("notice", "Copied");
    expect(await clipboard()).toMatch(/^prostm run --view --scene four-plumes --grid 32 --method pro-stm --preset best --paths 2 --switch lap --hand page --settings prostm.toml$/);
    await page.locator("#copy-settings").click();
    await says("notice", "settings file is copied");
    expect(await clipboard()).toContain("[plan]\npaths = 2\nspeed = 5\n");
    await page.locator("#reset").click();
    await until(page, () => window.prostm.state!.controls.every((c) => c.value === c.default), 0, "everything as the run began");
    await expect.poll(() => page.evaluate(() => location.hash)).not.toContain("set.");
  });

  it("includes which groups are folded", async () => {
    await page.locator('[data-fold="Plan"] > summary').click();
    await expect.poll(() => page.evaluate(() => location.hash)).toMatch(/folded=[^&]*Plan/);
    await page.reload();
    await until(page, () => (window.prostm?.frames ?? 0) > 1 && document.querySelector('[data-fold="Plan"]') !== null, 0, "the page again");
    expect(await page.locator('[data-fold="Plan"]').getAttribute("open")).toBeNull();
    expect(await page.locator('[data-fold="Smoke"]').getAttribute("open")).not.toBeNull();
  });
});

describe("a page with the picture switched off", () => {
  it("shows only the planes, and says so", async () => {
    await page.locator("#picture-mode").selectOption("off");
    await page.locator("#no-picture").waitFor();
    const drawn = await page.evaluate(() => window.prostm.pictures), frames = await page.evaluate(() => window.prostm.frames);
    await until(page, (n) => window.prostm.frames > n + 5, frames, "frames");
    expect(await page.evaluate(() => window.prostm.pictures)).toBe(drawn);
    await page.locator("#draw-anyway").click();
    await until(page, (n) => window.prostm.pictures > n, drawn, "pictures again");
    expect(await page.locator("#no-picture").isHidden()).toBe(true);
  });
  it("reports no errors", () => expect(watch.complaints).toEqual([]));
});
