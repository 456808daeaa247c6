/// Measures how much a page slows down its run if the processor draws it: PROSTM=… npm run cost -- [ROUNDS]
/// Alternates runs without and with a page; "open" counts from 10 s on, when the page has been opened and drawn.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import "../../src/inspection";
import { clean, folder, openBrowser, Program } from "./program";

const kSeconds = 40, kOpened = 10;
const rounds = Number(process.argv[process.argv.length - 1]) || 5;

interface Count { run: { time: number; world_steps: number; plan_updates: number } }
interface Summary { world_rate_hz: number; plan_rate_hz: number; late_blocks: number; missed_blocks: number; blocks: number; latency_ms: { p50: number; p99: number } }
interface Result { summary: Summary; from: Count; to: Count; pictures: number }

const rate = (r: Result, key: "world_steps" | "plan_updates") => (r.to.run[key] - r.from.run[key]) / (r.to.run.time - r.from.run.time);
const columns: [string, (r: Result) => number][] = [
  ["open: smoke [Hz]", (r) => rate(r, "world_steps")],
  ["open: plans [Hz]", (r) => rate(r, "plan_updates")],
  ["all: smoke [Hz]", (r) => r.summary.world_rate_hz],
  ["all: plans [Hz]", (r) => r.summary.plan_rate_hz],
  ["all: late blocks [%]", (r) => (100 * r.summary.late_blocks) / r.summary.blocks],
  ["all: missed blocks [%]", (r) => (100 * r.summary.missed_blocks) / r.summary.blocks],
  ["all: latency p50 [ms]", (r) => r.summary.latency_ms.p50],
  ["all: latency p99 [ms]", (r) => r.summary.latency_ms.p99],
  ["pictures", (r) => r.pictures],
];
const wait = (seconds: number) => new Promise((resolve) => setTimeout(resolve, 1000 * seconds));

const browser = await openBrowser();

async function measure(withPage: boolean): Promise<Result> {
  const file = join(folder, "summary.json");
  const program = new Program(["--scene", "one-plume", "--seconds", String(kSeconds), "--json", file]);
  const page = withPage ? await browser.newPage({ viewport: { width: 1440, height: 900 } }) : null;
  try {
    await program.start();
    await page?.goto(program.address);
    await wait(kOpened);
    const from = (await program.numbers()) as unknown as Count;
    await wait(kSeconds - kOpened - 5);
    const to = (await program.numbers()) as unknown as Count;
    const pictures = (await page?.evaluate(() => window.prostm.pictures)) ?? 0;
    await program.ended();
    return { summary: JSON.parse(readFileSync(file, "utf8")) as Summary, from, to, pictures };
  } finally {
    await program.stop();
    await page?.close();
  }
}

const median = (values: number[]) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)]!;
const without: Result[] = [], withPage: Result[] = [];
try {
  for (let round = 0; round < rounds; ++round) {
    // alternates the order
    for (const shown of round % 2 === 0 ? [false, true] : [true, false]) (shown ? withPage : without).push(await measure(shown));
    console.log(`round ${round + 1} of ${rounds}`);
  }
} finally {
  await browser.close();
  clean();
}
console.log(`${rounds} runs of ${kSeconds} s each, medians`);
for (const [name, value] of columns) {
  const [one, other] = [without, withPage].map((results) => median(results.map(value)).toFixed(2).padStart(8));
  console.log(`${name.padEnd(24)} ${one} without, ${other} with a page`);
}
