/// A study of 16 people from the first trial to the last, in the browser, with simulated hands and answers. The program is
/// killed at 20 random times. Takes about ten minutes: PROSTM=… npm run whole-study

import { readFileSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { clean, folder, openBrowser, type Json } from "./program";
import { comes, protocol, Study } from "./study";

const kPeople = 16, kTrials = 16, kKills = 20;

/// Uniform in [0, 1), repeatable (mulberry32).
let seed = 7;
function random(): number {
  seed = (seed + 0x6d2b79f5) | 0;
  let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
  return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
}

function check(holds: boolean, what: string): void {
  if (!holds) throw new Error(`does not hold: ${what}`);
}

/// All bytes that the participant's page receives, in messages and files.
const bytes: string[] = [];
function listen(page: Page): void {
  page.on("websocket", (socket) => socket.on("framereceived", ({ payload }) => bytes.push(payload.toString("latin1"))));
  page.on("response", (response) => void response.text().then((text) => bytes.push(text), () => undefined));
}

const file = protocol('[study]\ntitle = "Plumes"\nseed = 11\nparticipants = 16\n[training]\nseconds = 1\n[trials]\nrepeats = 8\nrest = 0.1\nsettle = 0.5\ngate = "noted"');
const kills = Array.from({ length: kKills }, () => Math.floor(random() * kPeople * kTrials)).sort((a, b) => a - b);
const browser = await openBrowser();
let given = 0, killed = 0, doubled = 0, lost = 0;

async function open(study: Study): Promise<[Page, Page]> {
  const [experimenter, participant] = [await browser.newPage(), await browser.newPage()];
  listen(participant);
  await experimenter.goto(study.url);
  await participant.goto(`${study.url}participant`);
  // without training, or after it
  await comes(experimenter, "ready");
  await experimenter.keyboard.press("Enter");
  return [experimenter, participant];
}

/// Answers until all trials are answered or the program is killed. @return whether all are answered.
async function answer(study: Study, [experimenter, participant]: [Page, Page]): Promise<boolean> {
  while (study.trials().length < kTrials) {
    await comes(experimenter, "presenting");
    const before = study.trials().length;
    if (killed < kKills && given >= kills[killed]!) {
      const wait = 30 * random();
      if (random() < 0.5) await experimenter.keyboard.press("n");
      await experimenter.waitForTimeout(wait); // at any stage of handling the answer
      await study.kill();
      ++killed;
      const after = study.trials().length;
      check(after === before || after === before + 1, "a kill costs the trial under way at most");
      given += after - before;
      return true;
    }
    await participant.waitForFunction(() => !document.getElementById("asked")!.hidden);
    await experimenter.keyboard.press(random() < 0.5 ? "y" : "n");
    await experimenter.waitForFunction((done) => document.querySelector("progress")!.value === done, before + 1);
    ++given;
  }
  return false;
}

for (let person = 1; person <= kPeople; ++person) {
  const study = new Study(file, person);
  for (let start = 0; ; ++start) {
    await study.start(...(start === 0 ? [] : ["--resume"]));
    const pages = await open(study);
    const dead = await answer(study, pages);
    if (!dead) await pages[0].keyboard.press("Enter");
    if (!dead) check((await study.ended()) === 0, "the program ends by itself");
    for (const page of pages) await page.close();
    if (!dead || study.trials().length === kTrials) break;
  }
  const numbers = study.trials().map((t) => t.trial as number);
  doubled += numbers.length - new Set(numbers).size;
  lost += kTrials - new Set(numbers).size;
  console.log(`participant ${person}: ${numbers.length} trials, ${killed} of ${kKills} kills so far`);
}
await browser.close();

const all = Array.from({ length: kPeople }, (_, i) => {
  const text = readFileSync(join(folder, "answers", `participant-${i + 1}.jsonl`), "utf8");
  return text.split("\n").slice(0, -1).map((line) => JSON.parse(line) as Json).filter((line) => line.kind === "trial");
});
const methods = all.map((trials) => new Set(trials.map((t) => t.method)));
check(methods.every((m) => m.size === 1), "each participant has one method");
const am = methods.filter((m) => m.has("am")).length;
/// χ² of two counts that should be equal; it exceeds 6.63 in one of a hundred studies.
const chi = (a: number, b: number) => (a - b) ** 2 / (a + b);
const places = Array.from({ length: kTrials }, (_, place) => all.filter((trials) => trials[place]!.scene === "one-plume").length);
const order = places.reduce((sum, n) => sum + chi(n, kPeople - n), 0); // at most 16 degrees of freedom: 32.0 at p = 0.01
const one = all.flat().filter((t) => t.scene === "one-plume").length, asked = all.flat().filter((t) => t.question === "one-plume").length;
const told = bytes.filter((text) => /"(method|condition|correct|stimulus)"|pro-stm/.test(text) && !text.includes("<!doctype")).length;
console.log(`answers ${all.flat().length}, lost ${lost}, doubled ${doubled}, kills ${killed}`);
console.log(`AM ${am} and PRO-STM ${kPeople - am} participants; one plume ${one} of ${kPeople * kTrials} trials`);
console.log(`χ² of scenes over places ${order.toFixed(1)} (16 df), of questions ${chi(asked, kPeople * kTrials - asked).toFixed(2)} (1 df)`);
console.log(`messages and files that the participants' pages got: ${bytes.length}, ${(bytes.reduce((n, t) => n + t.length, 0) / 1e6).toFixed(1)} MB; with a condition in them: ${told}`);
check(lost === 0 && doubled === 0 && killed === kKills && am === kPeople / 2 && one === (kPeople * kTrials) / 2, "nothing lost, nothing doubled, balanced");
check(order < 32.0 && told === 0, "order is random, and no condition is told");
clean();
