/// Shows that the run misses its rates and what the program advises, with a button if one setting helps.

import { find, setText } from "../dom";
import type { Advice, Value } from "../messages";

export class TurnDown {
  private readonly button = find<HTMLButtonElement>("turn-down");
  private offer: Advice["set"] = null;

  constructor(set: (id: string, value: Value) => void) {
    this.button.addEventListener("click", () => {
      if (this.offer !== null) set(this.offer.id, this.offer.value);
    });
  }

  /// @param sentence why the rates are missed; "" while they are met.
  show(sentence: string, advice: Advice | null): void {
    this.offer = sentence === "" ? null : advice?.set ?? null;
    find("missed").hidden = sentence === "";
    setText(find("rates"), advice === null ? sentence : `${sentence} ${advice.sentence}`);
    this.button.hidden = this.offer === null;
    if (this.offer !== null) setText(this.button, this.offer.label);
  }
}
