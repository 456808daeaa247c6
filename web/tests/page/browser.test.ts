/// Browsers take a page's graphics context away, hide the page, and come with many kinds of keyboards and wheels.

import { statSync } from "node:fs";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import "../../src/inspection";
import { clean, openBrowser, Program, until, Watch, type Json } from "./program";

const program = new Program(["--grid", "32", "--hand", "page", "--seconds", "3600"]);
let browser: Browser;
const kHash = "/#folded=&picture=on";
const kSoon = { timeout: 30_000, interval: 50 };

beforeAll(async () => {
  browser = await openBrowser();
  await program.start();
});
afterAll(async () => {
  await browser?.close();
  await program.stop();
  clean();
});

/// Opens a page and waits for frames. @param prepare runs in it before its own scripts.
async function open(prepare?: () => void): Promise<Page> {
  const page = await browser.newPage({ viewport: { width: 1100, height: 700 }, colorScheme: "light" });
  if (prepare !== undefined) await page.addInitScript(prepare);
  await page.goto(program.address + kHash);
  await until(page, () => (window.prostm?.frames ?? 0) > 2 && window.prostm.state !== null, 0, "frames and a state");
  return page;
}
async function newPictures(page: Page, count = 3): Promise<void> {
  const drawn = await page.evaluate(() => window.prostm.pictures);
  await until(page, (n) => window.prostm.pictures >= n, drawn + count, "new pictures");
}

interface Losable extends Window { losing: WEBGL_lose_context }
const lose = (page: Page) => page.evaluate(() => {
  const gl = document.querySelector<HTMLCanvasElement>("#view")!.getContext("webgl2")!;
  (window as unknown as Losable).losing = gl.getExtension("WEBGL_lose_context")!;
  (window as unknown as Losable).losing.loseContext();
});
const restore = (page: Page) => page.evaluate(() => (window as unknown as Losable).losing.restoreContext());
const sign = (page: Page, words: RegExp) => expect.poll(async () => {
  const shown = await page.locator("#no-picture").isVisible();
  return shown ? page.locator("#no-picture").textContent() : "no sign";
}, kSoon).toMatch(words);

/// Number of colours in the newest picture.
const colours = (page: Page) => page.evaluate(() => new Promise<number>((resolve) => {
  const small = document.createElement("canvas");
  [small.width, small.height] = [160, 120];
  const context = small.getContext("2d", { willReadFrequently: true })!;
  const drawn = window.prostm.pictures;
  const wait = () => {
    if (window.prostm.pictures === drawn) return void requestAnimationFrame(wait);
    context.drawImage(document.querySelector<HTMLCanvasElement>("#view")!, 0, 0, 160, 120);
    resolve(new Set(new Uint32Array(context.getImageData(0, 0, 160, 120).data.buffer)).size);
  };
  requestAnimationFrame(wait);
}));

/// Messages of the browser about WebGL, and errors of any kind.
function graphicsComplaints(page: Page): string[] {
  const said: string[] = [];
  page.on("console", (message) => /webgl|context/i.test(message.text()) && !/ReadPixels/.test(message.text()) && said.push(message.text()));
  page.on("pageerror", (error) => said.push(String(error)));
  return said;
}

describe("a picture whose graphics context is taken away", () => {
  it("reports the loss and recovers with the context, any number of times", async () => {
    const page = await open();
    const said = graphicsComplaints(page);
    await newPictures(page);
    const before = await colours(page);
    for (const theme of ["dark", "light"]) {
      await lose(page);
      await sign(page, /^Side view, .*graphics context/);
      expect(await page.locator("#draw-anyway").isVisible()).toBe(false);
      const { pictures, frames } = await page.evaluate(() => ({ pictures: window.prostm.pictures, frames: window.prostm.frames }));
      await page.locator("#theme").selectOption(theme);
      await page.setViewportSize({ width: theme === "dark" ? 900 : 1100, height: 700 });
      await until(page, (n) => window.prostm.frames > n + 5, frames, "frames without a picture");
      expect(await page.evaluate(() => window.prostm.pictures)).toBe(pictures);
      await restore(page);
      await newPictures(page, 6);
      expect(await page.locator("#no-picture").isVisible()).toBe(false);
    }
    expect(await colours(page)).toBeGreaterThan(0.5 * before);
    expect(said).toEqual([]);
    await page.close();
  });

  it("recovers even if the loss comes first", async () => {
    const page = await open(() => {
      const whole = HTMLCanvasElement.prototype.getContext as (this: HTMLCanvasElement, kind: string, options?: unknown) => RenderingContext | null;
      HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, kind: string, options?: unknown) {
        const context = whole.call(this, kind, options);
        const w = window as unknown as Losable;
        if (kind !== "webgl2" || w.losing !== undefined) return context;
        w.losing = (context as WebGL2RenderingContext).getExtension("WEBGL_lose_context")!;
        w.losing.loseContext(); // before anything is drawn
        return context;
      } as typeof HTMLCanvasElement.prototype.getContext;
    });
    const said = graphicsComplaints(page);
    await sign(page, /graphics context/);
    await restore(page);
    await newPictures(page);
    expect(await colours(page)).toBeGreaterThan(100);
    expect(said).toEqual([]);
    await page.close();
  });

  it("is off without a context, and can be started later", async () => {
    const page = await open(() => {
      const whole = HTMLCanvasElement.prototype.getContext as (this: HTMLCanvasElement, kind: string, options?: unknown) => RenderingContext | null;
      HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, kind: string, options?: unknown) {
        return kind === "webgl2" && !("allowed" in window) ? null : whole.call(this, kind, options);
      } as typeof HTMLCanvasElement.prototype.getContext;
    });
    const watch = new Watch(page);
    await sign(page, /no graphics context/);
    await page.locator("#mute").click();
    await until(page, () => window.prostm.frame!.run.muted, 0, "the output muted");
    await page.locator("#mute").click();
    await until(page, () => !window.prostm.frame!.run.muted, 0, "the output unmuted");
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#screenshot").click()]);
    expect(statSync(await download.path()).size).toBeGreaterThan(20_000);
    await page.evaluate(() => Object.assign(window, { allowed: true }));
    await page.locator("#draw-anyway").click();
    await newPictures(page);
    expect(watch.complaints).toEqual([]);
    await page.close();
  });
});

describe("a side view in place of the picture", () => {
  let page: Page;
  const palm = async (): Promise<number[]> => {
    await until(page, () => window.prostm.frame!.run.pageHand && window.prostm.frame!.hands.length > 0, 0, "the page's hand");
    return page.evaluate(() => [...window.prostm.frame!.hands[0]!.joints.subarray(0, 3)].map((v) => 1000 * v));
  };
  beforeAll(async () => {
    page = await browser.newPage({ viewport: { width: 1100, height: 700 }, colorScheme: "light" });
    await page.goto(`${program.address}/#folded=&picture=off`);
    await until(page, () => (window.prostm?.frames ?? 0) > 2 && window.prostm.sideViews > 0, 0, "frames and a side view");
  });
  afterAll(() => page.close());

  it("is drawn twice a second", async () => {
    const count = () => page.evaluate(() => ({ views: window.prostm.sideViews, at: performance.now() }));
    const from = await count();
    await page.waitForTimeout(4000);
    const to = await count(), rate = (1000 * (to.views - from.views)) / (to.at - from.at);
    expect(rate).toBeLessThanOrEqual(2.05);
    expect(rate).toBeGreaterThan(1);
    expect(await page.evaluate(() => window.prostm.pictures)).toBe(0);
  });

  it("shows array, smoke, hand and focal points, and the hand follows the mouse sideways and up", async () => {
    /// Pixels of the side view in colours of skin, and of the first path.
    const seen = () => page.evaluate(() => {
      const canvas = document.querySelector<HTMLCanvasElement>("#side")!;
      const { data } = canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height);
      let skin = 0, path = 0, smoke = 0, x = 0, y = 0;
      for (let i = 0; i < data.length; i += 4) {
        const [r, g, b, a] = [data[i]!, data[i + 1]!, data[i + 2]!, data[i + 3]!];
        if (Math.abs(r - 227) < 4 && Math.abs(g - 176) < 4 && Math.abs(b - 148) < 4) {
          ++skin;
          x += (i / 4) % canvas.width;
          y += Math.floor(i / 4 / canvas.width);
        }
        if (Math.abs(r - 213) < 4 && Math.abs(g - 94) < 4 && b < 4) ++path;
        if (Math.abs(r - 92) < 6 && Math.abs(g - 116) < 6 && Math.abs(b - 160) < 6 && a > 20) ++smoke;
      }
      return { skin, path, smoke, x: x / skin, y: y / skin };
    });
    expect((await seen()).skin).toBe(0);
    await expect.poll(async () => (await seen()).smoke, kSoon).toBeGreaterThan(200);
    await page.locator("#page-hand").check();
    await expect.poll(async () => (await seen()).skin, kSoon).toBeGreaterThan(500);
    await expect.poll(async () => (await seen()).path, kSoon).toBeGreaterThan(20);
    await until(page, () => {
      const side = document.querySelector<HTMLCanvasElement>("#side")!;
      return side.height === side.clientHeight && side.clientHeight > 200;
    }, 0, "a side view of the final size");
    const before = await palm(), drawn = await seen();
    const box = (await page.locator("#side").boundingBox())!, [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 40, y - 20, { steps: 5 });
    await page.mouse.up();
    const scale = (box.height / 0.38 < (box.width - 120) / 0.36 ? box.height / 0.38 : (box.width - 120) / 0.36) / 1000; // pixels per mm
    await expect.poll(async () => (await palm())[0]! - before[0]!, kSoon).toBeCloseTo(40 / scale, 0);
    await expect.poll(async () => (await palm())[2]! - before[2]!, kSoon).toBeCloseTo(20 / scale, 0);
    expect((await palm())[1]).toBeCloseTo(before[1]!, 1);
    await expect.poll(async () => (await seen()).x - drawn.x, kSoon).toBeGreaterThan(25);
    await expect.poll(async () => drawn.y - (await seen()).y, kSoon).toBeGreaterThan(12);
    await page.keyboard.press("ArrowUp");
    await expect.poll(async () => (await palm())[1]! - before[1]!, kSoon).toBeCloseTo(5, 0);
    const eye = await page.evaluate(() => /eye=/.test(location.hash));
    expect(eye, "the view in three dimensions stays").toBe(false);
    await page.locator("#page-hand").uncheck();
  });
});

describe("keys", () => {
  let page: Page;
  let muted = false;
  beforeAll(async () => { page = await open(); });
  afterAll(() => page.close());

  /// Presses and releases a key as a keyboard of any layout reports it.
  async function press(key: string, code: string, modifiers = 0): Promise<void> {
    const session = await page.context().newCDPSession(page);
    const text = [...key].length === 1 ? { text: key } : {};
    await session.send("Input.dispatchKeyEvent", { type: "keyDown", key, code, modifiers, ...text });
    await session.send("Input.dispatchKeyEvent", { type: "keyUp", key, code, modifiers });
    await session.detach();
  }
  async function toggles(key: string, code: string, modifiers = 0): Promise<void> {
    await press(key, code, modifiers);
    muted = !muted;
    await until(page, (m) => window.prostm.frame!.run.muted === m, muted, `${key} at ${code} mutes or unmutes`);
  }

  it.each([
    ["US", "m", "KeyM", 0], ["CapsLock", "M", "KeyM", 0], ["Shift", "M", "KeyM", 8], ["AZERTY", "m", "Semicolon", 0],
    ["Russian", "ь", "KeyM", 0], ["Greek", "μ", "KeyM", 0], ["Hebrew", "צ", "KeyM", 0], ["Thai", "ท", "KeyM", 0], ["dead", "Dead", "KeyM", 0],
  ] as const)("mute on %s keyboards", async (_, key, code, modifiers) => toggles(key, code, modifiers));

  it("mute from number fields, sliders, lists, switches and dialogs, which keep their values", async () => {
    for (const part of ['[data-control="speed"] input[type=number]', '[data-control="speed"] input[type=range]', "#picture-mode", "#theme", "#see-through", "#mute"]) {
      await page.locator(part).focus();
      const value = () => page.locator(part).evaluate((e) => (e as HTMLInputElement).value);
      const before = await value();
      await toggles("m", "KeyM");
      await toggles("ь", "KeyM");
      expect(await value(), part).toBe(before);
    }
    await press("?", "KeyM", 8); // AZERTY
    expect(await page.locator("#help").isVisible()).toBe(true);
    await toggles("m", "KeyM");
    await toggles("ь", "KeyM");
    await page.keyboard.press("Escape");
    expect(await page.locator("#help").isVisible()).toBe(false);
  });

  it("are ignored with modifiers, and while they repeat", async () => {
    await press("m", "KeyM", 2); // Ctrl
    await press("b", "KeyB");
    await toggles("m", "KeyM");
    if (muted) await toggles("m", "KeyM");
  });

  it("move the hand on other keyboards", async () => {
    await page.locator("#page-hand").check();
    await until(page, () => window.prostm.frame!.run.pageHand, 0, "the page's hand");
    await press("д", "KeyL"); // Russian
    await until(page, () => window.prostm.frame!.hands[0]?.side === "left", 0, "a left hand");
    await press("λ", "KeyL"); // Greek
    await until(page, () => window.prostm.frame!.hands[0]?.side === "right", 0, "a right hand");
  });

  it("and the wheel: a pinch zooms, and the hand stays", async () => {
    const box = (await page.locator("#view").boundingBox())!;
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    const height = async (): Promise<number> => {
      await until(page, () => window.prostm.frame!.run.pageHand && window.prostm.frame!.hands.length > 0, 0, "the page's hand");
      return page.evaluate(() => window.prostm.frame!.hands[0]?.joints[2] ?? NaN);
    };
    const distance = async () => Number(/eye=([^&]*)/.exec(decodeURIComponent(await page.evaluate(() => location.hash)))?.[1]?.split(",")[2] ?? 700);
    const lowered = await height(), far = await distance();
    await page.keyboard.down("Control");
    for (let i = 0; i < 10; ++i) await page.mouse.wheel(0, -5);
    await page.keyboard.up("Control");
    await expect.poll(distance, kSoon).toBeLessThan(0.75 * far);
    const seen = await page.evaluate(() => window.prostm.frames);
    await until(page, (n) => window.prostm.frames > n + 10, seen, "frames after the pinch");
    expect(await height()).toBeCloseTo(lowered, 3);
    await page.locator("#page-hand").uncheck();
  });
});

describe("a hidden page", () => {
  const hand = async () => ((await program.numbers()).run as Json).page_hand as Json;
  /// Whether the page's hand is ever in charge in this many readings, 0.05 s apart.
  async function everInCharge(readings: number): Promise<boolean> {
    let ever = false;
    for (let i = 0; i < readings; ++i) {
      ever ||= (await hand()).state === "held";
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    return ever;
  }
  async function take(page: Page): Promise<void> {
    await page.locator("#page-hand").check();
    await expect.poll(async () => (await hand()).state, kSoon).toBe("held");
  }
  /// Hides or shows a page as browsers report it.
  const setHidden = (page: Page, hidden: boolean) => page.evaluate((h) => {
    Object.defineProperty(document, "hidden", { configurable: true, get: () => h });
    document.dispatchEvent(new Event("visibilitychange"));
  }, hidden);

  it("releases its hand at once with the reason, and takes it again on request", async () => {
    const page = await open();
    await take(page);
    const { hidden } = await hand();
    await setHidden(page, true);
    await expect.poll(async () => (await hand()).state, kSoon).toBe("hidden");
    expect((await hand()).hidden).toBe(Number(hidden) + 1);
    expect(await everInCharge(30)).toBe(false);
    await setHidden(page, false);
    expect(await page.locator("#page-hand").isChecked()).toBe(false);
    expect(await page.locator("#page-hand-why").textContent()).toMatch(/released because this page was hidden/);
    await expect.poll(() => page.locator("#source").textContent(), kSoon).toMatch(/page that held the hand is hidden/);
    expect(await everInCharge(10)).toBe(false);
    await take(page);
    expect(await page.locator("#page-hand-why").textContent()).toBe("");
    await page.locator("#page-hand").uncheck();
    await page.close();
  });

  it("cannot take the hand, and loses it when it is frozen or left", async () => {
    const page = await open();
    await setHidden(page, true);
    await page.evaluate(() => document.getElementById("page-hand")!.click());
    expect(await everInCharge(10)).toBe(false);
    await setHidden(page, false);
    for (const event of ["freeze", "pagehide"]) {
      await take(page);
      await page.evaluate((name) => (name === "freeze" ? document : window).dispatchEvent(new Event(name)), event);
      await expect.poll(async () => (await hand()).state, kSoon).toBe("hidden");
    }
    await take(page);
    await page.goto("about:blank");
    await expect.poll(async () => (await hand()).state, kSoon).not.toBe("held");
    await page.close();
  });

  it("with late messages loses the hand once, and gets it back when they are steady", async () => {
    const page = await browser.newPage({ viewport: { width: 1100, height: 700 } });
    let slow = false, last = 0;
    await page.routeWebSocket(/live/, (socket) => {
      const server = socket.connectToServer();
      socket.onMessage((message) => {
        const now = Date.now();
        if (slow && String(message).includes('"hand"') && now - last < 1000) return;
        last = now;
        server.send(message);
      });
      server.onMessage((message) => socket.send(message));
    });
    await page.goto(program.address + kHash);
    await until(page, () => window.prostm?.state != null && window.prostm.frames > 2, 0, "frames");
    await take(page);
    const late = Number((await hand()).late);
    slow = true;
    await expect.poll(async () => (await hand()).state, kSoon).toBe("late");
    expect(await everInCharge(60)).toBe(false);
    expect((await hand()).late).toBe(late + 1);
    expect(await page.locator("#page-hand-why").textContent()).toMatch(/came late/);
    slow = false;
    await expect.poll(async () => (await hand()).state, kSoon).toBe("held");
    await expect.poll(() => page.locator("#page-hand-why").textContent(), kSoon).toBe("");
    await page.close();
  });
});
