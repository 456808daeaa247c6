import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import "../../src/inspection";
import { clean, openBrowser, Program, until, Watch, writeRecording } from "./program";

const program = new Program(["--grid", "32", "--scene", "four-plumes", "--hand", writeRecording(6), "--seconds", "3600"]);
let browser: Browser;
const watches: Watch[] = [];

beforeAll(async () => {
  browser = await openBrowser();
  await program.start();
});
afterAll(async () => {
  await browser?.close();
  await program.stop();
  clean();
});

const kWidths = [390, 1024, 1440, 1920] as const;
const kHeights: Record<number, number> = { 390: 844, 1024: 768, 1440: 900, 1920: 1080 };

interface Typed extends Window { typed: Map<string, number> }

/// Notes the type size of each text on a canvas of the page [pixels of the page].
function watchCanvases(): void {
  const typed = ((window as unknown as Typed).typed = new Map());
  const whole = CanvasRenderingContext2D.prototype.fillText;
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y, ...rest) {
    const ratio = this.canvas.width / (this.canvas.clientWidth || this.canvas.width);
    const size = (parseFloat(/([\d.]+)px/.exec(this.font)![1]!) * this.getTransform().a) / ratio;
    if (text.trim() !== "") typed.set(text, Math.min(size, typed.get(text) ?? Infinity));
    whole.call(this, text, x, y, ...rest);
  };
}

/// Opens a page of the program without the picture, which is not under test here.
async function open(theme: "light" | "dark", more = ""): Promise<Page> {
  const page = await browser.newPage({ viewport: { width: 1024, height: 768 }, colorScheme: theme });
  watches.push(new Watch(page));
  await page.addInitScript(watchCanvases);
  await page.goto(`${program.address}/#folded=&picture=off${more}`);
  await until(page, () => (window.prostm?.frames ?? 0) > 5 && (window.prostm.state?.controls.length ?? 0) > 0, 0, "frames and controls");
  return page;
}

/// Changes the width of the window and waits until the page is drawn.
async function widen(page: Page, width: number): Promise<void> {
  await page.setViewportSize({ width, height: kHeights[width] ?? 900 });
  await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
}

/// Elements that are wider than their space and cut off there.
const clipped = (page: Page) => page.evaluate(() => {
  const texts = "button, label, .label, summary, h1, h2, h3, dt, dd, figcaption, .unit, option, select, th, td, li, p, output, kbd";
  const bad: string[] = [];
  for (const element of document.querySelectorAll<HTMLElement>(texts)) {
    if (!element.checkVisibility() || element.closest(".unseen, canvas")) continue;
    const box = element.getBoundingClientRect();
    if (box.width === 0 || element.matches(".unseen")) continue;
    const what = `${element.tagName} ${element.id} “${(element.textContent ?? "").trim().slice(0, 30)}”`;
    if (box.left < -0.5 || box.right > window.innerWidth + 0.5) bad.push(`${what} beside the window`);
    if (element.scrollWidth > element.clientWidth + 1 && element.clientWidth > 0 && getComputedStyle(element).display !== "inline") bad.push(`${what} wider than its box`);
    // clipped by an element around it
    for (let outer = element.parentElement; outer !== null; outer = outer.parentElement) {
      const style = getComputedStyle(outer);
      if (style.overflowX === "visible") continue;
      const room = outer.getBoundingClientRect();
      if (box.right > room.right + 1 || box.left < room.left - 1) bad.push(`${what} cut off by ${outer.tagName} ${outer.id}.${outer.className}`);
    }
  }
  return bad;
});

/// Visible texts of less than 12 pixels, also on canvases.
const tiny = (page: Page) => page.evaluate(() => {
  const bad: string[] = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node !== null; node = walker.nextNode()) {
    const element = node.parentElement!, text = (node.textContent ?? "").trim();
    if (text === "" || !element.checkVisibility() || element.closest("script, noscript, .unseen")) continue;
    const size = parseFloat(getComputedStyle(element).fontSize);
    if (size < 12) bad.push(`${text.slice(0, 40)}: ${size}`);
  }
  for (const field of document.querySelectorAll<HTMLElement>("input, select, option")) {
    const size = parseFloat(getComputedStyle(field).fontSize);
    if (field.checkVisibility() && size < 12) bad.push(`${field.outerHTML.slice(0, 40)}: ${size}`);
  }
  const { typed } = window as unknown as Typed;
  for (const [text, size] of typed) if (size < 11.99) bad.push(`${text} on a canvas: ${size}`);
  return { bad, onCanvases: typed.size };
});

/// Distance by which the page can be scrolled sideways [pixels].
const tooWide = (page: Page) => page.evaluate(() => {
  const root = document.getElementById("page")!;
  return Math.max(root.scrollWidth - root.clientWidth, document.documentElement.scrollWidth - window.innerWidth);
});

/// Texts with too little contrast to their background, WCAG 2.2: 4.5, and 3 for large type.
const faint = (page: Page) => page.evaluate(() => {
  const context = document.createElement("canvas").getContext("2d", { willReadFrequently: true })!;
  const rgba = (colour: string): number[] => {
    context.clearRect(0, 0, 1, 1);
    context.fillStyle = colour;
    context.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = [...context.getImageData(0, 0, 1, 1).data];
    return [r!, g!, b!, a! / 255];
  };
  const over = (front: number[], back: number[]) => [0, 1, 2].map((i) => front[i]! * front[3]! + back[i]! * (1 - front[3]!));
  const luminance = (c: number[]) => {
    const [r, g, b] = c.slice(0, 3).map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r! + 0.7152 * g! + 0.0722 * b!;
  };
  const ground = (element: HTMLElement): number[] => {
    const layers: number[][] = [];
    for (let e: HTMLElement | null = element; e !== null; e = e.parentElement) layers.push(rgba(getComputedStyle(e).backgroundColor));
    return layers.reverse().reduce((below, layer) => [...over(layer, below), 1], [255, 255, 255, 1]);
  };
  const bad: string[] = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node !== null; node = walker.nextNode()) {
    const element = node.parentElement!;
    if ((node.textContent ?? "").trim() === "" || !element.checkVisibility({ opacityProperty: true } as never) || element.closest("script, noscript, .unseen")) continue;
    // disabled elements may be faint, and texts on the picture have their own background
    if (element.closest(":disabled, .disabled, #labels") || element.closest("label")?.control?.matches(":disabled")) continue;
    const style = getComputedStyle(element), back = ground(element);
    const [a, b] = [luminance(over(rgba(style.color), back)), luminance(back)].sort((p, q) => q - p);
    const size = parseFloat(style.fontSize), large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    const contrast = (a! + 0.05) / (b! + 0.05);
    if (contrast < (large ? 3 : 4.5)) bad.push(`${(node.textContent ?? "").trim().slice(0, 40)}: ${contrast.toFixed(2)}`);
  }
  return bad;
});

describe.each(["light", "dark"] as const)("a page in the %s theme", (theme) => {
  let page: Page;
  beforeAll(async () => {
    page = await open(theme);
  });
  afterAll(() => page.close());

  it("leaves room for the planes if there is no picture above them", async () => {
    await until(page, () => document.getElementById("picture")!.dataset.drawn === "false", 0, "no picture");
    await page.locator("#numbers-group > summary").click(); // folded, as at first
    const plane = (await page.locator('canvas[data-kind="target"]').boundingBox())!;
    expect(plane.y + plane.height).toBeLessThanOrEqual(768);
    const side = (await page.locator("#side").boundingBox())!;
    expect(Math.min(side.width, side.height)).toBeGreaterThanOrEqual(95);
    // also after other sizes
    for (const width of [1440, 1024]) {
      await widen(page, width);
      await page.waitForTimeout(700);
    }
    expect((await page.locator("#side").boundingBox())!.height).toBeCloseTo(side.height, 0);
    await page.locator("#numbers-group > summary").click();
  });
  it.each(kWidths)("fits into a window %i pixels wide", async (width) => {
    await widen(page, width);
    expect(await tooWide(page)).toBeLessThanOrEqual(0);
    expect(await page.evaluate(() => document.documentElement.scrollHeight - window.innerHeight)).toBeLessThanOrEqual(0);
    expect(await clipped(page)).toEqual([]);
    expect(await faint(page)).toEqual([]);
    // the header is one row, and all text is at least 12 pixels high
    const header = (await page.locator("header").boundingBox())!;
    expect(header.height).toBeLessThanOrEqual(48);
    const types = await tiny(page);
    expect(types.bad).toEqual([]);
    expect(types.onCanvases).toBeGreaterThan(5);
  });
  it("has a menu in a narrow header", async () => {
    await widen(page, 390);
    expect(await page.locator("#theme").isVisible()).toBe(false);
    await page.locator("#menu").click();
    expect(await page.locator("#theme").isVisible()).toBe(true);
    expect(await page.locator("#menu").getAttribute("aria-expanded")).toBe("true");
    expect(await clipped(page)).toEqual([]);
    expect(await faint(page)).toEqual([]);
    expect((await tiny(page)).bad).toEqual([]);
    await page.locator("#theme").focus();
    await page.keyboard.press("Escape");
    expect(await page.locator("#theme").isVisible()).toBe(false);
    await page.locator("#menu").click();
    await page.locator("h1").click();
    expect(await page.locator("#theme").isVisible()).toBe(false);
  });
  // leaves the help open: no test follows
  it("is legible while muted, and in its help", async () => {
    await widen(page, 1024);
    await page.locator("#mute").click();
    await until(page, () => document.getElementById("verdict")!.dataset.verdict === "muted", 0, "muted");
    expect(await faint(page)).toEqual([]);
    await page.locator("#mute").click();
    await page.keyboard.press("?");
    await until(page, () => document.querySelector("dialog[open]") !== null, 0, "help");
    expect(await faint(page)).toEqual([]);
    expect(await clipped(page)).toEqual([]);
  });
});

describe("large type", () => {
  let page: Page;
  beforeAll(async () => {
    page = await open("light", "&large=1");
  });
  afterAll(() => page.close());

  it.each(kWidths)("cuts nothing off in a window %i pixels wide", async (width) => {
    await widen(page, width);
    expect(await page.evaluate(() => parseFloat(getComputedStyle(document.documentElement).fontSize))).toBeGreaterThanOrEqual(18);
    expect(await clipped(page)).toEqual([]);
    expect(await tooWide(page)).toBeLessThanOrEqual(0);
    // the planes begin at the same height: each name fits in one line
    const names = await page.locator("figcaption").evaluateAll((all) => all.map((e) => e.getBoundingClientRect().height));
    expect(new Set(names).size).toBe(1);
  });
  it("leaves room for the button next to the longest words on the output", async () => {
    await widen(page, 390);
    await page.locator("#mute").click();
    await until(page, () => document.getElementById("verdict-why")!.textContent === "muted by you or another page", 0, "muted");
    expect(await clipped(page)).toEqual([]);
    await page.locator("#mute").click();
  });
  // changes the page's words: no test follows
  it.each(kWidths)("has room for all that is said in place of the picture, %i pixels wide", async (width) => {
    await widen(page, width);
    const cut = await page.evaluate(() => {
      document.getElementById("no-picture-why")!.textContent = "The picture in three dimensions is off: drawing it here would slow the run down. The planes show the fields.";
      document.getElementById("no-hand-advice")!.textContent = "No tracker yet: nothing answers at leap://127.0.0.1:6437; start the service of the Leap Motion controller, or Ultraleap's bridge.";
      const signs = [...document.querySelectorAll<HTMLElement>("#signs .sign")];
      for (const sign of signs) sign.hidden = false;
      const room = document.getElementById("picture")!.getBoundingClientRect(), above = document.getElementById("views")!.getBoundingClientRect();
      return signs.map((sign) => sign.getBoundingClientRect()).filter((box) => box.bottom > room.bottom || box.top < above.bottom).length;
    });
    expect(cut).toBe(0);
  });
});

describe("the browser's own type size", () => {
  it("cuts nothing off when doubled", async () => {
    const page = await open("light");
    await widen(page, 1440);
    // as in a browser whose own type is 32 pixels high
    await page.evaluate(() => document.documentElement.style.setProperty("font-size", "28px", "important"));
    await page.waitForTimeout(300);
    expect(await clipped(page)).toEqual([]);
    expect(await tooWide(page)).toBeLessThanOrEqual(0);
    await page.close();
  });
});

describe("the page for screen readers", () => {
  let page: Page;
  beforeAll(async () => {
    page = await open("light");
  });
  it("names every control", async () => {
    const unnamed = await page.evaluate(() => [...document.querySelectorAll<HTMLElement>("button, select, input, summary, canvas[role], fieldset, [role=radiogroup], [role=group], dialog")]
      .filter((e) => {
        const by = (e.getAttribute("aria-labelledby") ?? "").split(" ").map((id) => document.getElementById(id)?.textContent ?? "").join("");
        const labels = [...((e as HTMLInputElement).labels ?? [])].map((l) => l.textContent ?? "").join("");
        const own = e.matches("button, summary") ? e.textContent : "";
        return `${e.getAttribute("aria-label") ?? ""}${by}${labels}${own ?? ""}`.trim() === "";
      }).map((e) => e.outerHTML.slice(0, 90)));
    expect(unnamed).toEqual([]);
  });
  it("has its headings in order", async () => {
    const levels = await page.evaluate(() => [...document.querySelectorAll("h1, h2, h3, h4, h5, h6")].map((h) => Number(h.tagName[1])));
    expect(levels[0]).toBe(1);
    expect(levels.filter((l) => l === 1)).toHaveLength(1);
    levels.forEach((level, i) => expect(level - (levels[i - 1] ?? 0), `heading ${i}`).toBeLessThanOrEqual(1));
  });
  it("keeps a strip's name apart from its unit", async () => {
    const heads = await page.locator(".strip-head").allTextContents();
    expect(heads[0]).toBe("Stages ms · ↓ better");
    expect(await page.locator(".strip h3").allTextContents()).toEqual(
      ["Stages", "Rates", "Latency", "Blocks", "Force on the hands", "Quality", "Felt strength", "RMSE"],
    );
  });
  afterAll(() => page.close());
});

describe("all pages", () => {
  it("report no errors", () => expect(watches.flatMap((w) => w.complaints)).toEqual([]));
});
