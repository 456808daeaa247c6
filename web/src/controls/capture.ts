/// Pictures (PNG) and films (WebM) of what is on the page.

import { find } from "../dom";

function offer(data: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(data);
  link.download = name;
  link.click();
  window.setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

function stamp(): string {
  return new Date().toISOString().slice(0, 19).replace("T", "-").replaceAll(":", "");
}

export interface PictureSource {
  canvas: HTMLCanvasElement;
  /// draws the newest picture now, so that it can be read
  render(): void;
  /// title, then lines of numbers and settings
  caption(): string[];
}

const kGap = 18, kLine = 20; // [pixels of the page]
const kWords = "13px system-ui, sans-serif", kNames = "600 13px system-ui, sans-serif";

/// A text in as many lines as its width needs, broken between its parts.
function wrapped(context: CanvasRenderingContext2D, text: string, width: number): string[] {
  const lines: string[] = [];
  for (const part of text.split("  ·  ")) {
    const longer = lines.length > 0 ? `${lines[lines.length - 1]}  ·  ${part}` : part;
    if (lines.length > 0 && context.measureText(longer).width <= width) lines[lines.length - 1] = longer;
    else lines.push(part);
  }
  return lines;
}

/// What stands beside a plot's name: each line's colour, name and value.
function drawLegend(context: CanvasRenderingContext2D, strip: Element, right: number, y: number, ink: string): void {
  let x = right;
  for (const item of [...strip.querySelectorAll<HTMLElement>(".legend li")].reverse()) {
    const words = (item.textContent ?? "").trim();
    x -= context.measureText(words).width;
    context.fillStyle = ink;
    context.fillText(words, x, y);
    context.fillStyle = item.querySelector<HTMLElement>(".swatch")?.style.getPropertyValue("--swatch") ?? ink;
    context.fillRect(x - 14, y - 6, 10, 4);
    x -= 22;
  }
}

/// The picture, the planes and the strips beside each other as they are on the page, with a caption under them.
export function compose(source: PictureSource): HTMLCanvasElement {
  const style = getComputedStyle(document.documentElement);
  const [ground, ink, faint] = ["--card", "--ink", "--faint"].map((name) => style.getPropertyValue(name).trim()) as [string, string, string];
  const { canvas } = source;
  const view = canvas.getBoundingClientRect(), side = find("panels").getBoundingClientRect();
  const [title = "", numbers = "", settings = ""] = source.caption();
  const out = document.createElement("canvas");
  const context = out.getContext("2d");
  if (context === null) return out;

  const width = view.width + side.width + 3 * kGap;
  context.font = kWords;
  const lines = [numbers, ...wrapped(context, settings, width - 2 * kGap)];
  const top = kGap + 34, height = top + Math.max(view.height, side.height) + kGap + kLine * lines.length + kGap;
  const ratio = Math.max(1, Math.min(2, window.devicePixelRatio || 1));
  [out.width, out.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  context.scale(ratio, ratio);
  context.fillStyle = ground;
  context.fillRect(0, 0, width, height);
  context.fillStyle = ink;
  context.font = "600 20px system-ui, sans-serif";
  context.fillText(title, kGap, kGap + 16);
  source.render();
  context.drawImage(canvas, kGap, top, view.width, view.height);

  // the panels, each where it is on the page
  const x = (left: number) => view.width + 2 * kGap + left - side.left;
  const y = (at: number) => top + at - side.top;
  for (const image of document.querySelectorAll<HTMLCanvasElement>("#panels canvas")) {
    const box = image.getBoundingClientRect();
    if (box.width > 0) context.drawImage(image, x(box.left), y(box.top), box.width, box.height);
  }
  for (const name of document.querySelectorAll<HTMLElement>("#panels figcaption, #panels h3, #scales span")) {
    const box = name.getBoundingClientRect();
    const small = name.matches("#scales span");
    context.font = small ? "11px system-ui, sans-serif" : kNames;
    context.fillStyle = small ? faint : ink;
    context.fillText([...name.childNodes].map((n) => n.textContent).join(" "), x(box.left), y(box.bottom) - 4);
  }
  context.font = "11px system-ui, sans-serif";
  for (const strip of document.querySelectorAll("#strips .strip")) {
    drawLegend(context, strip, x(side.right) - 14, y(strip.getBoundingClientRect().top) + 13, ink);
  }

  context.font = kWords;
  lines.forEach((line, i) => {
    context.fillStyle = i === 0 ? ink : faint;
    context.fillText(line, kGap, height - kGap - kLine * (lines.length - 1 - i));
  });
  return out;
}

export class Capture {
  private recorder: MediaRecorder | null = null;
  private readonly film = find<HTMLButtonElement>("film");

  constructor(source: PictureSource, private readonly say: (sentence: string) => void) {
    find("screenshot").addEventListener("click", () => {
      compose(source).toBlob((data) => (data === null ? say("This browser could not make a picture.") : offer(data, `prostm-${stamp()}.png`)), "image/png");
    });
    const type = typeof MediaRecorder === "undefined" ? undefined : ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"].find((t) => MediaRecorder.isTypeSupported(t));
    if (type === undefined || !("captureStream" in source.canvas)) {
      this.film.disabled = true;
      this.film.title = "This browser cannot record films of the picture (it lacks MediaRecorder with WebM).";
      return;
    }
    this.film.addEventListener("click", () => (this.recorder === null ? this.begin(source.canvas, type) : this.recorder.stop()));
  }

  private begin(canvas: HTMLCanvasElement, type: string): void {
    const recorder = new MediaRecorder(canvas.captureStream(30), { mimeType: type, videoBitsPerSecond: 12e6 });
    const parts: Blob[] = [];
    recorder.ondataavailable = (event) => parts.push(event.data);
    recorder.onstop = () => {
      this.recorder = null;
      this.show(false);
      offer(new Blob(parts, { type }), `prostm-${stamp()}.webm`);
    };
    recorder.onerror = () => this.say("The film could not be recorded.");
    recorder.start(1000);
    this.recorder = recorder;
    this.show(true);
  }
  private show(recording: boolean): void {
    this.film.setAttribute("aria-pressed", String(recording));
    this.film.lastChild!.textContent = recording ? "Stop" : "Record";
  }
}
