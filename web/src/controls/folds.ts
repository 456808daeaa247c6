/// Groups that fold: which of them are closed is kept in this browser and in the address.

import type { Address } from "../address";
import { remember, remembered } from "../stored";

export class Folds {
  private readonly all = new Map<string, HTMLDetailsElement>();

  constructor(private readonly address: Address) {
    for (const group of document.querySelectorAll<HTMLDetailsElement>("details[data-fold]")) this.adopt(group);
  }

  /// A group with the name in data-fold; its `open` is what holds where nothing is kept.
  adopt(group: HTMLDetailsElement): void {
    const name = group.dataset.fold ?? "";
    this.all.set(name, group);
    const kept = this.address.state.folded ?? remembered("folded")?.split(",");
    if (kept !== undefined) group.open = !kept.includes(name);
    // somebody's click, not every toggle: those of the page itself are not to be kept
    group.querySelector("summary")?.addEventListener("click", () => window.setTimeout(() => this.keep()));
  }

  private keep(): void {
    const folded = [...this.all].filter(([, group]) => !group.open).map(([name]) => name);
    const before = this.address.state.folded ?? [];
    // groups that are not on the page now, as those of a program that is gone, stay as they are
    folded.push(...before.filter((name) => !this.all.has(name)));
    remember("folded", folded.join(","));
    this.address.set({ folded });
  }
}
