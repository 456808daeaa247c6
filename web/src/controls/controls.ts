/// The controls that the program lists: one field for each, in its groups and order.

import { find, make } from "../dom";
import type { Control, Value } from "../messages";
import { makeField, type Field } from "./fields";
import type { Folds } from "./folds";

// groups that are rarely changed are closed at first
const kClosed = ["Output", "Hand"];

/// The properties of a control that require a new field when they change.
function shape(c: Control): string {
  return JSON.stringify([c.id, c.group, c.kind, c.label, c.unit, c.help, c.kind === "choice" ? c.choices : 0]);
}

export class Controls {
  private readonly fields = new Map<string, Field>();
  private readonly known = new Map<string, Control>();
  private made = "";
  private last: string | null = null;
  private stale = false; // the fields may show values of an earlier connection

  constructor(private readonly send: (id: string, value: Value) => void, private readonly folds: Folds) {}

  show(controls: Control[]): void {
    const wanted = controls.map(shape).join();
    if (wanted !== this.made) this.build(controls);
    this.made = wanted;
    for (const c of controls) {
      this.known.set(c.id, c);
      this.fields.get(c.id)?.show(c, this.stale);
    }
    this.stale = false;
  }

  /// The connection is lost, and with it the values that were not sent.
  lost(): void { this.stale = true; }

  /// Shows why a control could not be set, next to it, and restores the value in force.
  /// @param id the control; by default the one set last. @return whether the control exists.
  showError(sentence: string, id = this.last): boolean {
    this.last = null;
    const field = this.fields.get(id ?? ""), control = this.known.get(id ?? "");
    if (field === undefined || control === undefined) return false;
    field.error.textContent = sentence;
    field.show(control, true);
    return true;
  }

  /// Later errors are not attributed to a control.
  forget(): void { this.last = null; }

  private set(id: string, value: Value): void {
    this.fields.get(id)!.error.textContent = "";
    this.last = id;
    this.send(id, value);
  }

  private build(controls: Control[]): void {
    const focused = document.activeElement?.id;
    const root = find("controls");
    root.replaceChildren();
    this.fields.clear();
    const groups = new Map<string, HTMLElement>();
    const act = {
      set: (id: string, value: Value) => this.set(id, value),
      refuse: (id: string, sentence: string) => void this.showError(sentence, id),
    };
    for (const control of controls) {
      let group = groups.get(control.group);
      if (group === undefined) {
        group = make("div", { role: "group", "aria-label": control.group });
        groups.set(control.group, group);
        const title = make("summary", {}, make("h2", {}, control.group));
        const open = !kClosed.includes(control.group);
        const fold = make("details", { class: "group", "data-fold": control.group, open }, title, group);
        root.append(fold);
        this.folds.adopt(fold);
      }
      const field = makeField(control, act);
      this.fields.set(control.id, field);
      group.append(field.root);
    }
    if (focused) document.getElementById(focused)?.focus();
  }
}
