/// Frames of the last minutes, without their smoke, for a look back.

import type { Frame } from "../wire";

export const kPast = 300; // time that is kept [s]
const kEvery = 0.2; // between frames that are kept [s]
/// Most memory of the frames' arrays; the past as a whole takes at most 64 MB.
export const kMostBytes = 48 << 20;
const kOverhead = 4096; // objects and small arrays of a frame [bytes]

interface Kept {
  frame: Frame;
  time: number; // of the page's clock [s]
  own: number; // bytes without the field
}

function ownBytes(frame: Frame): number {
  const hands = frame.hands.reduce((sum, h) => sum + h.joints.byteLength, 0);
  const plan = frame.plan.reduce((sum, p) => sum + p.points.byteLength, 0);
  return kOverhead + frame.numbers.byteLength + hands + plan;
}
function fieldBytes({ field }: Frame): number {
  const arrays = field.flatMap((p) => [p.pose, p.target, p.rendered, p.height, p.skin]);
  return arrays.reduce((sum, a) => sum + a.byteLength, 0);
}

export class Past {
  private kept: Kept[] = [];
  private every = kEvery;
  /// memory of the kept frames
  bytes = 0;

  get length(): number { return this.kept.length; }
  /// Time of the oldest frame [s]; undefined without one.
  get oldest(): number | undefined { return this.kept[0]?.time; }

  /// Keeps a frame if the last one is old enough. @param time of the page's clock [s].
  add(frame: Frame, time: number): void {
    const last = this.kept[this.kept.length - 1];
    if (last !== undefined && time - last.time < this.every) return;
    const own = ownBytes(frame);
    this.bytes += own + (last?.frame.field === frame.field ? 0 : fieldBytes(frame));
    // a view that shows it takes the smoke of the next frame as new
    this.kept.push({ frame: { ...frame, smoke: null, smokeSequence: -1 }, time, own });
    const old = this.kept.findIndex((k) => k.time >= time - kPast);
    if (old > 0) this.keep(this.kept.slice(old));
    // fewer frames over the same time
    while (this.bytes > kMostBytes && this.kept.length > 2) {
      this.every *= 2;
      this.keep(this.kept.filter((_, i) => i % 2 === 0));
    }
  }

  /// The frame nearest to a time; null without frames.
  at(time: number): Frame | null {
    let low = 0, high = this.kept.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.kept[middle]!.time < time) low = middle + 1;
      else high = middle;
    }
    const after = this.kept[low], before = this.kept[low - 1];
    if (after === undefined) return null;
    return before !== undefined && time - before.time < after.time - time ? before.frame : after.frame;
  }

  private keep(kept: Kept[]): void {
    this.kept = kept;
    this.bytes = 0;
    kept.forEach(({ frame, own }, i) => {
      this.bytes += own + (kept[i - 1]?.frame.field === frame.field ? 0 : fieldBytes(frame));
    });
  }
}
