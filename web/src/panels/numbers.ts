/// The numbers of the newest frame, folded: the most important ones, and all of them in a table. None is computed here.

import { tip } from "../controls/tips";
import { find, make, setText } from "../dom";
import { fixed } from "../text";
import { kNumbers, numberOf, type Frame, type NumberName } from "../wire";
import { kTiles } from "./tiles";

const kRun = ["sequence", "time_s", "recording_time_s", "world_steps", "plan_updates"] as const;

function runWords({ sequence, run }: Frame): Record<(typeof kRun)[number], string> {
  return {
    sequence: String(sequence), time_s: fixed(run.time, 3), recording_time_s: fixed(run.recordingTime, 3),
    world_steps: String(run.worldSteps), plan_updates: String(run.planUpdates),
  };
}

/// @param digits after the decimal point; −1: six significant ones.
function inDigits(value: number, digits: number): string {
  if (!Number.isFinite(value)) return "–";
  if (digits < 0) return String(Number(value.toPrecision(6)));
  return fixed(value, value >= 100 ? Math.max(0, digits - 1) : digits);
}

export class Numbers {
  private readonly values: { name: NumberName; digits: number; element: HTMLElement }[] = [];
  private readonly run = new Map<string, HTMLElement>();

  constructor() {
    const put = (name: NumberName, digits: number): HTMLElement => {
      const element = make("span", { class: "value", "data-number": name }, "–");
      this.values.push({ name, digits, element });
      return element;
    };
    for (const tile of kTiles) {
      const values = tile.parts.flatMap((p) => [put(p.name, p.digits), make("span", { class: "unit" }, p.after ?? "")]);
      const parts = [make("dt", {}, tile.label, " ", tip(tile.label, tile.help)), make("dd", {}, ...values)];
      find("tiles").append(make("div", { class: "tile" }, ...parts));
    }
    const body = make("tbody");
    const row = (name: string, cell: HTMLElement) =>
      body.append(make("tr", {}, make("th", { scope: "row" }, name), cell));
    for (const name of kRun) {
      const cell = make("td", { "data-run": name }, "–");
      this.run.set(name, cell);
      row(name, cell);
    }
    for (const name of kNumbers) row(name, make("td", {}, put(name, -1)));
    find("all-numbers").append(make("table", {}, body));
  }

  show(frame: Frame): void {
    for (const { name, digits, element } of this.values) setText(element, inDigits(numberOf(frame, name), digits));
    const words = runWords(frame);
    for (const name of kRun) setText(this.run.get(name)!, words[name]);
  }
}
