/// Decides when a side view replaces the picture in three dimensions, and when that is tried again.

const kFirstCalm = 20_000; // time that the run must hold its rates before the picture comes back [ms]
const kLongestCalm = 320_000; // the time doubles up to this if the picture does not stay [ms]
const kStays = 60_000; // time after which a picture that came back counts as staying [ms]

export class Fallback {
  /// whether the side view replaces the picture
  flat = false;
  private calm = kFirstCalm;
  private held: number | null = null; // since when the run holds its rates, while flat [ms]
  private back = -Infinity; // when the picture last came back [ms]

  /// @param now [ms]. @param off whether the picture costs more than the run can spare. @param held whether the run
  /// holds its rates. @return whether the picture comes back now: its cost has to be measured anew.
  update(now: number, off: boolean, held: boolean): boolean {
    if (!this.flat) {
      if (!off) return false;
      this.flat = true;
      this.calm = now - this.back < kStays ? Math.min(kLongestCalm, 2 * this.calm) : kFirstCalm;
      this.held = null;
      return false;
    }
    if (!held) this.held = null;
    else this.held ??= now;
    if (this.held === null || now - this.held < this.calm) return false;
    this.flat = false;
    this.back = now;
    return true;
  }

  /// The user asks for the picture.
  reset(): void {
    this.flat = false;
    this.calm = kFirstCalm;
    this.back = -Infinity;
  }
}
