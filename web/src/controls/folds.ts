/// Groups that fold. Which ones are closed is stored in the browser and in the address.

import type { Address } from "../address";
import { remember, remembered } from "../stored";

export class Folds {
  private readonly all = new Map<string, HTMLDetailsElement>();

  constructor(private readonly address: Address) {
    for (const group of document.querySelectorAll<HTMLDetailsElement>("details[data-fold]")) this.adopt(group);
  }

  /// Adds a group named by its data-fold; its `open` is the default where nothing is stored.
  adopt(group: HTMLDetailsElement): void {
    const name = group.dataset.fold ?? "";
    this.all.set(name, group);
    const kept = this.address.state.folded ?? remembered("folded")?.split(",");
    if (kept !== undefined) group.open = !kept.includes(name);
    // only clicks are stored: toggle events also come from the page itself
    group.querySelector("summary")?.addEventListener("click", () => window.setTimeout(() => this.keep()));
  }

  private keep(): void {
    const folded = [...this.all].filter(([, group]) => !group.open).map(([name]) => name);
    const before = this.address.state.folded ?? [];
    // groups that are not on the page now, for instance of a lost connection, keep their state
    folded.push(...before.filter((name) => !this.all.has(name)));
    remember("folded", folded.join(","));
    this.address.set({ folded });
  }
}
