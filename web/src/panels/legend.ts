/// The legend of the colours on the skin in the picture.

import { kDifferenceTables, kFieldTable } from "../colours";
import { find, make } from "../dom";
import type { FieldMode } from "../scene/field_maps";
import { short } from "../text";

const kTitles: Record<FieldMode, string> = {
  target: "Target pressure", rendered: "Reconstruction", difference: "Reconstruction less target", none: "",
};

export function paintBar(canvas: HTMLCanvasElement, table: Uint8ClampedArray): void {
  canvas.getContext("2d")?.putImageData(new ImageData(new Uint8ClampedArray(table), 256, 1), 0, 0);
}

export class Legend {
  private readonly root = find("legend");
  private readonly title = make("b");
  private readonly bar = make("canvas", { class: "bar", width: 256, height: 1, "aria-hidden": "true" });
  private readonly low = make("span");
  private readonly high = make("span");
  private shown = "";

  constructor() {
    this.root.append(this.title, make("div", { class: "scale" }, this.low, this.bar, this.high));
    this.bar.addEventListener("contextrestored", () => (this.shown = ""));
  }

  show(mode: FieldMode, scale: number, dark: boolean): void {
    const wanted = `${mode} ${scale} ${dark}`;
    if (wanted === this.shown) return;
    this.shown = wanted;
    this.root.hidden = mode === "none";
    this.title.textContent = kTitles[mode];
    this.low.textContent = mode === "difference" ? `−${short(scale)}` : "0";
    this.high.textContent = `${mode === "difference" ? "+" : ""}${short(scale)} Pa`;
    paintBar(this.bar, mode === "difference" ? kDifferenceTables[dark ? "dark" : "light"] : kFieldTable);
  }
}
