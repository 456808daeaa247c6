/// The text above and below a screenshot of the page.

import { inWords } from "../address";
import type { Control, State } from "../messages";
import { tileWords } from "../panels/tiles";
import { short } from "../text";
import type { Frame } from "../wire";

/// For example "Paths 4", with the value formatted for readers.
function turned(c: Control): string {
  if (c.kind === "choice") return `${c.label} ${c.choices.find((x) => x.value === c.value)?.label ?? c.value}`;
  if (c.kind === "switch") return `${c.label} ${c.value ? "on" : "off"}`;
  return `${c.label} ${inWords(c.value)}${c.unit ? ` ${c.unit}` : ""}`;
}

/// @param scale the pressure at the end of the colours [Pa].
export function caption(
  frame: Frame | null, state: State | null, scale: number, date: Date,
): { title: string; parts: string[] } {
  const day = date.toISOString().replace("T", " ").slice(0, 19);
  if (frame === null) return { title: `prostm · ${day} UTC`, parts: [] };
  // omits controls that have no effect now, such as AM's modulation while PRO-STM runs
  const settings = (state?.controls ?? []).filter((c) => c.enabled).map(turned);
  const scales = `colours: 0 to ${short(scale)} Pa, difference ±${short(scale)} Pa; bar in the planes: 50 mm`;
  return {
    title: `prostm · ${frame.run.time.toFixed(2)} s of the run · ${day} UTC`,
    parts: [...tileWords(frame), scales, ...settings],
  };
}
