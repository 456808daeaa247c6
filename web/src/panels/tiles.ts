/// The numbers shown in large type.

import { fixed } from "../text";
import { numberOf, type Frame, type NumberName } from "../wire";

interface Tile {
  label: string;
  help: string;
  parts: { name: NumberName; digits: number; after?: string }[];
}
export const kTiles: Tile[] = [
  {
    label: "Shape by Eq. (1)",
    help: "Of the played field with the target: 1 is perfect, 0 is no better than an even field",
    parts: [{ name: "skill_0", digits: 2 }],
  },
  {
    label: "Felt shape",
    help: "Of what a model of the skin feels with the target, on the same scale; every five seconds",
    parts: [{ name: "felt_skill", digits: 2 }],
  },
  {
    label: "Felt strength",
    help: "Of the strongest place, above the threshold of touch; below 0 most people feel nothing; every five seconds",
    parts: [{ name: "sensation_level", digits: 0, after: "dB" }],
  },
  { label: "Spill", help: "Share of the played pressure beside the target", parts: [{ name: "spill", digits: 3 }] },
  {
    label: "Latency p50 · p99",
    help: "From a hand's movement to the first sample planned from it, over the last ten seconds; none without a hand",
    parts: [{ name: "latency_p50_ms", digits: 1, after: "·" }, { name: "latency_p99_ms", digits: 1, after: "ms" }],
  },
  {
    label: "Missed blocks", help: "Dropouts since the start: blocks of samples that came too late to be played",
    parts: [{ name: "missed_blocks", digits: 0 }],
  },
];

/// The tiles as text.
export function tileWords(frame: Frame): string[] {
  const part = (p: Tile["parts"][number]) => `${fixed(numberOf(frame, p.name), p.digits)} ${p.after ?? ""}`.trim();
  return kTiles.map((t) => `${t.label} ${t.parts.map(part).join(" ")}`);
}
