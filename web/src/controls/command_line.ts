/// The command that starts a run with the current settings.

import { inWords } from "../address";
import type { State } from "../messages";

// controls that have an option of `prostm run`; a settings file holds the others
const kOptions: Record<string, string> = {
  scene: "--scene", grid: "--grid", method: "--method", preset: "--preset", paths: "--paths", switch: "--switch",
};
const kHands = ["scripted", "openxr", "page"]; // sources that --hand accepts by name

const quoted = (text: string) => (/^[\w.:/-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

export interface CommandLine {
  command: string;
  /// what the command does not cover, as sentences; "" when it is complete
  note: string;
}

// settings covered by those options
const kSaid = [
  "pipeline.scene", "fluid.cells", "pipeline.method", "plan.preset", "plan.paths", "am.foci", "emit.foci", "emit.switch_at",
];
// time budgets that a real-time run sets itself, by preset [s]
const kLiveBudgets: Record<string, string> = { best: "0.002", felt: "0.02" };

/// Whether the settings file holds anything that the options do not.
function needsFile(settings: string, preset: string): boolean {
  let group = "";
  for (const line of settings.split("\n")) {
    const [key = "", value] = line.split(" = ");
    const name = `${group}.${key}`;
    if (line.startsWith("[")) group = line.slice(1, -1);
    else if (key !== "" && !kSaid.includes(name) && (name !== "plan.budget" || value !== kLiveBudgets[preset])) return true;
  }
  return false;
}

export function commandLine(state: State): CommandLine {
  const parts = ["prostm run --view"];
  const notes: string[] = [];
  for (const control of state.controls) {
    const option = kOptions[control.id];
    if (option !== undefined && control.enabled) parts.push(`${option} ${quoted(inWords(control.value))}`);
  }
  const { base } = state.transport;
  if (kHands.includes(base)) parts.push(`--hand ${base}`);
  else notes.push(`Add --hand and ${base === "recording" ? "the recording's file" : "the tracker's address"}.`);
  const preset = state.controls.find((control) => control.id === "preset");
  if (needsFile(state.settings, inWords(preset?.value ?? "best"))) {
    parts.push("--settings prostm.toml");
    notes.push("Some settings have no option: copy them as prostm.toml, too.");
  }
  return { command: parts.join(" "), note: notes.join(" ") };
}
