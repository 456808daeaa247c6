/// The menu of the page's tools in a narrow header.

import { find } from "../dom";

export class Menu {
  private readonly button = find<HTMLButtonElement>("menu");
  private readonly tools = find("tools");

  constructor() {
    this.button.addEventListener("click", () => this.set(!this.isOpen));
    document.addEventListener("pointerdown", ({ target }) => {
      if (target instanceof Node && !this.tools.contains(target) && !this.button.contains(target)) this.set(false);
    }, { capture: true });
    this.tools.addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !this.isOpen) return;
      event.stopPropagation(); // Esc closes the menu only
      this.set(false);
      this.button.focus();
    });
  }

  private get isOpen(): boolean { return this.tools.dataset.open === "true"; }
  private set(open: boolean): void {
    this.tools.dataset.open = String(open);
    this.button.setAttribute("aria-expanded", String(open));
  }
}
