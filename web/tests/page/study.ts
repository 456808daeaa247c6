/// Runs prostm study run for tests.

import type { ChildProcess } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { folder, spawnProgram, type Json } from "./program";

/// A study with short trials and a hand that is not tracked.
export function protocol(more: string): string {
  const file = join(folder, `${Math.random().toString(36).slice(2)}.toml`);
  writeFileSync(file, `${more}
[scene.one-plume]
question = "Is there one plume?"
[scene.four-plumes]
question = "Are there four plumes?"
[method.am.pipeline]
method = "am"
[method.am.fluid]
cells = 32
[method.pro-stm.fluid]
cells = 32
`);
  return file;
}

export class Study {
  url = "";
  printed = "";
  private child: ChildProcess | null = null;
  constructor(readonly protocol: string, readonly participant: number, readonly answers = join(folder, "answers")) {}

  async start(...options: string[]): Promise<void> {
    const all = ["study", "run", this.protocol, "--participant", String(this.participant), "--answers", this.answers, "--view-port", "0", ...options];
    const child = spawnProgram(all);
    this.child = child;
    this.printed = "";
    await new Promise<void>((resolve, reject) => {
      const read = (data: Buffer) => {
        this.printed += data.toString();
        const found = /experimenter: (\S+)\nparticipant:/.exec(this.printed);
        if (found !== null) [this.url] = found.slice(1) as [string], resolve();
      };
      child.stdout.on("data", read);
      child.stderr.on("data", read);
      child.on("exit", () => reject(new Error(this.printed)));
    });
  }
  async ended(): Promise<number | null> {
    const { child } = this;
    if (child!.exitCode === null && child!.signalCode === null) await new Promise((resolve) => child!.once("exit", resolve));
    return child!.exitCode;
  }
  async kill(signal: NodeJS.Signals = "SIGKILL"): Promise<void> {
    this.child?.kill(signal);
    await this.ended();
  }
  lines(): Json[] {
    const text = readFileSync(join(this.answers, `participant-${this.participant}.jsonl`), "utf8");
    return text.split("\n").slice(0, -1).map((line) => JSON.parse(line) as Json);
  }
  trials(): Json[] { return this.lines().filter((line) => line.kind === "trial"); }
}

/// Waits until a page shows a phase of the session.
export const comes = (page: Page, wanted: string) =>
  page.waitForFunction((p) => document.documentElement.dataset.phase === p, wanted, { polling: 20, timeout: 30_000 });
