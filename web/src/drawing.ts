/// Decides when to draw: the picture as often as the run can spare, planes and numbers when new data arrive.

import type { PictureMode } from "./address";
import { find, setText } from "./dom";
import type { Graphics, View } from "./scene/view";
import type { Frame } from "./wire";

export interface Parts {
  /// draws planes and numbers
  panels(frame: Frame, now: number): void;
  /// @param due whether their interval has passed.
  strips(now: number, due: boolean): void;
  mode(): PictureMode;
  /// whether the run meets its rates
  held(): boolean;
  /// frames per second that the page can use
  rate(hz: number): void;
}

const kPanels = 60, kSlowPanels = 150, kStrips = 150, kSlowStrips = 400; // [ms] between drawings

const kOff = "The picture in three dimensions is off; the planes show the fields.";
const kNoGraphics: Record<Graphics, string> = {
  ready: "The picture in three dimensions is off: drawing it here would slow the run down. The planes show the fields.",
  lost: "The browser has taken away the graphics context (WebGL) of the picture in three dimensions. The picture " +
    "comes back with it; reload the page if that takes long. The planes show the fields.",
  none: "This browser has no graphics context (WebGL 2) for the picture in three dimensions. " +
    "The planes show the fields.",
};

export class Drawing {
  pictures = 0;
  still = false;
  private frame: Frame | null = null;
  private inPanels: Frame | null = null;
  private inView: Frame | null = null;
  private panelsAt = 0;
  private stripsAt = 0;
  private before = 0;
  private off = false; // the picture is off for the run's sake

  constructor(private readonly view: View, private readonly parts: Parts) {
    window.requestAnimationFrame((now) => this.draw(now));
  }

  show(frame: Frame): void { this.frame = frame; }
  get shown(): Frame | null { return this.frame; }
  /// Redraws everything in a new look.
  again(): void { this.inPanels = this.inView = null; }
  /// Turns the picture on again if it was switched off automatically, or had no graphics context.
  begin(): void {
    this.off = false;
    this.view.begin();
  }

  private draw(now: number): void {
    window.requestAnimationFrame((next) => this.draw(next));
    const slow = this.view.pace.slow;
    if (this.frame !== null && this.frame !== this.inPanels && now - this.panelsAt >= (slow ? kSlowPanels : kPanels)) {
      this.panelsAt = now;
      this.inPanels = this.frame;
      this.parts.panels(this.frame, now);
    }
    const due = !this.still && this.frame !== null && now - this.stripsAt >= (slow ? kSlowStrips : kStrips);
    if (due) this.stripsAt = now;
    this.parts.strips(now, due);
    this.drawPicture(now);
  }

  private drawPicture(now: number): void {
    const { view } = this, mode = this.parts.mode();
    const pace = view.pace.state(now, this.parts.held());
    if (mode === "auto" && pace.off) this.off = true;
    const wished = this.still || mode === "on" || (mode === "auto" && !this.off);
    const drawn = wished && view.graphics === "ready";
    this.tell(drawn, mode);
    this.parts.rate(!drawn ? 10 : view.pace.slow ? 15 : 30);
    const wanted = this.frame !== null && this.inView === null; // the first frame and user requests ignore the pace
    if (!drawn || !view.ready(now, wanted ? 0 : pace.interval)) return;
    const dt = this.before === 0 ? 0 : (now - this.before) / 1000;
    this.before = now;
    if (this.frame !== null && this.frame !== this.inView) {
      this.inView = this.frame;
      view.setFrame(this.frame);
    }
    view.render(dt);
    ++this.pictures;
  }

  private tell(drawn: boolean, mode: PictureMode): void {
    find("picture").dataset.drawn = String(drawn);
    find("no-picture").hidden = drawn;
    if (drawn) return;
    const { graphics } = this.view;
    setText(find("no-picture-why"), mode === "off" ? kOff : kNoGraphics[graphics]);
    // only the browser can restore a context that it took away
    find("draw-anyway").hidden = mode !== "off" && graphics === "lost";
  }
}
