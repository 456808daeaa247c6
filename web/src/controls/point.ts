/// Says in the picture what pressure is on the skin that somebody points at.

import { cellWords, placeWords, say } from "../panels/hover";
import { onPoint, type Place } from "../pointing";
import type { View } from "../scene/view";

export class Pointer {
  private at: Place | null = null;

  constructor(private readonly view: View) {
    onPoint(view.canvas, (at) => {
      this.at = at;
      this.update();
    });
  }

  /// Called when there is something new under a pointer that rests, too.
  update(moved = true): void {
    if (this.at === null) return void (moved && say([], 0, 0));
    const hit = this.view.skinAt(this.at.x, this.at.y);
    if (hit === null) {
      // a hand that comes later is not what was tapped
      if (this.at.tapped) this.at = null;
      return say([], 0, 0);
    }
    say([...cellWords(hit.patch, hit.cell), placeWords(...hit.point.toArray())], this.at.x, this.at.y);
  }
}
