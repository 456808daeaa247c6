/// Shows whether a held hand receives the scene's intended stimulus, and what to change if it does not.

import { find, setText } from "../dom";
import type { Frame } from "../wire";

const kLeast = 500; // shortest time that a sentence stays, so that it can be read [ms]

export class GateSign {
  private readonly root = find("gate");
  private said = -Infinity; // time of the last change [ms]

  /// @param now the page's clock [ms].
  show({ gate }: Frame, now: number): void {
    this.root.hidden = gate === null;
    if (gate === null) return;
    const passed = String(gate.passed);
    if (this.root.dataset.passed === passed && now - this.said < kLeast) return;
    this.said = now;
    this.root.dataset.passed = passed;
    setText(find("gate-word"), gate.passed ? "Stimulus ready" : "Stimulus not ready");
    setText(find("gate-why"), gate.sentence);
  }
}
