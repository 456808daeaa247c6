/// The last half minute of the program's numbers, as strips.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { find, fixed, make } from "../dom";
import { numberOf, type Frame, type NumberName } from "../wire";

const kSeconds = 30;

interface Series {
  label: string;
  value: (frame: Frame) => number;
  colour: [light: string, dark: string];
  digits?: number;
  dash?: number[];
}
interface StripSpec {
  id: string;
  title: string;
  unit: string;
  stacked?: boolean;
  atLeast: number; // the top of the axis is never lower
  atMost?: number; // nor higher
  series: Series[];
}

const of = (name: NumberName) => (frame: Frame) => numberOf(frame, name);
const kBlue: [string, string] = ["#0072b2", "#56b4e9"], kOrange: [string, string] = ["#b84e00", "#ff9a4d"], kGreen: [string, string] = ["#007a58", "#2fd0a5"];
const kViolet: [string, string] = ["#a3427f", "#e39ac6"], kYellow: [string, string] = ["#9a7000", "#f0c54a"], kGrey: [string, string] = ["#5c6675", "#a9b4c4"];

const kStrips: StripSpec[] = [
  {
    id: "stages", title: "Stages", unit: "ms", stacked: true, atLeast: 10, series: [
      { label: "fluid", value: of("world_ms"), colour: kBlue }, { label: "plan", value: of("plan_ms"), colour: kOrange },
      { label: "hand", value: of("hand_ms"), colour: kGreen }, { label: "contact", value: of("contact_ms"), colour: kViolet },
      { label: "track", value: of("track_ms"), colour: kYellow }, { label: "lift", value: of("lift_ms"), colour: kGrey },
    ],
  },
  {
    id: "rates", title: "Rates", unit: "Hz", atLeast: 30, series: [
      { label: "smoke", value: of("world_hz"), colour: kBlue, digits: 1 }, { label: "plans", value: of("plan_hz"), colour: kOrange, digits: 1 },
    ],
  },
  {
    id: "latency", title: "Latency", unit: "ms", atLeast: 10, series: [
      { label: "last", value: of("latency_ms"), colour: kBlue }, { label: "p50", value: of("latency_p50_ms"), colour: kGreen, dash: [6, 4] },
      { label: "p99", value: of("latency_p99_ms"), colour: kOrange, dash: [6, 4] },
    ],
  },
  {
    id: "blocks", title: "Blocks", unit: "", atLeast: 5, series: [
      { label: "late", value: of("late_blocks"), colour: kYellow, digits: 0 }, { label: "missed", value: of("missed_blocks"), colour: kOrange, digits: 0 },
      { label: "queue", value: of("queue_blocks"), colour: kGrey, digits: 0 },
    ],
  },
  {
    id: "quality", title: "Quality", unit: "", atLeast: 1, atMost: 1, series: [
      { label: "correlation", value: of("correlation"), colour: kBlue, digits: 2 }, { label: "coverage", value: of("coverage"), colour: kGreen, digits: 2 },
      { label: "skill", value: of("skill_8"), colour: kViolet, digits: 2 }, { label: "RMSE", value: of("rmse"), colour: kOrange, digits: 2 },
      { label: "felt", value: of("felt_skill"), colour: kGrey, digits: 2 },
    ],
  },
];

/// Values over time, those of more than half a minute ago dropped.
export class History {
  readonly times: number[] = [];
  readonly values: number[][];
  constructor(count: number) { this.values = Array.from({ length: count }, () => []); }
  add(time: number, values: number[]): void {
    this.times.push(time);
    values.forEach((v, i) => this.values[i]!.push(v));
    // in lumps, so that it costs little
    const old = this.times.findIndex((t) => t >= time - kSeconds - 1);
    if (old < 64) return;
    this.times.splice(0, old);
    for (const row of this.values) row.splice(0, old);
  }
}

class Strip {
  readonly plot: uPlot;
  private readonly history: History;
  private readonly readings: HTMLElement[];
  private readonly host: HTMLElement;

  /// @param last whether it stands at the foot, where the time is written
  constructor(readonly spec: StripSpec, private readonly last: boolean, private readonly dark: () => boolean) {
    this.history = new History(spec.series.length);
    this.readings = spec.series.map(() => make("b", {}, "–"));
    const legend = make("ul", { class: "legend" }, ...spec.series.map((s, i) => make("li", { "data-series": s.label }, make("i", { class: `swatch ${s.dash ? "dashed" : ""}` }), `${s.label} `, this.readings[i]!)));
    this.host = make("div", { class: "plot" });
    find("strips").append(make("section", { class: "strip", "aria-label": `${spec.title}, the last ${kSeconds} seconds`, "data-strip": spec.id },
      make("h3", {}, spec.title, make("small", {}, spec.unit)), legend, this.host));
    this.plot = new uPlot(this.options(), [[], ...spec.series.map(() => [])], this.host);
  }

  /// Stacked series are drawn from the tallest sum down, so that each covers the foot of the one before.
  private get order(): number[] {
    const all = [...this.spec.series.keys()];
    return this.spec.stacked ? all.reverse() : all;
  }
  private colour(i: number): string { return this.spec.series[i]!.colour[this.dark() ? 1 : 0]; }

  private options(): uPlot.Options {
    const style = (name: string) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    const { spec } = this;
    const axis = { stroke: () => style("--faint"), grid: { stroke: () => style("--line"), width: 1 }, ticks: { show: false }, font: "11px system-ui, sans-serif" };
    return {
      width: 300, height: 60, pxAlign: 1, legend: { show: false }, cursor: { show: false }, padding: [4, 14, this.last ? 0 : 6, 0],
      scales: {
        x: { time: false, range: () => [-kSeconds, 0] },
        y: { range: (_, __, most) => [0, spec.atMost ?? Math.max(spec.atLeast, (most ?? 0) * 1.08)] },
      },
      axes: [
        { ...axis, size: this.last ? 16 : 2, gap: 2, values: (_, ticks) => ticks.map((t) => (!this.last ? "" : t === 0 ? "now" : `${t} s`)), incrs: [10] },
        { ...axis, size: 34, gap: 4, space: 22 },
      ],
      series: [
        {},
        ...this.order.map((i): uPlot.Series => {
          const { label, dash } = spec.series[i]!;
          return {
            label, width: spec.stacked ? 0 : 1.5, stroke: () => this.colour(i), points: { show: false }, spanGaps: false,
            ...(spec.stacked ? { fill: () => this.colour(i) } : {}), ...(dash ? { dash } : {}),
          };
        }),
      ],
    };
  }

  add(frame: Frame, time: number): void {
    this.history.add(time, this.spec.series.map((s) => s.value(frame)));
    this.spec.series.forEach((s, i) => {
      const text = fixed(s.value(frame), s.digits ?? 1);
      if (this.readings[i]!.textContent !== text) this.readings[i]!.textContent = text;
    });
  }

  draw(now: number): void {
    const width = this.host.clientWidth, height = this.host.clientHeight;
    if (width < 40 || height < 20) return;
    if (this.plot.width !== width || this.plot.height !== height) this.plot.setSize({ width, height });
    const gap = (v: number) => (Number.isFinite(v) ? v : null);
    let rows: (number | null)[][] = this.history.values.map((row) => row.map(gap));
    if (this.spec.stacked) {
      const sums = this.history.times.map(() => 0);
      rows = this.history.values.map((row) => row.map((v, i) => (sums[i] = sums[i]! + (Number.isFinite(v) ? v : 0))));
    }
    this.plot.setData([this.history.times.map((t) => t - now), ...this.order.map((i) => rows[i]!)] as uPlot.AlignedData);
  }

  recolour(): void {
    this.readings.forEach((reading, i) => reading.parentElement?.querySelector<HTMLElement>(".swatch")?.style.setProperty("--swatch", this.colour(i)));
    this.plot.redraw(false);
  }
}

export class Strips {
  private dark = false;
  private readonly strips = kStrips.map((spec, i) => new Strip(spec, i === kStrips.length - 1, () => this.dark));
  add(frame: Frame, time: number): void { for (const s of this.strips) s.add(frame, time); }
  draw(now: number): void { for (const s of this.strips) s.draw(now); }
  setDark(dark: boolean): void {
    this.dark = dark;
    for (const s of this.strips) s.recolour();
  }
}
