/// Limits how often pictures are drawn, so that drawing does not slow the run down.

export interface PaceState {
  interval: number; // shortest time between the starts of two pictures [ms]
  /// the picture costs more than the run can spare
  off: boolean;
}

const kSlow = 40; // time per picture above which drawing counts as slow [ms]
// Share of the time that slow pictures may take. A picture drawn by the processor costs the run about a step.
const kShare = 0.125, kLeastShare = 0.04;
const kPatience = 2500; // time of missed rates after which the pictures' share is halved [ms]
const kEnough = 6; // pictures needed to measure their time
const kSlowest = 2000; // longest time between pictures [ms]
const kLongest = 2500; // time between pictures above which they are of no use [ms]

export class Pace {
  /// smoothed time per picture [ms]
  cost = 0;
  private pictures = 0; // since the last measureAnew()
  private share = kShare;
  private missed: number | null = null; // time since which the run has missed its rates [ms]

  /// @param software whether the processor draws, which the run also needs.
  constructor(private readonly software: boolean) {}

  get slow(): boolean { return this.software || this.cost > kSlow; }
  /// Whether `cost` covers enough pictures to be relied on.
  get measured(): boolean { return this.pictures >= kEnough; }

  /// Records the time that a picture took [ms].
  drew(cost: number): void {
    this.cost = this.cost === 0 ? cost : 0.8 * this.cost + 0.2 * cost;
    ++this.pictures;
  }
  /// Restarts the measurement after the pictures' size has changed.
  measureAnew(): void { this.pictures = 0; }

  /// Draws less the longer the run misses its rates. @param now [ms]. @param held whether the run meets its rates.
  state(now: number, held: boolean): PaceState {
    if (!this.slow) return { interval: 0, off: false };
    if (held) this.missed = null;
    else this.missed ??= now;
    let off = false;
    if (this.missed !== null && now - this.missed > kPatience) {
      off = this.share <= kLeastShare;
      this.share = Math.max(kLeastShare, this.share / 2);
      this.missed = now;
    }
    const interval = Math.max(this.software ? 80 : 0, this.cost / this.share);
    return { interval: Math.min(kSlowest, interval), off: off || (this.measured && interval > kLongest) };
  }

  /// Starts again because the user asks for the picture.
  begin(): void {
    this.share = kShare;
    this.missed = null;
    this.cost = this.pictures = 0;
  }
}
