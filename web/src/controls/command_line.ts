/// The command that begins a run as this one is now.

import { inWords } from "../address";
import type { State } from "../messages";

// controls that have an option of `prostm run`; the others go into a settings file
const kOptions: Record<string, string> = {
  scene: "--scene", grid: "--grid", method: "--method", preset: "--preset", paths: "--paths", switch: "--switch",
};
const kHands = ["scripted", "openxr", "page"]; // that --hand knows by name

const quoted = (text: string) => (/^[\w.:/-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

export interface CommandLine {
  command: string;
  /// what has to be known beside it, as sentences; "" when it is complete
  note: string;
}

// settings that those options set, and the time for a plan that a run in real time has by itself
const kSaid = [
  "pipeline.scene", "fluid.cells", "pipeline.method", "plan.preset", "plan.paths", "am.foci", "emit.foci", "emit.switch_at",
];
const kLiveBudget = "plan.budget = 0.002";

/// Whether a settings file says something that the options do not.
function needsFile(settings: string): boolean {
  let group = "";
  for (const line of settings.split("\n")) {
    const [key = ""] = line.split(" = ");
    if (line.startsWith("[")) group = line.slice(1, -1);
    else if (key !== "" && !kSaid.includes(`${group}.${key}`) && `${group}.${line}` !== kLiveBudget) return true;
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
