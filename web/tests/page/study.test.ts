import { writeFileSync } from "node:fs";
import type { Browser, Page, WebSocket } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { clean, openBrowser, Watch, type Json } from "./program";
import { comes, protocol, Study } from "./study";

/// All data that the program sends to a page.
class Traffic {
  readonly texts: string[] = [];
  readonly sizes: number[] = [];
  constructor(page: Page) {
    page.on("websocket", (socket: WebSocket) => socket.on("framereceived", ({ payload }) => {
      if (typeof payload === "string") this.texts.push(payload);
      else this.sizes.push(payload.length);
    }));
  }
}

let browser: Browser;
beforeAll(async () => {
  browser = await openBrowser();
});
afterAll(async () => {
  await browser?.close();
  clean();
});

describe("a session of a study", () => {
  const study = new Study(protocol('[study]\ntitle = "Plumes"\n[training]\nseconds = 60\n[trials]\nrepeats = 2\nsettle = 0.5\ngate = "noted"'), 1);
  let experimenter: Page, participant: Page, traffic: Traffic, watch: Watch[];

  it("begins with a training whose picture the participant sees", async () => {
    await study.start();
    [experimenter, participant] = [await browser.newPage(), await browser.newPage()];
    traffic = new Traffic(participant);
    watch = [new Watch(experimenter), new Watch(participant)];
    await experimenter.goto(study.url);
    await participant.goto(`${study.url}participant`);
    await comes(experimenter, "training");
    await participant.waitForFunction(() => !document.getElementById("picture")!.hidden);
    await participant.getByRole("button", { name: "four plumes" }).click();
    await experimenter.waitForFunction(() => document.querySelector("#scenes [aria-pressed=true]")?.textContent === "four plumes");
    expect((await fetch(`${study.url}numbers.json`)).status).toBe(403);
  });

  it("asks on both pages, and accepts answers from the experimenter's keys and buttons", async () => {
    await experimenter.keyboard.press("Enter"); // a single key does not end the training
    await experimenter.locator("#ending-words").filter({ hasText: "of the training is left" }).waitFor();
    await experimenter.keyboard.press("Enter"); // the focus is on "Continue the training"
    await experimenter.locator("#ending").waitFor({ state: "hidden" });
    expect(study.lines().some((line) => line.kind === "training")).toBe(false);
    await experimenter.keyboard.press("Enter");
    await experimenter.getByRole("button", { name: "End it now" }).click();
    await comes(experimenter, "ready");
    await experimenter.keyboard.press("Enter");
    let sizes = 0;
    for (let i = 0; i < 4; ++i) {
      await comes(experimenter, "presenting");
      await participant.waitForFunction(() => !document.getElementById("asked")!.hidden);
      const asked = await experimenter.locator("#question").textContent();
      expect(await participant.locator("#question").textContent()).toBe(asked);
      expect(await participant.locator("#drawing circle").count()).toBe(asked === "Is there one plume?" ? 1 : 4);
      expect(await participant.locator("#answers").isVisible()).toBe(false);
      await participant.keyboard.press("y"); // the participant may not answer
      if (i % 2 === 0) await experimenter.keyboard.press(i === 0 ? "y" : "PageUp");
      else await experimenter.locator(i === 1 ? "#first" : "#second").click();
      await experimenter.waitForFunction((done) => document.querySelector("progress")!.value === done, i + 1);
      if (i === 0) sizes = traffic.sizes.length; // the last pictures of the training have arrived
    }
    await comes(participant, "done");
    expect(traffic.sizes.length).toBe(sizes);
    expect(study.trials().map((t) => t.answer)).toEqual([1, 1, 0, 0]);
    await experimenter.getByRole("button", { name: "The last answer was no: change it" }).click();
    await experimenter.getByRole("button", { name: "The last answer was yes: change it" }).waitFor();
    expect(study.lines().filter((line) => line.kind === "correction").map((line) => [line.trial, line.answer])).toEqual([[4, 1]]);
  });

  it("sends the participant nothing that reveals the answer or the method", () => {
    expect(study.trials().length).toBe(4);
    for (const text of traffic.texts) {
      expect(text).not.toMatch(/"(method|scene|condition|correct|gate|stimulus)"|pro-stm|\bam\b/);
      const message = JSON.parse(text) as Json;
      if (message.type !== "study") continue;
      const keys = ["type", "room", "title", "phase", "done", "trials", "open", "task", "controls", "interval", "takes_answer", "training_left_s", "practice", "explored", "scenes", "answers", "hand", "consent", "noise", "waits_for", "feedback", "question"];
      expect(Object.keys(message)).toEqual(keys);
      expect(message.feedback).toBe(null);
      // the jets are those of the question
      const question = message.question as { text: string; jets_mm: number[][] } | null;
      if (question !== null) expect(question.jets_mm.length).toBe(question.text === "Is there one plume?" ? 1 : 4);
    }
  });

  it("ends when the experimenter closes it", async () => {
    await experimenter.keyboard.press("Enter");
    expect(await study.ended()).toBe(0);
    expect(study.printed).toContain("Participant 1: 4 of 4 answers");
    for (const { complaints } of watch) expect(complaints.filter((c) => !/ERR_CONNECTION_REFUSED|closed/.test(c))).toEqual([]);
    await experimenter.close();
    await participant.close();
  });
});

describe("a study with noise", () => {
  it("holds trials until the noise plays, and again after a reload", async () => {
    const study = new Study(protocol('[training]\nseconds = 0\n[trials]\nrepeats = 1\nrest = 0.1\nsettle = 0.5\ngate = "off"\nnoise = true'), 21);
    await study.start();
    const [experimenter, participant] = [await browser.newPage(), await browser.newPage()];
    const needs = (word: string) => experimenter.waitForFunction((w) => document.getElementById("needs")!.textContent!.includes(w), word);
    await experimenter.goto(study.url);
    await comes(experimenter, "ready");
    await experimenter.keyboard.press("Enter");
    await needs("not open");
    await participant.goto(`${study.url}participant`);
    await needs("Switch the noise on");
    await participant.getByRole("button", { name: "Switch the noise on" }).click();
    await comes(experimenter, "presenting");
    await participant.reload();
    await comes(experimenter, "settling");
    await needs("Switch the noise on");
    expect(study.trials()).toEqual([]);
    await participant.getByRole("button", { name: "Switch the noise on" }).click();
    await comes(experimenter, "presenting");
    await experimenter.keyboard.press("y");
    await comes(experimenter, "settling");
    expect(study.trials()[0]!.page).toEqual({ open: true, missing_s: {}, interrupted: 1 });
    expect(study.lines().filter((line) => line.kind === "interrupted").length).toBe(1);
    await study.kill("SIGINT");
    expect(study.printed).toContain("The masking noise does not play");
    await experimenter.close();
    await participant.close();
  });
});

/// Each stimulus begins without a permission to answer, and gets it later.
function expectFixedDuration(traffic: Traffic): void {
  const states = traffic.texts.map((text) => JSON.parse(text) as Json).filter((message) => message.type === "study");
  const takes = states.map((state) => state.phase === "presenting" ? Number(state.takes_answer) : -1);
  const starts = takes.filter((take, i) => take !== -1 && takes[i - 1] === -1);
  expect(starts.length).toBe(7); // two of the practice
  expect(starts).toEqual(starts.map(() => 0));
}

describe("a study with practice, catch trials and a fixed duration", () => {
  it("practises with feedback, repeats a failed practice, and does not reveal a catch trial", async () => {
    const study = new Study(protocol('[training]\nseconds = 0\n[practice]\ntrials = 1\nright = 1\nwindow = 1\n[trials]\nrepeats = 2\nrest = 0.1\nsettle = 0.5\n' +
      'gate = "off"\ncatch_every = 4\ntime_limit = 0.4\nfixed_duration = true'), 31);
    await study.start();
    const [experimenter, participant] = [await browser.newPage(), await browser.newPage()];
    const traffic = new Traffic(participant);
    await experimenter.goto(study.url);
    await participant.goto(`${study.url}participant`);
    await comes(experimenter, "ready");
    const practise = async (right: boolean) => {
      await comes(experimenter, "presenting");
      expect(await experimenter.locator("#count").textContent()).toBe("Practice 1");
      await experimenter.locator("#first:enabled").waitFor();
      const before = study.lines().length;
      const first = experimenter.locator("#first"), second = experimenter.locator("#second");
      await (right ? first : second).click();
      await comes(experimenter, "ready");
      return study.lines().slice(before).find((line) => line.kind === "practice")!.right === 1;
    };
    expect(await experimenter.locator("#next-word").textContent()).toBe("Begin the practice");
    await experimenter.keyboard.press("Enter");
    expect(await practise(false)).toBe(false); // the seed's first practice trial is answered by yes
    await experimenter.locator("#practice-failed").filter({ hasText: "without its criterion" }).waitFor();
    expect(await participant.locator("#feedback").textContent()).toBe("That was wrong.");
    await experimenter.getByRole("button", { name: "Practise again" }).click();
    expect(await practise(true)).toBe(true);
    expect(await participant.locator("#feedback").textContent()).toBe("That was right.");
    expect(await experimenter.locator("#next-word").textContent()).toBe("Begin the trials");
    await experimenter.keyboard.press("Enter");
    for (let i = 0; i < 5; ++i) {
      await comes(experimenter, "presenting");
      await experimenter.locator("#second:enabled").click();
      await comes(experimenter, i < 4 ? "settling" : "done");
    }
    expect(study.lines().filter((line) => line.kind === "catch").map((line) => line.right)).toEqual([1]);
    for (const text of traffic.texts) expect(text).not.toMatch(/catch|"extra"/);
    expectFixedDuration(traffic);
    await study.kill("SIGINT");
    await experimenter.close();
    await participant.close();
  });
});

describe("participants who answer themselves", () => {
  it("do so with consent, questions about them, keys and feedback if the protocol has them", async () => {
    const study = new Study(protocol('[study]\nconsent = "I take part."\ndemographics = true\nblind = false\n[training]\nseconds = 0\n' +
      '[trials]\nrepeats = 1\nsettle = 0.5\ngate = "off"\nanswers = "participant"\nnoise = true\nfeedback = true\nbreak_every = 1'), 2);
    await study.start();
    const [experimenter, participant] = [await browser.newPage(), await browser.newPage()];
    await experimenter.goto(study.url);
    await participant.goto(`${study.url}participant`);
    await comes(participant, "consent");
    await participant.getByRole("button", { name: "I agree" }).click();
    await comes(participant, "about");
    await participant.getByLabel("Age").selectOption("25 to 34");
    await participant.getByRole("button", { name: "Go on" }).click();
    await comes(experimenter, "ready");
    await participant.getByRole("button", { name: "Switch the noise on" }).click();
    await participant.waitForFunction(() => document.getElementById("noise")!.hidden);
    for (let i = 0; i < 2; ++i) {
      await experimenter.keyboard.press("Enter");
      await comes(participant, "presenting");
      expect(await experimenter.locator("#condition").textContent()).toMatch(/^(one|four)-plumes? with (am|pro-stm)$/);
      if (i === 0) await participant.keyboard.press("ArrowRight");
      else await participant.locator("#second").click();
      for (const page of [participant, experimenter]) await comes(page, i === 0 ? "break" : "done");
      expect(await participant.locator("#feedback").textContent()).toBe(study.trials()[i]!.correct === 1 ? "That was right." : "That was wrong.");
    }
    expect(study.lines().find((line) => line.kind === "about")?.answers).toEqual({ age: "25 to 34" });
    await study.kill("SIGINT");
    await experimenter.close();
    await participant.close();
  });
});

/// A study with levels: one scene, and a hand that is not tracked.
function levels(trials: string, level: string, methods: string): string {
  const file = protocol("");
  writeFileSync(file, `[training]
seconds = 0
[trials]
answers = "participant"
settle = 0.5
gate = "off"
${trials}
[level]
interval = 1
gap = 0.4
${level}
[scene.one-plume]
question = "How about it?"
[method.stm.fluid]
cells = 32
[method.stm.plan]
preset = "fast"
${methods}`);
  return file;
}

/// No data sent to a participant may reveal a level, or which interval has it.
function expectNothingTold(traffic: Traffic, study: Study): void {
  const texts = traffic.texts.filter((text) => text.includes('"type":"study"'));
  expect(texts.length).toBeGreaterThan(5);
  const keys = ["type", "room", "title", "phase", "done", "trials", "open", "task", "controls", "interval", "takes_answer", "training_left_s", "practice", "explored", "scenes", "answers", "hand", "consent", "noise", "waits_for", "feedback", "question"];
  for (const text of texts) {
    expect(Object.keys(JSON.parse(text) as Json)).toEqual(keys);
    expect(text).not.toMatch(/level|reference|felt|correct|start|track|method|condition|\bstm\b|\bam\b/);
  }
  for (const trial of study.trials()) {
    const told = [trial.level, trial.start, ...((trial.changes ?? []) as number[][]).map((change) => change[1])];
    for (const level of told) if (level !== undefined) for (const text of texts) expect(text).not.toContain(`${level as number}`);
  }
}

describe("studies with levels", () => {
  it("ask for one of two intervals, by keys, a foot switch's keys and touch", async () => {
    const study = new Study(levels('task = "forced-choice"', 'setting = "plan.speed"\nlow = 2.137\nhigh = 7.853\nreference = 2.137\nprocedure = "bayes"\ntrials = 3', ""), 11);
    await study.start();
    const [experimenter, participant] = [await browser.newPage(), await browser.newPage({ hasTouch: true })];
    const traffic = new Traffic(participant);
    const watch = [new Watch(experimenter), new Watch(participant)];
    await experimenter.goto(study.url);
    await participant.goto(`${study.url}participant`);
    await comes(experimenter, "ready");
    await experimenter.keyboard.press("Enter");
    for (let i = 0; i < 3; ++i) {
      await comes(participant, "presenting");
      await participant.waitForFunction(() => document.getElementById("interval")!.textContent === "1");
      await participant.keyboard.press("1"); // too early, so it is ignored
      expect(await participant.locator("#first").isDisabled()).toBe(true);
      await participant.waitForFunction(() => document.getElementById("interval")!.textContent === "2");
      expect(await experimenter.locator("#condition").textContent()).toBe("");
      if (i === 0) await participant.keyboard.press("2");
      else if (i === 1) await participant.keyboard.press("PageUp");
      else await participant.getByRole("button", { name: "The second" }).tap();
      await experimenter.waitForFunction((done) => document.querySelector("progress")!.value === done, i + 1);
    }
    await comes(participant, "done");
    expect(study.trials().map((t) => t.answer)).toEqual([2, 1, 2]);
    for (const t of study.trials()) expect(t.correct).toBe(t.answer === t.interval ? 1 : 0);
    await experimenter.getByRole("button", { name: "The last answer was the second: change it" }).click();
    await experimenter.getByRole("button", { name: "The last answer was the first: change it" }).waitFor();
    expectNothingTold(traffic, study);
    await experimenter.keyboard.press("Enter");
    expect(await study.ended()).toBe(0);
    for (const { complaints } of watch) expect(complaints.filter((c) => !/ERR_CONNECTION_REFUSED|closed/.test(c))).toEqual([]);
    await experimenter.close();
    await participant.close();
  });

  it("let a participant adjust one stimulus until it feels like another", async () => {
    const study = new Study(levels('task = "adjustment"\nrepeats = 2', 'setting = "plan.speed"\nlow = 2.137\nhigh = 7.853\nstep = 0.1\nagainst = "am"', '[method.am.pipeline]\nmethod = "am"\n[method.am.fluid]\ncells = 32\n'), 12);
    await study.start();
    const [experimenter, participant] = [await browser.newPage(), await browser.newPage()];
    const traffic = new Traffic(participant);
    await experimenter.goto(study.url);
    await participant.goto(`${study.url}participant`);
    await comes(experimenter, "ready");
    await experimenter.keyboard.press("Enter");
    for (let i = 0; i < 2; ++i) {
      await comes(participant, "presenting");
      expect(await participant.locator("#answers").isVisible()).toBe(false);
      await participant.waitForFunction(() => document.getElementById("interval")!.textContent === "2");
      if (i === 0) {
        await participant.keyboard.press("ArrowRight");
        await participant.keyboard.press("Shift+ArrowRight");
        await participant.waitForFunction(() => document.getElementById("interval")!.textContent === "1");
        await participant.keyboard.press("Enter");
      } else {
        await participant.getByRole("button", { name: "Less", exact: true }).click();
        await participant.getByRole("button", { name: "They are alike" }).click();
      }
      await experimenter.waitForFunction((done) => document.querySelector("progress")!.value === done, i + 1);
    }
    await comes(experimenter, "done");
    const [up, down] = study.trials() as [Json, Json];
    expect((up.changes as number[][]).length).toBe(2);
    expect(up.level as number).toBeCloseTo((up.start as number) + 0.5, 3);
    expect(down.level as number).toBeCloseTo((down.start as number) - 0.1, 3);
    expect(up.reference).toBe("am");
    expectNothingTold(traffic, study);
    await study.kill("SIGINT");
    await experimenter.close();
    await participant.close();
  });
});

describe("a session that is killed", () => {
  it("resumes with the interrupted trial, and has each answer once", async () => {
    const study = new Study(protocol('[training]\nseconds = 0\n[trials]\nrepeats = 5\nsettle = 0.5\ngate = "off"'), 3);
    let given = 0;
    for (let start = 0; given < 10; ++start) {
      await study.start(...(start === 0 ? [] : ["--resume"]));
      expect(study.trials().length).toBe(given);
      const page = await browser.newPage();
      await page.goto(study.url);
      await comes(page, "ready");
      await page.keyboard.press("Enter");
      for (const until = start % 3; given < 10; ++given) {
        await comes(page, "presenting");
        if (given % 3 === until) {
          // the answer may or may not have reached the disk when the program dies, but it must be there once
          if (start % 2 === 0) await page.keyboard.press("y");
          break;
        }
        await page.keyboard.press("y");
        await page.waitForFunction((done) => document.querySelector("progress")!.value === done, given + 1);
      }
      await study.kill();
      given = study.trials().length;
      await page.close();
    }
    expect(study.trials().map((t) => t.trial)).toEqual(Array.from({ length: 10 }, (_, i) => i + 1));
    await expect(study.start("--resume")).rejects.toThrow("has given all answers");
    await expect(study.start()).rejects.toThrow("has begun");
    await expect(new Study(study.protocol, 4).start("--resume")).rejects.toThrow("has not begun");
  }, 240_000); // about ten starts of the program and of the page
});
