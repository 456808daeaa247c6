/// The numbers of the newest frame: six large ones, and all of them in a table. None is computed here.

import { find, fixed, make } from "../dom";
import { kNumbers, numberOf, type Frame, type NumberName } from "../wire";

interface Tile {
  label: string;
  help: string;
  parts: { name: NumberName; digits: number; after?: string }[];
}
const kTiles: Tile[] = [
  { label: "Plans", help: "Plans in the last second", parts: [{ name: "plan_hz", digits: 1, after: "Hz" }] },
  { label: "Latency p50 · p99", help: "From a hand's movement to the first sample planned from it, over the last ten seconds", parts: [{ name: "latency_p50_ms", digits: 1, after: "·" }, { name: "latency_p99_ms", digits: 1, after: "ms" }] },
  { label: "Correlation", help: "Of what is played, by Eq. (1) with sigma_mm, with the target", parts: [{ name: "correlation", digits: 3 }] },
  { label: "RMSE", help: "Of what is played, by Eq. (1) with sigma_mm, as a share of the largest target pressure", parts: [{ name: "rmse", digits: 3 }] },
  { label: "Largest target", help: "The largest target pressure now", parts: [{ name: "max_target_pa", digits: 2, after: "Pa" }] },
  { label: "Missed", help: "Blocks of samples that the array had to do without, since the start", parts: [{ name: "missed_blocks", digits: 0 }] },
];

export class Numbers {
  private readonly values = new Map<NumberName, HTMLElement[]>();
  private readonly digits = new Map<HTMLElement, number>();
  private readonly run = new Map<string, HTMLElement>();

  constructor() {
    const put = (name: NumberName, digits: number): HTMLElement => {
      const element = make("span", { class: "value", "data-number": name }, "–");
      this.values.set(name, [...(this.values.get(name) ?? []), element]);
      this.digits.set(element, digits);
      return element;
    };
    for (const tile of kTiles) {
      const values = tile.parts.flatMap((p) => [put(p.name, p.digits), make("span", { class: "unit" }, p.after ?? "")]);
      find("tiles").append(make("div", { class: "tile", title: tile.help }, make("dt", {}, tile.label), make("dd", {}, ...values)));
    }

    const body = make("tbody");
    for (const name of ["sequence", "time_s", "recording_time_s", "world_steps", "plan_updates"]) {
      const cell = make("td", { "data-run": name }, "–");
      this.run.set(name, cell);
      body.append(make("tr", {}, make("th", { scope: "row" }, name), cell));
    }
    for (const name of kNumbers) body.append(make("tr", {}, make("th", { scope: "row" }, name), make("td", {}, put(name, -1))));
    find("all-numbers").append(make("table", {}, body));
  }

  show(frame: Frame): void {
    const set = (element: HTMLElement | undefined, text: string) => {
      if (element !== undefined && element.textContent !== text) element.textContent = text;
    };
    for (const [name, elements] of this.values) {
      const value = numberOf(frame, name);
      for (const element of elements) {
        const digits = this.digits.get(element) ?? -1;
        set(element, digits >= 0 ? fixed(value, value >= 100 ? Math.max(0, digits - 1) : digits) : Number.isFinite(value) ? String(Number(value.toPrecision(6))) : "–");
      }
    }
    set(this.run.get("sequence"), String(frame.sequence));
    set(this.run.get("time_s"), fixed(frame.run.time, 3));
    set(this.run.get("recording_time_s"), fixed(frame.run.recordingTime, 3));
    set(this.run.get("world_steps"), String(frame.run.worldSteps));
    set(this.run.get("plan_updates"), String(frame.run.planUpdates));
  }

  /// The large numbers as a line of text.
  static caption(frame: Frame): string {
    const part = (p: Tile["parts"][number]) => `${fixed(numberOf(frame, p.name), p.digits)} ${p.after ?? ""}`.trim();
    return kTiles.map((t) => `${t.label} ${t.parts.map(part).join(" ")}`).join("    ");
  }
}
