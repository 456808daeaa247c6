/// The field of each hand flattened to its plane: target, what is rendered, and their difference, in one scale, with the paths.

import { css, kDifferenceTables, kFieldTable, pathColour } from "../colours";
import { find, make, short } from "../dom";
import { paintBar } from "./legend";
import type { Frame, Patch, Path } from "../wire";

type Kind = "target" | "rendered" | "difference";
const kKinds: { kind: Kind; title: string }[] = [
  { kind: "target", title: "Target" },
  { kind: "rendered", title: "Reconstruction" },
  { kind: "difference", title: "Difference" },
];

/// The least of 1, 1.5, 2, 3, 4, 5, 6, 8 × 10ⁿ that is not less than x.
export function roundedUp(x: number): number {
  if (!(x > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(x));
  return power * ([1, 1.5, 2, 3, 4, 5, 6, 8].find((step) => step * power >= x * (1 - 1e-9)) ?? 10);
}

export class Planes {
  private readonly canvases: { kind: Kind; canvas: HTMLCanvasElement }[];
  private readonly image = document.createElement("canvas");
  private readonly bar = make("canvas", { class: "bar", width: 256, height: 1, role: "img", "aria-label": "Colours of pressure, from 0 at the left" });
  private readonly differenceBar = make("canvas", { class: "bar", width: 256, height: 1, role: "img", "aria-label": "Colours of the difference, from too little at the left to too much at the right" });
  private readonly most = make("span");
  private readonly least = make("span");
  private readonly more = make("span");
  private dark = false;
  private smallest = 0; // before this time the scale does not shrink [ms]
  /// the pressure at the end of the scale [Pa]
  scale = 1;

  constructor() {
    const row = find("planes");
    this.canvases = kKinds.map(({ kind, title }) => {
      const canvas = make("canvas", { "data-kind": kind, role: "img", "aria-label": `${title} of the pressure in the plane of each hand` });
      row.append(make("figure", {}, make("figcaption", {}, title), canvas));
      return { kind, canvas };
    });
    find("scales").append(
      make("div", { class: "scale" }, make("span", {}, "0"), this.bar, this.most),
      make("div", { class: "scale" }, this.least, this.differenceBar, this.more),
    );
  }

  setDark(dark: boolean): void {
    this.dark = dark;
    paintBar(this.bar, kFieldTable);
    paintBar(this.differenceBar, this.differences);
  }
  private get differences(): Uint8ClampedArray { return this.dark ? kDifferenceTables.dark : kDifferenceTables.light; }

  /// One end for target and rendered of all hands; it grows at once, and shrinks after some seconds.
  measure(frame: Frame, now: number): number {
    let most = 0;
    for (const p of frame.field) {
      let top = 0;
      for (let i = 0; i < p.target.length; ++i) if (p.skin[i]) top = Math.max(top, p.target[i]!, p.rendered[i]!);
      most = Math.max(most, (top / 65535) * p.scale);
    }
    const wanted = roundedUp(most);
    if (wanted >= this.scale || most === 0) this.smallest = now + 4000;
    if (wanted > this.scale || (most > 0 && now > this.smallest)) this.scale = wanted;
    this.most.textContent = `${short(this.scale)} Pa`;
    this.least.textContent = `−${short(this.scale)}`;
    this.more.textContent = `+${short(this.scale)} Pa`;
    return this.scale;
  }

  draw(frame: Frame): void {
    const hands = Math.max(1, frame.field.length);
    find("planes").dataset.hands = String(Math.min(2, hands));
    for (const { kind, canvas } of this.canvases) {
      const ratio = Math.min(2, window.devicePixelRatio || 1);
      const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
      if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
      const context = canvas.getContext("2d");
      if (context === null || width === 0) continue;
      context.clearRect(0, 0, width, height);
      // all hands in the same millimetres
      const extent = Math.max(0.2, ...frame.field.map((p) => Math.ceil((Math.max(p.rows, (p.cols * height) / hands / width) * p.cell + 0.008) / 0.02) * 0.02));
      const pixels = height / hands / extent; // a metre
      frame.field.forEach((patch, k) => {
        context.save();
        context.beginPath();
        context.rect(0, (k * height) / hands, width, height / hands);
        context.clip();
        const middle = [patch.centre[0] + ((patch.cols - 1) / 2) * patch.cell, patch.centre[1] + ((patch.rows - 1) / 2) * patch.cell] as const;
        const x = (p: number) => width / 2 + (p - middle[0]) * pixels;
        const y = (p: number) => ((k + 0.5) * height) / hands - (p - middle[1]) * pixels;
        this.paint(patch, kind);
        context.imageSmoothingEnabled = false;
        const half = patch.cell / 2;
        context.drawImage(this.image, x(patch.centre[0] - half), y(patch.centre[1] + (patch.rows - 1) * patch.cell + half), patch.cols * patch.cell * pixels, patch.rows * patch.cell * pixels);
        frame.plan.forEach((path, i) => path.patch === k && this.drawPath(context, path, i, x, y, ratio));
        context.restore();
      });
      if (kind === "target") this.drawScaleBar(context, pixels, height, ratio);
    }
  }

  /// The cells of a patch into this.image, the row of the largest y first.
  private paint(patch: Patch, kind: Kind): void {
    const { rows, cols } = patch;
    if (this.image.width !== cols || this.image.height !== rows) [this.image.width, this.image.height] = [cols, rows];
    const context = this.image.getContext("2d");
    if (context === null) return;
    const pixels = context.createImageData(cols, rows);
    const colours = kind === "difference" ? this.differences : kFieldTable;
    const unit = patch.scale / 65535 / this.scale;
    for (let j = 0; j < rows; ++j) for (let i = 0; i < cols; ++i) {
      const c = j * cols + i;
      if (patch.skin[c] === 0) continue;
      const target = patch.target[c]! * unit, rendered = patch.rendered[c]! * unit;
      const t = kind === "target" ? target : kind === "rendered" ? rendered : 0.5 + 0.5 * (rendered - target);
      const at = 4 * Math.round(255 * Math.min(1, Math.max(0, t)));
      pixels.data.set(colours.subarray(at, at + 4), 4 * ((rows - 1 - j) * cols + i));
    }
    context.putImageData(pixels, 0, 0);
  }

  private drawPath(context: CanvasRenderingContext2D, path: Path, i: number, x: (p: number) => number, y: (p: number) => number, ratio: number): void {
    context.beginPath();
    if (path.kind === "focus") context.arc(x(path.points[0]!), y(path.points[1]!), 4 * ratio, 0, 2 * Math.PI);
    else for (let n = 0; n < path.count; ++n) context.lineTo(x(path.points[6 * n]!), y(path.points[6 * n + 1]!));
    context.closePath();
    context.lineJoin = "round";
    context.strokeStyle = "#ffffff";
    context.lineWidth = 3.6 * ratio;
    context.stroke();
    context.strokeStyle = css(pathColour(i));
    context.lineWidth = 2 * ratio;
    context.stroke();
  }

  private drawScaleBar(context: CanvasRenderingContext2D, pixels: number, height: number, ratio: number): void {
    const style = getComputedStyle(document.documentElement);
    const left = 7 * ratio, bottom = height - 7 * ratio;
    context.font = `600 ${11 * ratio}px system-ui, sans-serif`;
    // with an edge of the ground's colour, so that it can be read over a hand
    context.strokeStyle = style.getPropertyValue("--raised").trim();
    context.lineWidth = 3 * ratio;
    context.strokeText("50 mm", left, bottom - 6 * ratio);
    context.strokeRect(left, bottom - 2 * ratio, 0.05 * pixels, 2 * ratio);
    context.fillStyle = style.getPropertyValue("--ink").trim();
    context.fillText("50 mm", left, bottom - 6 * ratio);
    context.fillRect(left, bottom - 2 * ratio, 0.05 * pixels, 2 * ratio);
  }
}
