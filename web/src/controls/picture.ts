/// The page as one picture: the scene, the planes and the strips beside each other, with a caption under them.

import { find } from "../dom";

export interface PictureSource {
  canvas: HTMLCanvasElement;
  /// draws the newest picture now, so that it can be read
  render(): void;
  /// title, then parts of text for the lines under the picture
  caption(): { title: string; parts: string[] };
}

const kGap = 18, kLine = 20; // [pixels of the page]
const kText = "13px system-ui, sans-serif", kSmall = "11px system-ui, sans-serif";
const kNames = "600 13px system-ui, sans-serif";

/// Parts of text in as many lines as their width needs.
export function wrapped(parts: string[], width: number, widthOf: (text: string) => number): string[] {
  const lines: string[] = [];
  for (const part of parts) {
    const longer = lines.length > 0 ? `${lines[lines.length - 1]}  ·  ${part}` : part;
    if (lines.length > 0 && widthOf(longer) <= width) lines[lines.length - 1] = longer;
    else lines.push(part);
  }
  return lines;
}

interface Sheet {
  context: CanvasRenderingContext2D;
  ink: string;
  faint: string;
}

/// A text of the page, where it is on it.
function drawText({ context, ink, faint }: Sheet, element: HTMLElement, x: number, y: number): void {
  const small = element.matches("#scales span, small, .legend li, #labels span");
  context.font = small ? kSmall : kNames;
  context.fillStyle = small ? faint : ink;
  context.fillText((element.textContent ?? "").trim(), x, y);
}

/// The name of a strip, its unit, and the colour, name and value of each of its lines, in one row.
function drawStripHead(sheet: Sheet, strip: Element, left: number, right: number, y: number): void {
  const { context, ink, faint } = sheet;
  const write = (text: string, font: string, colour: string, x: number) => {
    context.font = font;
    context.fillStyle = colour;
    context.fillText(text, x, y);
    return context.measureText(text).width;
  };
  let x = left + write(strip.querySelector("h3")?.textContent ?? "", kNames, ink, left) + 8;
  let end = right;
  for (const item of [...strip.querySelectorAll<HTMLElement>(".legend li")].reverse()) {
    const words = (item.textContent ?? "").trim();
    context.font = kSmall;
    end -= context.measureText(words).width;
    write(words, kSmall, ink, end);
    context.fillStyle = item.querySelector<HTMLElement>(".swatch")?.style.getPropertyValue("--swatch") ?? ink;
    context.fillRect(end - 14, y - 6, 10, 4);
    end -= 22;
  }
  // the unit, where there is room for it
  const unit = strip.querySelector("small")?.textContent ?? "";
  context.font = kSmall;
  if (x + context.measureText(unit).width < end - 6) x += write(unit, kSmall, faint, x);
}

function drawPanels(sheet: Sheet, left: number, top: number): void {
  const { context } = sheet;
  const side = find("panels").getBoundingClientRect();
  const x = (at: number) => left + at - side.left, y = (at: number) => top + at - side.top;
  for (const image of document.querySelectorAll<HTMLCanvasElement>("#panels canvas")) {
    const box = image.getBoundingClientRect();
    if (box.width > 0) context.drawImage(image, x(box.left), y(box.top), box.width, box.height);
  }
  for (const name of document.querySelectorAll<HTMLElement>("#panels figcaption, #scales span")) {
    const box = name.getBoundingClientRect();
    drawText(sheet, name, x(box.left), y(box.bottom) - 4);
  }
  for (const strip of document.querySelectorAll("#strips .strip")) {
    const box = strip.getBoundingClientRect();
    drawStripHead(sheet, strip, x(box.left), x(box.right) - 14, y(box.top) + 13);
  }
}

function drawScene(sheet: Sheet, source: PictureSource, left: number, top: number): void {
  const view = source.canvas.getBoundingClientRect();
  source.render();
  sheet.context.drawImage(source.canvas, left, top, view.width, view.height);
  for (const label of document.querySelectorAll<HTMLElement>("#labels span:not([hidden])")) {
    const box = label.getBoundingClientRect();
    drawText(sheet, label, left + box.left - view.left, top + box.bottom - view.top - 3);
  }
}

/// Every part of the page that shows the run, where it is beside the others.
export function compose(source: PictureSource): HTMLCanvasElement {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string) => style.getPropertyValue(name).trim();
  const view = source.canvas.getBoundingClientRect(), side = find("panels").getBoundingClientRect();
  const { title, parts } = source.caption();
  const out = document.createElement("canvas");
  const context = out.getContext("2d");
  if (context === null) return out;

  const sheet = { context, ink: colour("--ink"), faint: colour("--faint") };
  const width = view.width + side.width + 3 * kGap;
  context.font = kText;
  const lines = wrapped(parts, width - 2 * kGap, (text) => context.measureText(text).width);
  const top = kGap + 34, height = top + Math.max(view.height, side.height) + kGap + kLine * lines.length + kGap;
  const ratio = Math.max(1, Math.min(2, window.devicePixelRatio || 1));
  [out.width, out.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  context.scale(ratio, ratio);
  context.fillStyle = colour("--card");
  context.fillRect(0, 0, width, height);
  context.fillStyle = sheet.ink;
  context.font = "600 20px system-ui, sans-serif";
  context.fillText(title, kGap, kGap + 16);
  drawScene(sheet, source, kGap, top);
  drawPanels(sheet, view.width + 2 * kGap, top);

  context.font = kText;
  context.fillStyle = sheet.faint;
  lines.forEach((line, i) => context.fillText(line, kGap, height - kGap - kLine * (lines.length - 1 - i)));
  return out;
}
