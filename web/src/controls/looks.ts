/// Theme and size of type, kept in this browser.

import { find } from "../dom";

const kThemes = ["system", "light", "dark"] as const;
type Theme = (typeof kThemes)[number];

function remembered(key: string): string | null {
  try {
    return localStorage.getItem(key);
  } catch {
    return null; // storage may be forbidden; then nothing is kept
  }
}
function remember(key: string, value: string): void {
  try {
    localStorage.setItem(key, value);
  } catch {
    // as above
  }
}

export class Looks {
  private readonly prefersDark = window.matchMedia("(prefers-color-scheme: dark)");
  private readonly theme = find<HTMLSelectElement>("theme");
  private readonly large = find<HTMLInputElement>("large-type");

  constructor(private readonly changed: (dark: boolean) => void) {
    const kept = remembered("prostm-theme");
    this.theme.value = kThemes.includes(kept as Theme) ? String(kept) : "system";
    this.large.checked = remembered("prostm-large") === "true";
    this.theme.addEventListener("change", () => {
      remember("prostm-theme", this.theme.value);
      this.apply();
    });
    this.large.addEventListener("change", () => {
      remember("prostm-large", String(this.large.checked));
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
