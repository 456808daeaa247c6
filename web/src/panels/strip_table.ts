/// The strips as a table in CSV (RFC 4180).

import type { History } from "./history";
import type { StripSpec } from "./strip_specs";

export interface TabledStrip {
  spec: StripSpec;
  history: History;
}

const kDigits = 7; // significant, as in the frames
const kLine = "\r\n";

function field(text: string): string {
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}
function cell(value: number | undefined): string {
  return value === undefined || !Number.isFinite(value) ? "" : String(Number(value.toPrecision(kDigits)));
}

/// One row a sample, after a row of names and units. The first column is the run time [s]; samples of a pause, which
/// repeat the run time, are left out. Empty cells have no value. @param times run times; @pre all strips have as many
/// samples.
export function stripTable(times: number[], strips: TabledStrip[]): string {
  const withUnit = (name: string, unit: string) => field(unit === "" ? name : `${name} [${unit}]`);
  const names = strips.flatMap(({ spec }) => spec.series.map((s) => withUnit(`${spec.title}: ${s.label}`, spec.unit)));
  const rows = [[withUnit("run time", "s"), ...names].join(",")];
  times.forEach((time, i) => {
    if (time === times[i - 1]) return;
    const values = strips.flatMap(({ history }) => history.values.map((row) => cell(row[i])));
    rows.push([String(Number(time.toFixed(4))), ...values].join(","));
  });
  return rows.join(kLine) + kLine;
}
