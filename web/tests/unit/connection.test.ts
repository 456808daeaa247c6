import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Connection, type Link } from "../../src/connection";
import { encode } from "../support/encode";

/// A socket whose other end is the test.
class FakeSocket {
  static readonly OPEN = 1;
  static all: FakeSocket[] = [];
  readyState = 0;
  binaryType = "";
  sent: string[] = [];
  onopen: (() => void) | null = null;
  onclose: (() => void) | null = null;
  onmessage: ((event: { data: unknown }) => void) | null = null;
  constructor(readonly address: string) { FakeSocket.all.push(this); }
  send(text: string): void { this.sent.push(text); }
  open(): void {
    this.readyState = 1;
    this.onopen?.();
  }
  close(): void {
    this.readyState = 3;
    this.onclose?.();
  }
}

const links: [Link, string][] = [];
const frames: number[] = [], errors: string[] = [];
const make = () => new Connection("ws://here/live", {
  frame: (f) => frames.push(f.sequence), hello: () => undefined, state: () => undefined, error: (s) => errors.push(s), link: (l, s) => links.push([l, s]),
});
const newest = () => FakeSocket.all[FakeSocket.all.length - 1]!;

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("WebSocket", FakeSocket);
  vi.stubGlobal("window", globalThis);
  vi.stubGlobal("document", { hidden: false });
  FakeSocket.all = [];
  links.length = frames.length = errors.length = 0;
});
afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

describe("a connection", () => {
  it("requests 30 frames a second, and one while hidden", () => {
    const connection = make();
    connection.open();
    expect(connection.send({ type: "transport", do: "play" })).toBe(false);
    newest().open();
    vi.stubGlobal("document", { hidden: true });
    connection.sendRate();
    expect(newest().sent.map((s) => JSON.parse(s))).toEqual([{ type: "rate", hz: 30 }, { type: "rate", hz: 1 }]);
  });

  it("requests another rate when it is set", () => {
    const connection = make();
    connection.open();
    newest().open();
    for (const hz of [15, 15, 10]) connection.setRate(hz);
    expect(newest().sent.map((s) => JSON.parse(s).hz)).toEqual([30, 15, 10]);
  });

  it("catches, counts and reports a malformed message, and reads the next", () => {
    const connection = make();
    connection.open();
    newest().open();
    const say = (data: unknown) => newest().onmessage?.({ data });
    for (const bad of [new ArrayBuffer(0), new ArrayBuffer(3), encode({ version: 3 }), encode({}).slice(0, 30)]) say(bad);
    for (const bad of ["", "{", "[]", '{"type":"hello"}', '{"type":"state","controls":[{}]}']) say(bad);
    expect([connection.refused, connection.frames]).toEqual([4, 0]);
    expect(links[links.length - 1]![1]).toMatch(/was not read/);
    say(encode({ sequence: 9 }));
    say('{"type":"error","sentence":"no"}');
    expect([frames, errors]).toEqual([[9], ["no"]]);
  });

  it("reconnects after a loss, with growing waits, and quickly again after a success", () => {
    const connection = make();
    connection.open();
    newest().open();
    const waits: number[] = [];
    for (let i = 0; i < 7; ++i) {
      const before = FakeSocket.all.length;
      newest().close();
      expect(links[links.length - 1]![0]).toBe("lost");
      let waited = 0;
      for (; FakeSocket.all.length === before; waited += 50) vi.advanceTimersByTime(50);
      waits.push(waited);
    }
    expect(waits).toEqual([250, 500, 1000, 2000, 4000, 4000, 4000]);
    newest().open();
    expect([links[links.length - 1], connection.opened]).toEqual([["open", ""], 2]);
    newest().close();
    vi.advanceTimersByTime(250);
    expect(FakeSocket.all.length).toBe(9);
  });
});
