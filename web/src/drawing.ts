/// Decides when to draw: the picture as often as the run can spare, or a side view in its place; planes and numbers
/// when new data arrive.

import type { PictureMode } from "./address";
import { find, setText } from "./dom";
import { Fallback } from "./scene/fallback";
import type { SideView } from "./scene/side_view";
import type { Graphics, View } from "./scene/view";
import type { Frame } from "./wire";

export interface Parts {
  /// draws planes and numbers
  panels(frame: Frame, now: number): void;
  /// draws what is about the present, whatever moment is shown
  live(frame: Frame, now: number): void;
  /// @param due whether their interval has passed.
  strips(now: number, due: boolean): void;
  mode(): PictureMode;
  /// whether the run meets its rates
  held(): boolean;
  /// frames per second that the page can use
  rate(hz: number): void;
  /// draws the side view
  side(frame: Frame, now: number): void;
}

const kPanels = 60, kSlowPanels = 150, kStrips = 150, kSlowStrips = 400; // [ms] between drawings

const kOff = "Side view, twice a second, as set.";
const kNoGraphics: Record<Graphics, string> = {
  ready: "Side view, twice a second: drawing in three dimensions would slow the run down. It is tried again when the " +
    "run has kept its rates for a while.",
  lost: "Side view, twice a second: the browser has taken away the graphics context (WebGL). The picture in three " +
    "dimensions comes back with it; reload the page if that takes long.",
  none: "Side view, twice a second: this browser has no graphics context (WebGL 2) for three dimensions.",
};

export class Drawing {
  pictures = 0;
  still = false;
  private newest: Frame | null = null;
  private past: Frame | null = null; // an earlier moment, shown in place of the newest
  private inPanels: Frame | null = null;
  private inLive: Frame | null = null;
  private inView: Frame | null = null;
  private panelsAt = 0;
  private stripsAt = 0;
  private before = 0;
  private readonly fallback = new Fallback();
  /// whether the side view is shown
  flat = false;

  constructor(private readonly view: View, private readonly sideView: SideView, private readonly parts: Parts) {
    window.requestAnimationFrame((now) => this.draw(now));
  }

  show(frame: Frame): void { this.newest = frame; }
  /// The last frame is not of the present any more.
  lost(): void { this.inLive = this.newest; }
  /// Shows an earlier moment, or the newest frames again.
  showPast(frame: Frame | null): void {
    this.past = frame;
    this.again();
  }
  get shown(): Frame | null { return this.frame; }
  private get frame(): Frame | null { return this.past ?? this.newest; }
  /// Redraws everything in a new look.
  again(): void {
    this.inPanels = this.inView = null;
    this.sideView.again();
  }
  /// Turns the picture on again if it was switched off automatically, or had no graphics context.
  begin(): void {
    this.fallback.reset();
    this.view.begin();
  }

  private draw(now: number): void {
    window.requestAnimationFrame((next) => this.draw(next));
    const slow = this.view.pace.slow;
    if (this.newest !== null && now - this.panelsAt >= (slow ? kSlowPanels : kPanels)) {
      this.panelsAt = now;
      if (this.newest !== this.inLive) this.parts.live(this.newest, now);
      if (this.frame !== this.inPanels) this.parts.panels(this.frame!, now);
      this.inLive = this.newest;
      this.inPanels = this.frame;
    }
    const due = !this.still && this.frame !== null && now - this.stripsAt >= (slow ? kSlowStrips : kStrips);
    if (due) this.stripsAt = now;
    this.parts.strips(now, due);
    this.drawPicture(now);
  }

  private drawPicture(now: number): void {
    const { view } = this, mode = this.parts.mode();
    const held = this.parts.held(), pace = view.pace.state(now, held);
    if (mode === "auto" && this.fallback.update(now, pace.off, held)) view.pace.begin();
    const wished = this.still || mode === "on" || (mode === "auto" && !this.fallback.flat);
    const drawn = wished && view.graphics === "ready";
    this.tell(drawn, mode);
    this.parts.rate(!drawn ? 10 : view.pace.slow ? 15 : 30);
    if (!drawn && this.frame !== null) this.parts.side(this.frame, now);
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
    this.flat = this.view.eye.idle = !drawn;
    find("picture").dataset.drawn = String(drawn);
    find("no-picture").hidden = drawn;
    if (drawn) return;
    const { graphics } = this.view;
    setText(find("no-picture-why"), mode === "off" ? kOff : kNoGraphics[graphics]);
    // only the browser can restore a context that it took away
    find("draw-anyway").hidden = mode !== "off" && graphics === "lost";
  }
}
