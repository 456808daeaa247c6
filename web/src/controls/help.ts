/// The overlay that explains the page, opened with "?" or its button.

import { find } from "../dom";

export class Help {
  private readonly dialog = find<HTMLDialogElement>("help");

  constructor() {
    find("show-help").addEventListener("click", () => this.toggle());
    find("close-help").addEventListener("click", () => this.dialog.close());
    // a click outside the sheet closes it
    this.dialog.addEventListener("click", (e) => e.target === this.dialog && this.dialog.close());
  }

  toggle(): void {
    if (this.dialog.open) this.dialog.close();
    else this.dialog.showModal();
  }
}
