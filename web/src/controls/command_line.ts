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

/// Whether the settings file holds anything that the options do not.
function needsFile(settings: string): boolean {
  let group = "";
  for (const line of settings.split("\n")) {
    const [key = ""] = line.split(" = ");
    if (line.startsWith("[")) group = line.slice(1, -1);
    else if (key !== "" && !kSaid.includes(`${group}.${key}`)) return true;
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
  if (needsFile(state.settings)) {
    parts.push("--settings prostm.toml");
    notes.push("Some settings have no option: copy them as prostm.toml, too.");
  }
  return { command: parts.join(" "), note: notes.join(" ") };
}
