/// The end of the colour scale. It follows the pressures unless it is locked.

import type { Frame } from "../wire";

/// The smallest of 1, 1.5, 2, 3, 4, 5, 6, 8 × 10ⁿ that is at least x.
export function roundedUp(x: number): number {
  if (!(x > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(x));
  return power * ([1, 1.5, 2, 3, 4, 5, 6, 8].find((step) => step * power >= x * (1 - 1e-9)) ?? 10);
}

const kHold = 4000; // time before the scale shrinks [ms]

export class PressureScale {
  private smallest = 0; // time from which the scale may shrink [ms]
  private automatic = 1;
  locked: number | null = null; // [Pa]

  /// [Pa]
  get end(): number { return this.locked ?? this.automatic; }

  /// One end for target and reconstruction of all hands. It grows at once, and shrinks after some seconds.
  measure(frame: Frame, now: number): void {
    let most = 0;
    for (const p of frame.field) {
      let top = 0;
      for (let i = 0; i < p.target.length; ++i) if (p.skin[i]) top = Math.max(top, p.target[i]!, p.rendered[i]!);
      most = Math.max(most, (top / 65535) * p.scale);
    }
    const wanted = roundedUp(most);
    if (wanted >= this.automatic || most === 0) this.smallest = now + kHold;
    if (wanted > this.automatic || (most > 0 && now > this.smallest)) this.automatic = wanted;
  }
}
