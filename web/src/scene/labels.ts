/// The texts at positions of the picture.

import { Vector3, type Camera } from "three";
import { find, make, setText } from "../dom";
import { readable, type Label } from "./label";

export class Labels {
  private readonly root = find("labels");
  private readonly spans: HTMLElement[] = [];

  /// @param canvas the canvas under the labels, of the same size.
  show(labels: Label[], camera: Camera, canvas: HTMLCanvasElement): void {
    while (this.spans.length < labels.length) {
      const span = make("span");
      this.spans.push(span);
      this.root.append(span);
    }
    const { clientWidth: width, clientHeight: height } = canvas;
    const place = new Vector3();
    this.spans.forEach((span, i) => {
      const label = labels[i];
      if (label !== undefined) place.copy(label.at).project(camera);
      span.hidden = label === undefined || Math.abs(place.x) > 1 || Math.abs(place.y) > 1 || Math.abs(place.z) > 1;
      if (span.hidden || label === undefined) return;
      setText(span, label.text);
      span.className = `${label.side}${label.strong ? " strong" : ""}`;
      span.style.setProperty("left", `${Math.round(0.5 * (place.x + 1) * width)}px`);
      span.style.setProperty("top", `${Math.round(0.5 * (1 - place.y) * height)}px`);
    });
    const box = (element: Element) => element.getBoundingClientRect();
    const over = [...document.querySelectorAll("#picture .hand-box, #views button, #legend")].map(box);
    const picture = box(canvas), shown = this.spans.filter((span) => !span.hidden);
    const seen = shown.map((span) => readable(box(span), picture, over));
    shown.forEach((span, i) => span.classList.toggle("covered", !seen[i]));
  }
}
