/// One strip: a few numbers over time.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { find, make, setText } from "../dom";
import { fixed } from "../text";
import type { Frame } from "../wire";
import { beyond, History, PerSecond, robustTop } from "./history";
import type { StripSpec } from "./strip_specs";

/// The state that all strips share.
export interface StripsView {
  span: number; // [s]
  now: number; // the right end [s, page's clock]
  past: boolean; // whether the right end is an earlier moment
  at: number | null; // the pointer's time [s before `now`, at most 0]
}

const kBetter = { higher: "↑ better", lower: "↓ better" } as const;
const kIncrements: Record<number, number[]> = { 10: [2, 5], 30: [10, 15], 120: [30, 60] }; // of the time axis [s]
const kMarkGap = 4; // smallest distance between marks of clipped values [pixels]

export class Strip {
  readonly plot: uPlot;
  private readonly history: History;
  private kept: History | null = null; // the values shown while frozen
  private readonly rates: (PerSecond | null)[];
  private readonly readings: HTMLElement[];
  private readonly host = make("div", { class: "plot" });
  private view: StripsView = { span: 30, now: 0, past: false, at: null };
  private top = 1;
  private cut = beyond([], [], 0, 0); // times of samples outside the axis [s before now]

  /// @param last whether it is the lowest strip, which shows the time axis
  constructor(readonly spec: StripSpec, private readonly last: boolean, private readonly dark: () => boolean) {
    this.history = new History(spec.series.length);
    this.rates = spec.series.map((s) => (s.counts ? new PerSecond() : null));
    this.readings = spec.series.map(() => make("b", {}, "–"));
    const items = spec.series.map((s, i) => {
      const swatch = make("i", { class: `swatch ${s.dash ? "dashed" : ""}` });
      return make("li", { "data-series": s.label }, swatch, `${s.label} `, this.readings[i]!);
    });
    const words = [spec.unit, spec.better ? kBetter[spec.better] : ""].filter((w) => w !== "").join(" · ");
    const head = make("div", { class: "strip-head" }, make("h3", {}, spec.title), " ", make("small", {}, words));
    find("strips").append(make(
      "section", { class: "strip", "aria-label": `${spec.title} over time`, "data-strip": spec.id },
      head, make("ul", { class: "legend" }, ...items), this.host,
    ));
    this.plot = new uPlot(this.options(), [[], ...spec.series.map(() => [])], this.host);
  }

  /// Stacked series are drawn from the largest sum down, so that each covers the lower part of the one before.
  private get order(): number[] {
    const all = [...this.spec.series.keys()];
    return this.spec.stacked ? all.reverse() : all;
  }
  private colour(i: number): string { return this.spec.series[i]!.colour[this.dark() ? 1 : 0]; }

  private options(): uPlot.Options {
    const style = (name: string) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    const { spec } = this;
    const axis = {
      stroke: () => style("--faint"), grid: { stroke: () => style("--line"), width: 1 }, ticks: { show: false },
      font: "12px system-ui, sans-serif",
    };
    // the left end has no label: it would overlap the 0 of the other axis
    const label = (t: number) => (t === 0 ? (this.view.past ? "then" : "now") : t <= -this.view.span ? "" : `−${-t} s`);
    return {
      width: 300, height: 60, pxAlign: 1, legend: { show: false }, cursor: { show: false },
      padding: [6, 14, this.last ? 0 : 6, 0],
      scales: {
        x: { time: false, range: () => [-this.view.span, 0] },
        y: { range: () => [spec.bottom ?? 0, this.top] },
      },
      axes: [
        {
          ...axis, size: this.last ? 18 : 2, gap: 2,
          values: (_, ticks) => ticks.map((t) => (this.last ? label(t) : "")),
          incrs: () => kIncrements[this.view.span] ?? [10, 30],
        },
        { ...axis, size: 38, gap: 4, space: 12 },
      ],
      series: [
        {},
        ...this.order.map((i): uPlot.Series => {
          const { label: name, dash } = spec.series[i]!;
          return {
            label: name, width: spec.stacked ? 0 : 1.5, stroke: () => this.colour(i), points: { show: false },
            spanGaps: false,
            ...(spec.stacked ? { fill: () => this.colour(i) } : {}), ...(dash ? { dash } : {}),
          };
        }),
      ],
      hooks: { draw: [(plot) => this.mark(plot, style("--bad"), style("--ink"))] },
    };
  }

  /// Marks values clipped at the top and at the bottom, and the pointer's time.
  private mark(plot: uPlot, cutColour: string, lineColour: string): void {
    const { ctx, bbox } = plot;
    const ratio = window.devicePixelRatio || 1;
    ctx.save();
    ctx.fillStyle = cutColour;
    this.triangles(plot, this.cut.above, bbox.top, -ratio);
    this.triangles(plot, this.cut.below, bbox.top + bbox.height, ratio);
    if (this.view.at !== null) {
      ctx.fillStyle = lineColour;
      ctx.fillRect(Math.round(plot.valToPos(this.view.at, "x", true)), bbox.top, ratio, bbox.height);
    }
    ctx.restore();
  }

  /// Draws triangles that point out of the plot at one of its edges.
  /// @param out one page pixel outwards; negative for upwards.
  private triangles({ ctx, valToPos }: uPlot, times: number[], edge: number, out: number): void {
    const pixel = Math.abs(out);
    let before = -Infinity;
    for (const t of times) {
      const x = valToPos(t, "x", true);
      if (x - before < kMarkGap * pixel) continue;
      before = x;
      ctx.beginPath();
      ctx.moveTo(x, edge + 5 * out);
      ctx.lineTo(x - 3.5 * pixel, edge - out);
      ctx.lineTo(x + 3.5 * pixel, edge - out);
      ctx.fill();
    }
  }

  add(frame: Frame, time: number): void {
    this.history.add(time, this.spec.series.map((s, i) => this.rates[i]?.add(time, s.value(frame)) ?? s.value(frame)));
  }

  /// The values shown.
  get shown(): History { return this.kept ?? this.history; }

  /// Freezes the strip with its present values, or resumes it.
  freeze(frozen: boolean): void { this.kept = frozen ? this.history.copy() : null; }

  /// The time at a position of the page, in seconds before the right end; null outside the strip.
  timeAt(clientX: number, clientY: number): number | null {
    const box = this.plot.over.getBoundingClientRect();
    const inside = clientX >= box.left && clientX <= box.right && clientY >= box.top && clientY <= box.bottom;
    return inside && box.width > 0 ? ((clientX - box.left) / box.width - 1) * this.view.span : null;
  }

  draw(view: StripsView): void {
    this.view = view;
    const history = this.shown;
    this.read(history);
    const width = this.host.clientWidth, height = this.host.clientHeight;
    if (width < 40 || height < 20) return;
    if (this.plot.width !== width || this.plot.height !== height) this.plot.setSize({ width, height });

    const first = history.after(view.now - view.span - 1), last = view.past ? history.after(view.now + 1) : undefined;
    const times = history.times.slice(first, last).map((t) => t - view.now);
    let rows = history.values.map((row) => row.slice(first, last));
    if (this.spec.stacked) {
      const sums = times.map(() => 0);
      rows = rows.map((row) => row.map((v, i) => (sums[i] = sums[i]! + (Number.isFinite(v) ? v : 0))));
    }
    this.scale(times, rows);
    const gaps = rows.map((row) => row.map((v) => (Number.isFinite(v) ? v : null)));
    this.plot.setData([times, ...this.order.map((i) => gaps[i]!)] as uPlot.AlignedData);
  }

  private scale(times: number[], rows: number[][]): void {
    this.top = this.spec.atMost ?? Math.max(...rows.map((row) => robustTop(row, this.spec.atLeast)));
    this.cut = beyond(times, rows, this.spec.bottom ?? 0, this.top);
  }

  /// Shows the newest values, or those at the pointer.
  private read(history: History): void {
    const newest = this.view.at === null && this.kept === null && !this.view.past;
    const at = newest ? history.times.length - 1 : history.nearest(this.view.now + (this.view.at ?? 0));
    this.spec.series.forEach((s, i) => setText(this.readings[i]!, fixed(history.values[i]![at] ?? NaN, s.digits ?? 1)));
  }

  recolour(): void {
    this.readings.forEach((reading, i) => {
      reading.parentElement?.querySelector<HTMLElement>(".swatch")?.style.setProperty("--swatch", this.colour(i));
    });
    this.plot.redraw(false);
  }
}
