/// The three-dimensional simulation, shown while frames arrive.

import type { Hello } from "../messages";
import { View } from "../scene/view";
import type { Frame } from "../wire";
import { find } from "../dom";

const kDrawn = 2000; // time after the last picture in which drawing counts as active [ms]
const kKept = 1000; // time after the last frame before the picture is hidden [ms]

export class Picture {
  private view: View | null = null; // created on demand: many participants never see it
  private hello: Hello | null = null;
  private frame: Frame | null = null;
  private drawn: Frame | null = null;
  private came = -Infinity; // time of the last frame [ms]
  private before = 0;
  private lost = false; // whether its WebGL context is lost

  /// Whether the newest frames are drawn.
  get draws(): boolean { return !this.lost && this.before > 0 && performance.now() - this.before < kDrawn; }

  constructor(private readonly canvas: HTMLCanvasElement) {
    canvas.addEventListener("webglcontextlost", () => (this.lost = true));
    canvas.addEventListener("webglcontextrestored", () => (this.lost = false));
    window.requestAnimationFrame((now) => this.draw(now));
  }

  setHello(hello: Hello): void {
    this.hello = hello;
    this.view?.setHello(hello);
  }
  show(frame: Frame): void {
    this.frame = frame;
    this.came = performance.now();
  }

  private draw(now: number): void {
    window.requestAnimationFrame((next) => this.draw(next));
    const on = this.frame !== null && now - this.came < kKept;
    if (on) this.view ??= this.make();
    const { view } = this, shown = on && view?.graphics === "ready";
    find("picture").hidden = !shown;
    if (!shown) return;
    if (!view.ready(now, view.pace.slow ? 100 : 0)) return;
    if (this.frame !== this.drawn) view.setFrame(this.frame!);
    this.drawn = this.frame;
    view.render(this.before === 0 ? 0 : (now - this.before) / 1000);
    this.before = now;
  }

  private make(): View {
    const view = new View(this.canvas);
    if (this.hello !== null) view.setHello(this.hello);
    const dark = document.documentElement.dataset.theme === "dark";
    view.setDark(dark);
    view.array.setDark(dark);
    view.setField("none");
    // shows smoke and hand, not how they are rendered
    view.paths.group.visible = view.ruler.group.visible = false;
    return view;
  }
}
