/// Numbers over time, and the axis of their strip.

export const kLongest = 420; // the past that can be looked back at, and the longest strip before it [s]

/// Values over time. Those older than seven minutes are dropped.
export class History {
  readonly times: number[] = [];
  readonly values: number[][];
  constructor(count: number) { this.values = Array.from({ length: count }, () => []); }

  add(time: number, values: number[]): void {
    this.times.push(time);
    values.forEach((v, i) => this.values[i]!.push(v));
    // drops many at once, which is cheaper
    const old = this.times.findIndex((t) => t >= time - kLongest - 1);
    if (old < 64) return;
    this.times.splice(0, old);
    for (const row of this.values) row.splice(0, old);
  }

  /// Copies the values, for a frozen strip.
  copy(): History {
    const made = new History(this.values.length);
    made.times.push(...this.times);
    this.values.forEach((row, i) => made.values[i]!.push(...row));
    return made;
  }

  /// Index of the sample nearest to a time; −1 without samples.
  nearest(time: number): number {
    const after = this.after(time);
    if (after === 0 || (after < this.times.length && this.times[after]! - time < time - this.times[after - 1]!)) {
      return after < this.times.length ? after : -1;
    }
    return after - 1;
  }
  /// Index of the first sample at or after a time.
  after(time: number): number {
    let low = 0, high = this.times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle]! < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }
}

const kRateOver = 1; // [s]

/// Growth of a counter during the last second, per second. A counter that falls has been reset.
export class PerSecond {
  private readonly seen: { time: number; count: number }[] = [];

  add(time: number, count: number): number {
    const last = this.seen[this.seen.length - 1];
    if (!Number.isFinite(count)) return NaN;
    if (last !== undefined && (count < last.count || time < last.time)) this.seen.length = 0;
    this.seen.push({ time, count });
    while (this.seen.length > 2 && this.seen[1]!.time <= time - kRateOver) this.seen.shift();
    const first = this.seen[0]!;
    return time > first.time ? (count - first.count) / Math.max(kRateOver, time - first.time) : 0;
  }
}

/// Times of the samples with a value above the axis, and below it.
export function beyond(times: number[], rows: number[][], bottom: number, top: number): { above: number[]; below: number[] } {
  return {
    above: times.filter((_, i) => rows.some((row) => row[i]! > top)),
    below: times.filter((_, i) => rows.some((row) => row[i]! < bottom)),
  };
}

const kOutlying = 1.5; // times the 98th percentile

/// The top of an axis that fits the values; it follows their 98th percentile if a few are much larger.
export function robustTop(values: ArrayLike<number>, atLeast: number): number {
  const sorted = Float64Array.from(values).filter(Number.isFinite).sort();
  if (sorted.length === 0) return atLeast;
  const most = sorted[sorted.length - 1]!, high = sorted[Math.max(0, Math.ceil(0.98 * sorted.length) - 1)]!;
  return Math.max(atLeast, 1.08 * (most <= kOutlying * high ? most : high));
}
