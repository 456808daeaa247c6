/// Says in the picture what pressure is on the skin under the pointer.

import { cellWords, say } from "../panels/hover";
import type { View } from "../scene/view";

export class Pointer {
  private at: { x: number; y: number } | null = null;

  constructor(private readonly view: View) {
    view.canvas.addEventListener("pointermove", (e) => {
      this.at = e.buttons === 0 ? { x: e.clientX, y: e.clientY } : null; // who turns the view does not read
      this.update();
    });
    view.canvas.addEventListener("pointerleave", () => {
      this.at = null;
      say([], 0, 0);
    });
  }

  /// Called when there is something new under a pointer that rests, too.
  update(moved = true): void {
    if (this.at === null) return void (moved && say([], 0, 0));
    const hit = this.view.skinAt(this.at.x, this.at.y);
    if (hit === null) return say([], 0, 0);
    const [x, y, z] = hit.point.toArray().map((v) => (1000 * v).toFixed(0));
    say([...cellWords(hit.patch, hit.cell), `x ${x}, y ${y} mm, ${z} mm over the array`], this.at.x, this.at.y);
  }
}
