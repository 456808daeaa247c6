/// Shows the pressure on the skin under the pointer, in the picture.

import { cellWords, placeWords, say } from "../panels/hover";
import { onPoint, type Place } from "../pointing";
import type { View } from "../scene/view";

export class Pointer {
  private at: Place | null = null;

  /// @param drawn whether the picture is shown.
  constructor(private readonly view: View, private readonly drawn: () => boolean) {
    onPoint(view.canvas, (at) => {
      this.at = at;
      this.update();
    });
  }

  /// Also called when new data arrive under a resting pointer.
  update(moved = true): void {
    if (this.at === null) return void (moved && say([], 0, 0));
    const hit = this.drawn() ? this.view.skinAt(this.at.x, this.at.y) : null;
    if (hit === null) {
      // a hand that appears later was not tapped
      if (this.at.tapped) this.at = null;
      return say([], 0, 0);
    }
    say([...cellWords(hit.patch, hit.cell), placeWords(...hit.point.toArray())], this.at.x, this.at.y);
  }
}
