/// Shows the verdict at the top of the page.

import { find, setText } from "../dom";
import { PerSecond } from "./history";
import { verdictOf, type Moment, type Verdict } from "./verdict";
import { numberOf, type Frame } from "../wire";

const kSilent = 400; // modulated output has silent moments, which are ignored up to this length [ms]
const kLeast = 500; // shortest time that a reason stays, so that it can be read [ms]

export class VerdictSign {
  private readonly root = find("verdict");
  private readonly missed = new PerSecond();
  private dropouts = 0;
  private played = -Infinity; // when the array last played [ms]
  private said = -Infinity; // when the reason last changed [ms]
  private shown: Verdict | null = null;

  constructor() { this.lost(); }

  /// Counts the dropouts of a frame. @param now the page's clock [s].
  add(frame: Frame, now: number): void { this.dropouts = this.missed.add(now, numberOf(frame, "missed_blocks")); }

  /// @param now the page's clock [ms].
  show(moment: Omit<Moment, "connected" | "dropouts">, now: number): void {
    const verdict = verdictOf({ ...moment, connected: true, dropouts: this.dropouts });
    if (verdict.state === "playing" || verdict.state === "flawed") this.played = now;
    if (verdict.state === "silent" && now - this.played <= kSilent) return;
    const same = this.shown?.state === verdict.state;
    if (same && this.shown?.why !== verdict.why && now - this.said < kLeast) verdict.why = this.shown!.why;
    if (this.shown?.why !== verdict.why) this.said = now;
    this.draw(verdict);
  }

  lost(): void {
    this.played = -Infinity;
    this.draw(verdictOf({
      connected: false, frame: null, state: null, sensation: null, dropouts: 0, ratesMissed: false,
    }));
  }

  private draw(verdict: Verdict): void {
    this.shown = verdict;
    this.root.dataset.verdict = verdict.state;
    setText(find("verdict-word"), verdict.word);
    setText(find("verdict-why"), verdict.why);
    for (const part of ["shape", "strength"] as const) {
      setText(find(`felt-${part}`), verdict[part].value);
      setText(find(`felt-${part}-words`), verdict[part].words);
    }
  }
}
