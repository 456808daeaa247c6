/// The part of the page's state that is kept in its address, after the #, so that it can be shared and reloaded.

import type { Control, Value } from "./messages";

export const kThemes = ["system", "light", "dark"] as const;
export type Theme = (typeof kThemes)[number];
export const kPictures = ["auto", "on", "off"] as const;
/// Whether the three-dimensional picture is drawn; "auto": unless drawing it slows the run down.
export type PictureMode = (typeof kPictures)[number];
export const kSpans = [10, 30, 120] as const;

export interface PageState {
  settings: Record<string, string>; // by control; only those that differ from the run's start
  eye?: number[]; // azimuth, elevation [degrees], distance, and x, y, z of the view's target [mm]
  theme?: Theme;
  large?: boolean;
  folded?: string[]; // closed groups
  skin?: string;
  picture?: PictureMode;
  scale?: number; // end of the locked colour scale [Pa]
  span?: number; // time that the strips show [s]
  still?: boolean; // holds the page still, for screenshots
}

const kControl = "set.";

function oneOf<T extends string>(all: readonly T[], value: string | null): T | undefined {
  return all.find((v) => v === value);
}

/// Reads an address's hash. Values that are invalid for their key are ignored.
export function readAddress(hash: string): PageState {
  const query = new URLSearchParams(hash.replace(/^#/, ""));
  const state: PageState = { settings: {} };
  for (const [key, value] of query) if (key.startsWith(kControl)) state.settings[key.slice(kControl.length)] = value;
  const eye = (query.get("eye") ?? "").split(",").map(Number);
  if (eye.length === 6 && eye.every(Number.isFinite)) state.eye = eye;
  const theme = oneOf(kThemes, query.get("theme"));
  if (theme !== undefined) state.theme = theme;
  if (query.has("large")) state.large = query.get("large") === "1";
  if (query.has("folded")) state.folded = (query.get("folded") ?? "").split(",").filter((name) => name !== "");
  const skin = query.get("skin");
  if (skin !== null) state.skin = skin;
  const picture = oneOf(kPictures, query.get("picture"));
  if (picture !== undefined) state.picture = picture;
  const scale = Number(query.get("scale"));
  if (scale > 0 && Number.isFinite(scale)) state.scale = scale;
  const span = Number(query.get("span"));
  if (kSpans.some((s) => s === span)) state.span = span;
  if (query.has("still")) state.still = true;
  return state;
}

export function writeAddress(state: PageState): string {
  const parts: string[] = [];
  const add = (key: string, value: string | number | undefined) => {
    if (value !== undefined) parts.push(`${key}=${encodeURIComponent(value).replaceAll("%2C", ",")}`);
  };
  for (const [id, value] of Object.entries(state.settings)) add(kControl + id, value);
  add("eye", state.eye?.map((v) => Math.round(10 * v) / 10).join(","));
  add("theme", state.theme);
  if (state.large !== undefined) add("large", state.large ? 1 : 0);
  add("folded", state.folded?.join(","));
  add("skin", state.skin);
  add("picture", state.picture);
  add("scale", state.scale);
  add("span", state.span);
  if (state.still) parts.push("still");
  return parts.length > 0 ? `#${parts.join("&")}` : "";
}

/// A control's value as written in the address: 8.7, not 8.700000000000001.
export function inWords(value: Value): string {
  return typeof value === "number" ? String(Number(value.toPrecision(10))) : String(value);
}

/// Controls that differ from the run's start.
export function changedSettings(controls: Control[]): Record<string, string> {
  const changed = controls.filter((c) => inWords(c.value) !== inWords(c.default));
  return Object.fromEntries(changed.map((c) => [c.id, inWords(c.value)]));
}

export interface Asked {
  control: Control;
  value: Value;
}

/// Returns the settings to change so that the controls match an address; unknown controls are ignored.
export function askedSettings(controls: Control[], settings: Record<string, string>): Asked[] {
  return controls.flatMap<Asked>((control) => {
    const asked = settings[control.id];
    if (asked === undefined || asked === inWords(control.value)) return [];
    if (control.kind === "number") return Number.isFinite(Number(asked)) ? [{ control, value: Number(asked) }] : [];
    if (control.kind === "switch") return [{ control, value: asked === "true" }];
    return control.choices.some((c) => c.value === asked) ? [{ control, value: asked }] : [];
  });
}

/// The page's address, kept up to date.
export class Address {
  readonly state = readAddress(location.hash);
  private waiting: number | undefined;

  /// Changes the entries of `change`; an undefined value removes its entry. The rest of the state stays.
  set(change: { [K in keyof PageState]?: PageState[K] | undefined }): void {
    for (const [key, value] of Object.entries(change)) {
      if (value === undefined) delete (this.state as unknown as Record<string, unknown>)[key];
      else (this.state as unknown as Record<string, unknown>)[key] = value;
    }
    // browsers limit how often the address may change
    this.waiting ??= window.setTimeout(() => {
      this.waiting = undefined;
      this.write();
    }, 300);
  }
  write(): void {
    const wanted = writeAddress(this.state);
    if (wanted !== location.hash) history.replaceState(null, "", `${location.pathname}${location.search}${wanted}`);
  }
}
