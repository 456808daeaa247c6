/// The fields of each hand in its plane: target, reconstruction and their difference, at one scale, with the
/// paths.

import type { Address } from "../address";
import { css, kDifferenceTables, kFieldTable, pathColour } from "../colours";
import { find, make, setText } from "../dom";
import { onPoint } from "../pointing";
import { short } from "../text";
import type { Frame, Patch, Path } from "../wire";
import { cellWords, placeWords, say } from "./hover";
import { paintBar } from "./legend";
import { layOut, overArray, under, type Placed } from "./plane_layout";
import { PressureScale } from "./scale";

type Kind = "target" | "rendered" | "difference";
const kKinds: { kind: Kind; title: string }[] = [
  { kind: "target", title: "Target" }, { kind: "rendered", title: "Reconstruction" },
  { kind: "difference", title: "Difference" },
];
const kBar = { class: "bar", width: 256, height: 1, role: "img" };

export class Planes {
  private readonly canvases: { kind: Kind; canvas: HTMLCanvasElement }[];
  private readonly image = document.createElement("canvas");
  private readonly bar = make("canvas", { ...kBar, "aria-label": "Colours of pressure, from 0 at the left" });
  private readonly differenceBar = make("canvas", {
    ...kBar, "aria-label": "Colours of the difference, from too little at the left to too much at the right",
  });
  private readonly ends = { most: make("span"), least: make("span"), more: make("span") };
  private readonly lock = find<HTMLButtonElement>("lock-scale");
  private dark = false;
  private frame: Frame | null = null;
  private pointer: { canvas: HTMLCanvasElement; x: number; y: number } | null = null;
  readonly scale = new PressureScale();

  constructor(private readonly address: Address) {
    const row = find("planes");
    this.canvases = kKinds.map(({ kind, title }) => {
      const label = `${title} of the pressure in the plane of each hand`;
      const canvas = make("canvas", { "data-kind": kind, role: "img", "aria-label": label });
      row.append(make("figure", {}, make("figcaption", {}, title), canvas));
      onPoint(canvas, (at) => this.point(at === null ? null : { canvas, x: at.x, y: at.y }));
      return { kind, canvas };
    });
    find("scales").append(
      make("div", { class: "scale" }, make("span", {}, "0"), this.bar, this.ends.most),
      make("div", { class: "scale" }, this.ends.least, this.differenceBar, this.ends.more),
    );
    for (const bar of [this.bar, this.differenceBar]) bar.addEventListener("contextrestored", () => this.paintBars());
    this.scale.locked = address.state.scale ?? null;
    this.lock.addEventListener("click", () => {
      this.scale.locked = this.scale.locked === null ? this.scale.end : null;
      this.address.set({ scale: this.scale.locked ?? undefined });
      this.showScale();
    });
    this.showScale();
  }

  setDark(dark: boolean): void {
    this.dark = dark;
    this.paintBars();
  }
  private paintBars(): void {
    paintBar(this.bar, kFieldTable);
    paintBar(this.differenceBar, this.differences);
  }
  private get differences(): Uint8ClampedArray { return this.dark ? kDifferenceTables.dark : kDifferenceTables.light; }

  private showScale(): void {
    const end = short(this.scale.end), locked = this.scale.locked !== null;
    setText(this.ends.most, `${end} Pa`);
    setText(this.ends.least, `−${end}`);
    setText(this.ends.more, `+${end} Pa`);
    setText(this.lock, locked ? `Locked at ${end} Pa` : `Lock at ${end} Pa`);
    this.lock.setAttribute("aria-pressed", String(locked));
  }

  draw(frame: Frame, now: number): void {
    this.frame = frame;
    this.scale.measure(frame, now);
    this.showScale();
    find("planes").dataset.hands = String(Math.min(2, Math.max(1, frame.field.length)));
    for (const { kind, canvas } of this.canvases) {
      const ratio = Math.min(2, window.devicePixelRatio || 1);
      const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
      if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
      const context = canvas.getContext("2d");
      if (context === null || width === 0) continue;
      context.clearRect(0, 0, width, height);
      const placed = layOut(frame.field, width, height);
      placed.forEach((place, k) => this.drawHand(context, kind, place, frame.plan, k, ratio));
      if (kind === "target") this.drawScaleBar(context, placed[0]?.pixels ?? height / 0.2, height, ratio);
    }
    this.point(this.pointer);
  }

  private drawHand(
    context: CanvasRenderingContext2D, kind: Kind, place: Placed, plan: Path[], k: number, ratio: number,
  ): void {
    const { patch, pixels, x, y } = place;
    context.save();
    context.beginPath();
    context.rect(0, place.top, context.canvas.width, place.height);
    context.clip();
    this.paint(patch, kind);
    context.imageSmoothingEnabled = false;
    const half = patch.cell / 2;
    const left = x(patch.centre[0] - half), top = y(patch.centre[1] + (patch.rows - 1) * patch.cell + half);
    context.drawImage(this.image, left, top, patch.cols * patch.cell * pixels, patch.rows * patch.cell * pixels);
    plan.forEach((path, i) => path.patch === k && this.drawPath(context, path, i, place, ratio));
    context.restore();
  }

  /// Describes the cell under the pointer.
  private point(pointer: Planes["pointer"]): void {
    if (pointer === null && this.pointer === null) return;
    this.pointer = pointer;
    if (pointer === null || this.frame === null) return say([], 0, 0);
    const { canvas } = pointer, box = canvas.getBoundingClientRect();
    const scale = canvas.width / (box.width || 1);
    const placed = layOut(this.frame.field, canvas.width, canvas.height);
    const there = under(placed, (pointer.x - box.left) * scale, (pointer.y - box.top) * scale);
    if (there === null) return say([], 0, 0);
    say([...cellWords(there.patch, there.cell), placeWords(...overArray(there))], pointer.x, pointer.y);
  }

  /// Draws the cells of a patch into this.image, starting with the row of the largest y.
  private paint(patch: Patch, kind: Kind): void {
    const { rows, cols } = patch;
    if (this.image.width !== cols || this.image.height !== rows) [this.image.width, this.image.height] = [cols, rows];
    const context = this.image.getContext("2d");
    if (context === null) return;
    const pixels = context.createImageData(cols, rows);
    const colours = kind === "difference" ? this.differences : kFieldTable;
    const unit = patch.scale / 65535 / this.scale.end;
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

  private drawPath(context: CanvasRenderingContext2D, path: Path, i: number, { x, y }: Placed, ratio: number): void {
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
    context.font = `600 ${12 * ratio}px system-ui, sans-serif`;
    // outlined in the background's colour, so that it is legible over a hand
    context.strokeStyle = style.getPropertyValue("--raised").trim();
    context.lineWidth = 3 * ratio;
    context.strokeText("50 mm", left, bottom - 6 * ratio);
    context.strokeRect(left, bottom - 2 * ratio, 0.05 * pixels, 2 * ratio);
    context.fillStyle = style.getPropertyValue("--ink").trim();
    context.fillText("50 mm", left, bottom - 6 * ratio);
    context.fillRect(left, bottom - 2 * ratio, 0.05 * pixels, 2 * ratio);
  }
}
