/// A screenshot of the page: the scene, the planes and the strips side by side, with a caption below.

import { find } from "../dom";

export interface PictureSource {
  canvas: HTMLCanvasElement;
  /// draws the newest picture now, so that it can be read back
  render(): void;
  /// the title, and the parts of the text below the picture
  caption(): { title: string; parts: string[] };
}

const kGap = 18, kLine = 20; // [pixels of the page]
const kText = "13px system-ui, sans-serif";

/// Breaks the parts of a text into lines that fit the width.
export function wrapped(parts: string[], width: number, widthOf: (text: string) => number): string[] {
  const lines: string[] = [];
  for (const part of parts) {
    const longer = lines.length > 0 ? `${lines[lines.length - 1]}  ·  ${part}` : part;
    if (lines.length > 0 && widthOf(longer) <= width) lines[lines.length - 1] = longer;
    else lines.push(part);
  }
  return lines;
}

/// Draws the texts of a part of the page as they look there, at `left` and `top` for the corner of `frame`.
function drawTexts(context: CanvasRenderingContext2D, part: Element, frame: DOMRect, left: number, top: number): void {
  const texts = document.createTreeWalker(part, NodeFilter.SHOW_TEXT);
  const range = document.createRange();
  context.textBaseline = "middle";
  for (let node = texts.nextNode(); node !== null; node = texts.nextNode()) {
    range.selectNodeContents(node);
    const element = node.parentElement, box = range.getBoundingClientRect(), text = node.textContent ?? "";
    if (element === null || box.width === 0 || element.closest("button, .segments")) continue;
    const { fontWeight, fontSize, fontFamily, color, textTransform } = getComputedStyle(element);
    context.font = `${fontWeight} ${fontSize} ${fontFamily}`;
    context.fillStyle = color;
    const words = textTransform === "uppercase" ? text.toUpperCase() : text;
    context.fillText(words.trim(), left + box.left - frame.left, top + (box.top + box.bottom) / 2 - frame.top);
  }
  context.textBaseline = "alphabetic";
}

/// Draws the whole panels, including parts that are scrolled out of sight. @param corner of their place in the picture.
function drawPanels(context: CanvasRenderingContext2D, left: number, corner: number): void {
  const panels = find("panels"), side = panels.getBoundingClientRect(), top = corner + panels.scrollTop;
  for (const part of panels.querySelectorAll<HTMLElement>("canvas, .swatch")) {
    const box = part.getBoundingClientRect(), x = left + box.left - side.left, y = top + box.top - side.top;
    context.fillStyle = part.style.getPropertyValue("--swatch");
    if (box.width === 0) continue;
    if (part instanceof HTMLCanvasElement) context.drawImage(part, x, y, box.width, box.height);
    else context.fillRect(x, y, box.width, box.height);
  }
  drawTexts(context, panels, side, left, top);
}

function drawScene(context: CanvasRenderingContext2D, source: PictureSource, left: number, top: number): void {
  const view = source.canvas.getBoundingClientRect();
  source.render();
  context.drawImage(source.canvas, left, top, view.width, view.height);
  if (source.canvas.id !== "view") return; // the side view draws its texts itself
  for (const label of document.querySelectorAll("#labels span:not([hidden], .covered)")) {
    drawTexts(context, label, view, left, top);
  }
}

/// Draws every part of the page that shows the run, in the layout of the page.
export function compose(source: PictureSource): HTMLCanvasElement {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string) => style.getPropertyValue(name).trim();
  const view = source.canvas.getBoundingClientRect(), panels = find("panels"), side = panels.getBoundingClientRect();
  const { title, parts } = source.caption();
  const out = document.createElement("canvas");
  const context = out.getContext("2d");
  if (context === null) return out;

  const width = view.width + side.width + 3 * kGap;
  context.font = kText;
  const lines = wrapped(parts, width - 2 * kGap, (text) => context.measureText(text).width);
  const top = kGap + 34, height = top + Math.max(view.height, panels.scrollHeight) + kGap + kLine * lines.length + kGap;
  const ratio = Math.max(1, Math.min(2, window.devicePixelRatio || 1));
  [out.width, out.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  context.scale(ratio, ratio);
  context.fillStyle = colour("--card");
  context.fillRect(0, 0, width, height);
  context.fillStyle = colour("--ink");
  context.font = "600 20px system-ui, sans-serif";
  context.fillText(title, kGap, kGap + 16);
  drawScene(context, source, kGap, top);
  drawPanels(context, view.width + 2 * kGap, top);

  context.font = kText;
  context.fillStyle = colour("--faint");
  lines.forEach((line, i) => context.fillText(line, kGap, height - kGap - kLine * (lines.length - 1 - i)));
  return out;
}
