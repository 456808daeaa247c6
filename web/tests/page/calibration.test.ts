import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { Matrix4, Quaternion, Vector3 } from "three";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import "../../src/inspection";
import { clean, folder, openBrowser, Program, until, Watch } from "./program";
import { FakeTracker, kFlesh } from "./tracker";

const tracker = await FakeTracker.start();
const file = join(folder, "tracker.json");
const program = new Program(["--grid", "32", "--hand", tracker.address, "--tracker-file", file, "--seconds", "3600"]);
let browser: Browser, page: Page, watch: Watch;

// the assumed pose of the tracker at first, and its true pose: X_DT [m]
const believed = new Matrix4().set(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
const trueTurn = new Quaternion().setFromAxisAngle(new Vector3(1, 2, 3).normalize(), 0.2).multiply(new Quaternion().setFromRotationMatrix(believed));
const truly = new Matrix4().compose(new Vector3(0.02, 0.12, -0.01), trueTurn, new Vector3(1, 1, 1));

beforeAll(async () => {
  browser = await openBrowser();
  await program.start();
  page = await browser.newPage({ viewport: { width: 1280, height: 720 }, colorScheme: "light" });
  watch = new Watch(page);
  await page.goto(`${program.address}/#picture=on`);
  await until(page, () => window.prostm?.state?.tracker?.connected === true && window.prostm.frame?.hands.length === 1, 0, "a hand of the tracker");
});
afterAll(async () => {
  await browser?.close();
  await program.stop();
  tracker.stop();
  clean();
});

/// Position of the fingertip on a mark in the array's frame, and as the program sees it with a given pose of the tracker [m].
const mark = async (i: number) => new Vector3(...(await page.evaluate((n) => window.prostm.state!.calibration!.marks[n]!.p_mm, i))).divideScalar(1000).add(new Vector3(0, 0, kFlesh));
const seen = (tip: Vector3, pose: Matrix4) => tip.clone().applyMatrix4(truly.clone().invert()).applyMatrix4(pose);
const tipIsAt = (place: Vector3, what: string) =>
  until(page, (p) => {
    const hand = window.prostm.frame!.hands[0];
    return hand !== undefined && Math.hypot(...p.map((v, i) => v - hand.joints[80 + i]!)) < 0.001;
  }, place.toArray(), what);

const begin = async () => {
  await page.locator("#calibrate").click();
  await until(page, () => document.querySelector<HTMLDialogElement>("#calibration")!.open && document.querySelectorAll("#calibration-marks li").length === 4, 0, "the marks");
};
/// Puts the finger on a mark and takes it, with a click as long as a person's.
async function take(i: number): Promise<void> {
  const tip = await mark(i);
  tracker.tip.copy(seen(tip, new Matrix4()));
  await tipIsAt(seen(tip, believed), `the finger on mark ${i}`);
  const row = page.locator("#calibration-marks li").nth(i);
  await expect.poll(async () => {
    await row.locator("button").click({ delay: 300 });
    return row.getAttribute("class");
  }, { timeout: 30_000, interval: 300 }).toBe("taken");
}
const solve = async () => {
  await page.locator("#calibration-solve").click();
  await until(page, () => window.prostm.state!.calibration!.residual_mm !== null, 0, "a residual");
  expect(await page.locator("#calibration-residual").textContent()).toMatch(/^Residual 0(\.\d+)? mm$/);
};
const end = async () => {
  await page.locator("#calibration-cancel").click();
  await until(page, () => window.prostm.state!.calibration === null && !document.querySelector<HTMLDialogElement>("#calibration")!.open, 0, "an end");
};

describe("the calibration of a tracker", () => {
  it("explains why a mark or a pose cannot be taken", async () => {
    await begin();
    expect(await page.locator("#calibration-muted").textContent()).toBe("The array is muted for the calibration.");
    await expect.poll(() => program.printed).toContain("The array is muted for the calibration of the tracker.\n");
    await page.locator("#calibration-solve").click();
    await until(page, () => (document.querySelector("#calibration-error")?.textContent ?? "").includes("at least 3"), 0, "a sentence in the dialog");
    expect(await page.locator("#calibration-save").isDisabled()).toBe(true);
    expect(await page.locator("#calibrate").isDisabled()).toBe(true);
  });

  it("is reverted with Cancel", async () => {
    for (let i = 0; i < 4; ++i) await take(i);
    const tip = await mark(3);
    await solve();
    await tipIsAt(tip, "the finger on the array with the pose that was found");
    await end();
    await tipIsAt(seen(tip, believed), "the finger where it was before");
    expect(existsSync(file)).toBe(false);
    await expect.poll(() => program.printed).toContain("The calibration is over: the array is not muted any more.\n");
  }, 120_000);

  it("writes and keeps the pose that it finds", async () => {
    await begin();
    for (let i = 0; i < 3; ++i) await take(i);
    const tip = await mark(2);
    await solve();
    await page.locator("#calibration-save").click();
    await until(page, () => (document.querySelector("#calibration-saved")?.textContent ?? "").includes("tracker.json"), 0, "what was written");
    const pose = JSON.parse(readFileSync(file, "utf8")) as { format: string; position_mm: number[]; quaternion: number[]; rms_mm: number };
    expect(pose.format).toBe("prostm-pose/1");
    expect(new Vector3(...pose.position_mm).distanceTo(new Vector3(20, 120, -10))).toBeLessThan(1);
    expect(new Quaternion().fromArray(pose.quaternion).angleTo(trueTurn)).toBeLessThan(0.01);
    expect(pose.rms_mm).toBeLessThan(1);
    await end();
    await tipIsAt(tip, "the finger on the array");
    expect(watch.complaints).toEqual([]);
  }, 120_000);
});
