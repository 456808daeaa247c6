/// The program's numbers over time, as strips with a common time axis that can be zoomed, frozen and inspected.

import { kSpans, type Address } from "../address";
import { find, make, setText } from "../dom";
import { onPoint } from "../pointing";
import type { Frame } from "../wire";
import { History } from "./history";
import { Strip } from "./strip";
import { stripTable } from "./strip_table";
import { kStrips } from "./strip_specs";

export class Strips {
  private dark = false;
  private readonly strips = kStrips.map((spec, i) => new Strip(spec, i === kStrips.length - 1, () => this.dark));
  private readonly button = find<HTMLButtonElement>("freeze");
  private frozenAt: number | null = null;
  private then: number | null = null; // an earlier moment, at the right end [s, page's clock]
  private readonly runTimes = new History(1); // of the samples [s]
  private keptTimes: History | null = null; // the run times while frozen
  private at: number | null = null;
  private span: number;
  private stale = true; // something other than the time has changed

  constructor(private readonly address: Address) {
    this.span = address.state.span ?? 30;
    for (const span of kSpans) {
      const radio = make("input", { type: "radio", name: "span", id: `span-${span}`, checked: span === this.span });
      radio.addEventListener("change", () => radio.checked && this.setSpan(span));
      find("span").append(radio, make("label", { for: `span-${span}` }, `${span} s`));
    }
    this.button.addEventListener("click", () => this.toggle());
    onPoint(find("strips"), (at) => this.point(at?.x ?? NaN, at?.y ?? NaN));
  }

  add(frame: Frame, time: number): void {
    this.runTimes.add(time, [frame.run.time]);
    for (const s of this.strips) s.add(frame, time);
  }

  /// All samples of the strips as CSV.
  table(): string {
    return stripTable((this.keptTimes ?? this.runTimes).values[0]!, this.strips.map((s) => ({ spec: s.spec, history: s.shown })));
  }

  /// Ends the strips at an earlier moment. @param then of the page's clock [s]; null for the present.
  rewind(then: number | null): void {
    this.then = then;
    this.stale = true;
  }

  /// @param now the page's clock [s]. @param due whether to redraw them for the time alone.
  draw(now: number, due: boolean): void {
    if (!this.stale && (!due || this.frozenAt !== null || this.then !== null)) return;
    this.stale = false;
    const view = { span: this.span, now: this.then ?? this.frozenAt ?? now, past: this.then !== null, at: this.at };
    for (const s of this.strips) s.draw(view);
  }

  get frozen(): boolean { return this.frozenAt !== null; }
  toggle(): void {
    this.frozenAt = this.frozen ? null : performance.now() / 1000;
    this.keptTimes = this.frozen ? this.runTimes.copy() : null;
    for (const s of this.strips) s.freeze(this.frozen);
    this.button.setAttribute("aria-pressed", String(this.frozen));
    setText(this.button.querySelector("span")!, this.frozen ? "Go on" : "Freeze");
    this.tell();
  }

  setDark(dark: boolean): void {
    this.dark = dark;
    for (const s of this.strips) s.recolour();
    this.stale = true;
  }

  private setSpan(span: number): void {
    this.span = span;
    this.address.set({ span: span === 30 ? undefined : span });
    this.stale = true;
  }
  private point(x: number, y: number): void {
    this.at = this.strips.map((s) => s.timeAt(x, y)).find((t) => t !== null) ?? null;
    this.tell();
  }
  private tell(): void {
    this.stale = true;
    const place = this.at === null ? "" : `values ${(-this.at).toFixed(1)} s ${this.frozen || this.then !== null ? "before the end" : "ago"}`;
    setText(find("strips-at"), place || (this.frozen ? "frozen" : ""));
  }
}
