/// Theme and type size, stored in the browser and in the address.

import { kThemes, type Address, type Theme } from "../address";
import { find } from "../dom";
import { remember, remembered } from "../stored";

export class Looks {
  private readonly prefersDark = window.matchMedia("(prefers-color-scheme: dark)");
  private readonly theme = find<HTMLSelectElement>("theme");
  private readonly large = find<HTMLInputElement>("large-type");

  constructor(address: Address, private readonly changed: (dark: boolean) => void) {
    const kept = address.state.theme ?? remembered("theme");
    this.theme.value = kThemes.includes(kept as Theme) ? String(kept) : "system";
    this.large.checked = address.state.large ?? remembered("large") === "true";
    this.theme.addEventListener("change", () => {
      remember("theme", this.theme.value);
      address.set({ theme: this.theme.value as Theme });
      this.apply();
    });
    this.large.addEventListener("change", () => {
      remember("large", String(this.large.checked));
      address.set({ large: this.large.checked });
      this.apply();
    });
    this.prefersDark.addEventListener("change", () => this.apply());
  }

  get dark(): boolean { return this.theme.value === "system" ? this.prefersDark.matches : this.theme.value === "dark"; }

  apply(): void {
    document.documentElement.dataset.theme = this.dark ? "dark" : "light";
    document.documentElement.dataset.type = this.large.checked ? "large" : "normal";
    this.changed(this.dark);
  }
}
