/// How often pictures may be drawn, so that the run they show is not starved.

export interface PaceState {
  interval: number; // [ms] between the beginnings of two pictures, at least
  /// the picture costs more than the run can spare
  off: boolean;
}

const kSlow = 40; // [ms] a picture from which drawing counts as slow
// The share of the time that slow pictures may take. A picture that the processor draws costs the run about a step.
const kShare = 0.125, kLeastShare = 0.04;
const kPatience = 2500; // [ms] of missed rates, after which pictures take half their time
const kEnough = 6; // pictures
const kSlowest = 2000; // [ms] between pictures, at most
const kLongest = 2500; // [ms] between pictures, from which there is no use in them

export class Pace {
  /// smoothed time of a picture [ms]
  cost = 0;
  private pictures = 0; // since it was last to be measured anew
  private share = kShare;
  private missed: number | null = null; // since when the run misses its rates [ms]

  /// @param software the processor draws, which the run needs too.
  constructor(private readonly software: boolean) {}

  get slow(): boolean { return this.software || this.cost > kSlow; }
  /// Whether `cost` is of enough pictures to judge by.
  get measured(): boolean { return this.pictures >= kEnough; }

  /// A picture took so long [ms].
  drew(cost: number): void {
    this.cost = this.cost === 0 ? cost : 0.8 * this.cost + 0.2 * cost;
    ++this.pictures;
  }
  /// Pictures have other sizes from now on.
  measureAnew(): void { this.pictures = 0; }

  /// Draws less the longer the run misses its rates. @param now [ms]. @param held whether the run keeps its rates.
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

  /// Somebody wants pictures in spite of all.
  begin(): void {
    this.share = kShare;
    this.missed = null;
    this.cost = this.pictures = 0;
  }
}
