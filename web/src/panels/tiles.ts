/// The numbers shown in large type.

import { fixed } from "../text";
import { numberOf, type Frame, type NumberName } from "../wire";

interface Tile {
  label: string;
  help: string;
  parts: { name: NumberName; digits: number; after?: string }[];
}
export const kTiles: Tile[] = [
  { label: "Plans", help: "Plans in the last second", parts: [{ name: "plan_hz", digits: 1, after: "Hz" }] },
  {
    label: "Latency p50 · p99",
    help: "From a hand's movement to the first sample planned from it, over the last ten seconds; none without a hand",
    parts: [{ name: "latency_p50_ms", digits: 1, after: "·" }, { name: "latency_p99_ms", digits: 1, after: "ms" }],
  },
  {
    label: "Correlation", help: "Of the played field with the target, by Eq. (1) with sigma_mm; 1 is best",
    parts: [{ name: "correlation", digits: 3 }],
  },
  {
    label: "RMSE",
    help: "Of the played field, by Eq. (1) with sigma_mm, relative to the largest target pressure; 0 is best",
    parts: [{ name: "rmse", digits: 3 }],
  },
  {
    label: "Largest target", help: "The largest target pressure now",
    parts: [{ name: "max_target_pa", digits: 2, after: "Pa" }],
  },
  {
    label: "Missed", help: "Dropouts since the start: blocks of samples that came too late to be played",
    parts: [{ name: "missed_blocks", digits: 0 }],
  },
];

/// The tiles as text.
export function tileWords(frame: Frame): string[] {
  const part = (p: Tile["parts"][number]) => `${fixed(numberOf(frame, p.name), p.digits)} ${p.after ?? ""}`.trim();
  return kTiles.map((t) => `${t.label} ${t.parts.map(part).join(" ")}`);
}
