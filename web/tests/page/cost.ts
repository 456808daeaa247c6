/// Measures what a page costs the run that it shows, where the processor draws it: PROSTM=… npm run cost -- [ROUNDS]
/// Runs without and with a page in turns. The page is opened while the run goes on, so its start counts too.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import "../../src/inspection";
import { clean, folder, openBrowser, Program } from "./program";

const kSeconds = 30;
const rounds = Number(process.argv[process.argv.length - 1]) || 5;
const browser = await openBrowser();

interface Summary { world_rate_hz: number; plan_rate_hz: number; skipped_world_steps: number; late_blocks: number; missed_blocks: number; blocks: number; latency_ms: { p50: number; p99: number } }
const columns: [string, (s: Summary) => number][] = [
  ["smoke [Hz]", (s) => s.world_rate_hz],
  ["plans [Hz]", (s) => s.plan_rate_hz],
  ["late blocks [%]", (s) => (100 * s.late_blocks) / s.blocks],
  ["missed blocks [%]", (s) => (100 * s.missed_blocks) / s.blocks],
  ["latency p50 [ms]", (s) => s.latency_ms.p50],
  ["latency p99 [ms]", (s) => s.latency_ms.p99],
];
type Kind = "without a page" | "with a page";
const results: Record<Kind, Summary[]> = { "without a page": [], "with a page": [] };
let drawn = 0;

async function measure(kind: Kind): Promise<void> {
  const file = join(folder, "summary.json");
  const program = new Program(["--scene", "one-plume", "--seconds", String(kSeconds), "--json", file]);
  try {
    await program.start();
    if (kind === "with a page") {
      const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
      await page.goto(program.address);
      await page.waitForTimeout(1000 * (kSeconds - 5));
      drawn += await page.evaluate(() => window.prostm.pictures);
      await program.ended();
      await page.close();
    } else {
      await program.ended();
    }
    results[kind].push(JSON.parse(readFileSync(file, "utf8")) as Summary);
  } finally {
    await program.stop();
  }
}

const median = (values: number[]) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)]!;

try {
  for (let round = 0; round < rounds; ++round) {
    // first the one, then the other
    for (const kind of round % 2 === 0 ? ["without a page", "with a page"] as const : ["with a page", "without a page"] as const) await measure(kind);
    console.log(`round ${round + 1} of ${rounds}`);
  }
} finally {
  await browser.close();
  clean();
}
console.log(`${rounds} runs of ${kSeconds} s each, medians; pages drew ${(drawn / rounds).toFixed(0)} pictures a run`);
for (const [name, value] of columns) {
  const [without, withPage] = (["without a page", "with a page"] as const).map((kind) => median(results[kind].map(value)));
  console.log(`${name.padEnd(18)} ${without!.toFixed(2).padStart(8)} without, ${withPage!.toFixed(2).padStart(8)} with a page`);
}
