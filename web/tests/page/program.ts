/// The program under test, a recording for it, and pages of it.

import { spawn, type ChildProcess, type ChildProcessByStdio } from "node:child_process";
import { existsSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import type { Readable } from "node:stream";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium, type Browser, type Page } from "playwright-core";
import { Matrix4 } from "three";
import { skeleton } from "../support/skeleton";

export const kProgram = process.env.PROSTM ?? "";
export const kBrowser = process.env.CHROMIUM ?? "/usr/bin/chromium";
export const folder = mkdtempSync(join(tmpdir(), "prostm-page-"));

/// A hand that descends over the array and tilts, recorded in a tracker's frame: (x, y, z) of D is (x, z, −y) there.
export function writeRecording(seconds: number): string {
  const file = join(folder, "hand.hands.jsonl");
  const toTracker = new Matrix4().set(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
  const lines = ['{"format":"hand-frames","version":1,"units":"m"}'];
  for (let t = 0; t < seconds; t += 0.02) {
    const pose = new Matrix4().makeRotationX(Math.PI / 2 + 0.1 * Math.sin(2 * t)).setPosition(0.02 * Math.sin(t), -0.01, 0.19 + 0.015 * Math.cos(t));
    const hand = skeleton(toTracker.clone().multiply(pose), 0.1, "right");
    const rows = (from: number, to: number) => Array.from({ length: 26 }, (_, j) => [...hand.joints.subarray(8 * j + from, 8 * j + to)]).flat();
    lines.push(JSON.stringify({ t, hands: [{ id: 1, side: "R", conf: 1, p: rows(0, 3), q: rows(3, 7), r: rows(7, 8) }] }));
  }
  writeFileSync(file, lines.join("\n"));
  return file;
}

const programs: ChildProcess[] = [];

/// Starts the program under test. clean() ends it if a test has failed before it did.
export function spawnProgram(args: string[]): ChildProcessByStdio<null, Readable, Readable> {
  const child = spawn(kProgram, args, { cwd: folder, stdio: ["ignore", "pipe", "pipe"] });
  programs.push(child);
  return child;
}

export class Program {
  address = "";
  private output = "";
  private child: ChildProcess | null = null;

  constructor(private readonly options: string[]) {}

  /// Starts the program, and waits until it prints the page's address.
  async start(port = 0): Promise<void> {
    const child = spawnProgram(["run", "--view", "--view-port", String(port), ...this.options]);
    this.child = child;
    this.output = "";
    this.address = await new Promise((resolve, reject) => {
      const read = (data: Buffer) => {
        this.output += data.toString();
        const found = /http:\/\/127\.0\.0\.1:\d+/.exec(this.output);
        if (found !== null) resolve(found[0]);
      };
      child.stdout.on("data", read);
      child.stderr.on("data", read);
      child.on("error", reject);
      child.on("exit", () => reject(new Error(`the program ended before it said where its page is:\n${this.output}`)));
    });
  }
  /// The program's output so far.
  get printed(): string { return this.output; }
  get port(): number { return Number(new URL(this.address).port); }

  /// Waits until the program ends by itself.
  async ended(): Promise<void> {
    const child = this.child;
    if (child !== null && child.exitCode === null && child.signalCode === null) await new Promise((resolve) => child.once("exit", resolve));
  }

  async stop(signal: NodeJS.Signals = "SIGKILL"): Promise<void> {
    this.child?.kill(signal);
    await this.ended();
  }

  async numbers(): Promise<Json> { return (await fetch(`${this.address}/numbers.json`)).json() as Promise<Json>; }
}
export type Json = Record<string, unknown>;

/// Ends programs that still run, and removes the folder of the tests.
export function clean(): void {
  for (const child of programs) if (child.exitCode === null && child.signalCode === null) child.kill("SIGKILL");
  rmSync(folder, { recursive: true, force: true });
}

export async function openBrowser(): Promise<Browser> {
  if (!existsSync(kProgram)) throw new Error(`PROSTM names no program: "${kProgram}"`);
  return chromium.launch({
    executablePath: kBrowser,
    args: ["--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
  });
}

/// The errors that a page reports.
export class Watch {
  readonly complaints: string[] = [];
  readonly requests: string[] = [];
  constructor(page: Page) {
    page.on("console", (message) => message.type() === "error" && this.complaints.push(message.text()));
    page.on("pageerror", (error) => this.complaints.push(String(error.stack ?? error)));
    page.on("request", (request) => this.requests.push(request.url()));
    page.on("websocket", (socket) => this.requests.push(socket.url()));
  }
}

/// Waits until a condition holds in the page.
export async function until<A>(page: Page, condition: (argument: A) => boolean, argument: A, what: string, timeout = 30_000): Promise<void> {
  try {
    await page.waitForFunction(condition as never, argument as never, { polling: 50, timeout });
  } catch (error) {
    const state = await page.evaluate(() => JSON.stringify({
      link: document.getElementById("link")?.textContent, frames: window.prostm.frames, pictures: window.prostm.pictures, transport: window.prostm.state?.transport, run: window.prostm.frame?.run,
      errors: [...document.querySelectorAll(".error, #notice")].map((e) => e.textContent).filter((t) => t),
    }));
    throw new Error(`never happened: ${what}; the page: ${state}`, { cause: error });
  }
}
