/// What can be turned, as the program tells it: one field for each control, in its groups and its order.

import { find, make, short } from "../dom";
import type { ChoiceControl, Control, NumberControl } from "../messages";

type Value = string | number | boolean;
type Send = (id: string, value: Value) => void;

/// What belongs after a control's label.
interface Made<C> {
  parts: HTMLElement[];
  show(control: C): void;
}

/// A control on the page.
interface Field {
  root: HTMLElement;
  error: HTMLElement;
  show(control: Control): void;
}

const kWordsInARow = 26; // letters of all choices together that still fit beside each other

function segments(control: ChoiceControl, id: string, send: Send): Made<ChoiceControl> {
  const radios = control.choices.map(({ value, label }) => {
    const radio = make("input", { type: "radio", name: id, value, id: `${id}-${value}` });
    radio.addEventListener("change", () => radio.checked && send(control.id, value));
    return { value, radio, label: make("label", { for: `${id}-${value}` }, label) };
  });
  const input = make("div", { class: "segments", role: "radiogroup", "aria-labelledby": `${id}-label` }, ...radios.flatMap((r) => [r.radio, r.label]));
  return {
    parts: [input],
    show: (c) => radios.forEach(({ value, radio }) => {
      radio.checked = value === c.value;
      radio.disabled = !c.enabled;
    }),
  };
}

function list(control: ChoiceControl, id: string, send: Send): Made<ChoiceControl> {
  const input = make("select", { id, "aria-describedby": `${id}-error` }, ...control.choices.map(({ value, label }) => make("option", { value }, label)));
  input.addEventListener("change", () => send(control.id, input.value));
  return {
    parts: [input],
    show: (c) => {
      input.value = c.value;
      input.disabled = !c.enabled;
    },
  };
}

/// A slider and a field for the number. While somebody moves one of them the program's echo does not take it away.
function numbers(control: NumberControl, id: string, send: Send): Made<NumberControl> {
  const bounds = { min: control.min, max: control.max, step: control.step };
  const slider = make("input", { type: "range", id, ...bounds, "aria-describedby": `${id}-error` });
  const field = make("input", { type: "number", ...bounds, "aria-label": `${control.label}, as a number${control.unit ? ` in ${control.unit}` : ""}`, "aria-describedby": `${id}-error` });
  let sent = 0, waiting: number | undefined;
  let held = 0; // until then the page's own value stands [ms]
  let typing = false;
  const paint = () => {
    const share = (Number(slider.value) - Number(slider.min)) / (Number(slider.max) - Number(slider.min) || 1);
    slider.style.setProperty("--share", `${100 * share}%`);
    slider.setAttribute("aria-valuetext", `${short(Number(slider.value))}${control.unit ? ` ${control.unit}` : ""}`);
  };
  const go = (value: number) => {
    held = performance.now() + 600;
    window.clearTimeout(waiting);
    // a slider under a hand says much; the newest counts
    const later = Math.max(0, sent + 80 - performance.now());
    waiting = window.setTimeout(() => {
      sent = performance.now();
      send(control.id, value);
    }, later);
  };
  slider.addEventListener("input", () => {
    field.value = slider.value;
    paint();
    go(Number(slider.value));
  });
  field.addEventListener("input", () => (typing = true));
  field.addEventListener("blur", () => (typing = false));
  field.addEventListener("change", () => {
    typing = false;
    if (field.value.trim() !== "" && Number.isFinite(Number(field.value))) go(Number(field.value));
  });
  return {
    parts: [field, make("span", { class: "unit" }, control.unit ?? ""), slider],
    show: (c) => {
      for (const input of [slider, field]) {
        input.disabled = !c.enabled;
        Object.assign(input, { min: String(c.min), max: String(c.max), step: String(c.step) });
      }
      if (typing || (performance.now() < held && Number(slider.value) !== c.value)) return;
      slider.value = String(c.value);
      field.value = String(Number(c.value.toPrecision(10))); // 8.7, not 8.700000000000001
      paint();
    },
  };
}

function onOff(control: Control, id: string, send: Send): Made<Control> {
  const input = make("input", { type: "checkbox", role: "switch", id, class: "switch", "aria-describedby": `${id}-error` });
  input.addEventListener("change", () => send(control.id, input.checked));
  return {
    parts: [input],
    show: (c) => {
      input.checked = c.value === true;
      input.disabled = !c.enabled;
    },
  };
}

function makeField(control: Control, send: Send): Field {
  const id = `control-${control.id}`;
  const segmented = control.kind === "choice" && control.choices.reduce((n, c) => n + c.label.length + 2, 0) <= kWordsInARow;
  const made = control.kind === "choice" ? (segmented ? segments : list)(control, id, send) : control.kind === "number" ? numbers(control, id, send) : onOff(control, id, send);
  const label = segmented ? make("span", { class: "label", id: `${id}-label` }, control.label) : make("label", { class: "label", for: id }, control.label);
  const error = make("p", { class: "error", id: `${id}-error`, role: "alert" });
  for (const part of made.parts) part.setAttribute("aria-description", control.help);
  const root = make("div", { class: `field ${control.kind}`, "data-control": control.id, title: control.help }, label, ...made.parts, error);
  return {
    root,
    error,
    show: (c) => {
      root.dataset.value = String(c.value);
      root.classList.toggle("disabled", !c.enabled);
      (made.show as (c: Control) => void)(c);
    },
  };
}

/// What would make another field of a control.
function shape(c: Control): string {
  return JSON.stringify([c.id, c.group, c.kind, c.label, c.unit, c.help, c.kind === "choice" ? c.choices : 0]);
}

export class Controls {
  private readonly fields = new Map<string, Field>();
  private made = "";
  private last: string | null = null;

  constructor(private readonly send: Send) {}

  show(controls: Control[]): void {
    const wanted = controls.map(shape).join();
    if (wanted !== this.made) this.build(controls);
    this.made = wanted;
    for (const c of controls) this.fields.get(c.id)?.show(c);
  }

  /// Says beside the control that was turned last why that could not be done.
  /// @return whether there is one.
  showError(sentence: string): boolean {
    const field = this.last === null ? undefined : this.fields.get(this.last);
    if (field === undefined) return false;
    field.error.textContent = sentence;
    this.last = null;
    return true;
  }

  /// What is asked from now on is not a control's.
  forget(): void { this.last = null; }

  private build(controls: Control[]): void {
    const focused = document.activeElement?.id;
    const root = find("controls");
    root.replaceChildren();
    this.fields.clear();
    const groups = new Map<string, HTMLElement>();
    for (const control of controls) {
      let group = groups.get(control.group);
      if (group === undefined) {
        group = make("fieldset", {}, make("legend", {}, control.group));
        groups.set(control.group, group);
        root.append(group);
      }
      const field = makeField(control, (id, value) => {
        field.error.textContent = "";
        this.last = id;
        this.send(id, value);
      });
      this.fields.set(control.id, field);
      group.append(field.root);
    }
    if (focused) document.getElementById(focused)?.focus();
  }
}
