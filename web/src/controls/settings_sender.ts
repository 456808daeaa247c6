/// Sends settings at a rate that a run can follow; of several values of a control only the newest is sent.

import type { Value } from "../messages";

const kEvery = 50; // shortest interval between messages [ms]

export class SettingsSender {
  private readonly waiting = new Map<string, Value>();
  private sent = -Infinity;
  private timer: number | undefined;

  constructor(private readonly send: (id: string, value: Value) => void) {}

  set(id: string, value: Value): void {
    this.waiting.delete(id); // so that the newest control comes last
    this.waiting.set(id, value);
    this.timer ??= window.setTimeout(() => this.flush(), Math.max(0, this.sent + kEvery - performance.now()));
  }

  /// Discards waiting settings: they were meant for a connection that is lost.
  forget(): void { this.waiting.clear(); }

  private flush(): void {
    this.timer = undefined;
    this.sent = performance.now();
    for (const [id, value] of this.waiting) this.send(id, value);
    this.waiting.clear();
  }
}
