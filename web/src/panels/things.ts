/// The list of what the three-dimensional picture shows: a swatch and a name for each.

import { find, make, setText } from "../dom";
import type { Hello } from "../messages";
import type { FieldMode } from "../scene/field_maps";
import { handLength } from "../scene/hand_bones";
import type { Frame } from "../wire";

const kNames = {
  array: "array of transducers", box: "box of the smoke", smoke: "smoke", hand: "hand", target: "",
  path: "path of a focal point", focus: "focal point", ruler: "height above the array [mm]",
  under: "place under the palm",
} as const;
type Thing = keyof typeof kNames;

const kTarget: Record<FieldMode, string> = {
  target: "target pressure on the skin", rendered: "reconstruction on the skin",
  difference: "reconstruction less target, on the skin", none: "",
};

export class Things {
  private readonly items = new Map<Thing, { root: HTMLElement; text: HTMLElement }>();

  constructor() {
    for (const [thing, name] of Object.entries(kNames) as [Thing, string][]) {
      const text = make("span", {}, name);
      const swatch = make("i", { class: `thing ${thing}`, "aria-hidden": "true" });
      const root = make("li", { "data-thing": thing }, swatch, text);
      this.items.set(thing, { root, text });
      find("things").append(root);
    }
  }

  setHello(hello: Hello): void { this.name("box", `box of the smoke, ${hello.box_mm.edge.toFixed(0)} mm wide`); }

  show(frame: Frame, shown: { mode: FieldMode; smoke: boolean; pageHand: boolean }): void {
    const hand = frame.hands[0];
    this.see("hand", hand !== undefined);
    if (hand !== undefined) this.name("hand", `hand, ${handLength(hand).toFixed(0)} mm long`);
    this.see("smoke", shown.smoke && frame.smoke !== null);
    this.see("target", hand !== undefined && shown.mode !== "none");
    this.name("target", kTarget[shown.mode]);
    this.see("path", frame.plan.some((p) => p.kind === "path"));
    this.see("focus", frame.plan.length > 0);
    this.see("under", shown.pageHand);
  }

  private see(thing: Thing, seen: boolean): void { this.items.get(thing)!.root.hidden = !seen; }
  private name(thing: Thing, name: string): void { setText(this.items.get(thing)!.text, name); }
}
