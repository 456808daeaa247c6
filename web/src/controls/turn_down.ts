/// Says that the run does not keep its rates, with a button that turns down what is too much.

import { find, setText } from "../dom";
import type { Value } from "../messages";
import type { Offer } from "../panels/rates";

export class TurnDown {
  private readonly button = find<HTMLButtonElement>("turn-down");
  private offer: Offer | null = null;

  constructor(set: (id: string, value: Value) => void) {
    this.button.addEventListener("click", () => {
      if (this.offer !== null) set(this.offer.id, this.offer.value);
    });
  }

  /// @param sentence why the rates are missed; "" where they are held.
  show(sentence: string, offer: Offer | null): void {
    this.offer = offer;
    find("missed").hidden = sentence === "";
    setText(find("rates"), sentence);
    this.button.hidden = offer === null;
    if (offer !== null) setText(this.button, offer.label);
  }
}
