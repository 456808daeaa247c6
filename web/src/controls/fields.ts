/// The field of one control: its label, its input element and its error message.

import { make } from "../dom";
import type { ChoiceControl, Control, NumberControl, Value } from "../messages";
import { short } from "../text";
import { tip } from "./tips";

export interface Actions {
  set(id: string, value: Value): void;
  /// Shows next to the control why the value was rejected, and restores the value in force.
  refuse(id: string, sentence: string): void;
}

/// The elements that follow a control's label.
interface Made<C> {
  parts: HTMLElement[];
  /// @param force shows the value even while the user is typing.
  show(control: C, force: boolean): void;
}

export interface Field {
  root: HTMLElement;
  error: HTMLElement;
  /// @param force shows the program's value even while a new one is being entered.
  show(control: Control, force?: boolean): void;
}

const kAnswered = 3000; // a value set here stays until the program confirms it, at most for this long [ms]
const kWordsInARow = 26; // letters of all choices together that fit in one row

function segments(control: ChoiceControl, id: string, act: Actions): Made<ChoiceControl> {
  const radios = control.choices.map(({ value, label }) => {
    const radio = make("input", { type: "radio", name: id, value, id: `${id}-${value}` });
    radio.addEventListener("change", () => radio.checked && act.set(control.id, value));
    return { value, radio, label: make("label", { for: `${id}-${value}` }, label) };
  });
  const input = make(
    "div", { class: "segments", role: "radiogroup", "aria-labelledby": `${id}-label` },
    ...radios.flatMap((r) => [r.radio, r.label]),
  );
  return {
    parts: [input],
    show: (c) => radios.forEach(({ value, radio }) => {
      radio.checked = value === c.value;
      radio.disabled = !c.enabled;
    }),
  };
}

function list(control: ChoiceControl, id: string, act: Actions): Made<ChoiceControl> {
  const options = control.choices.map(({ value, label }) => make("option", { value }, label));
  const input = make("select", { id, "aria-describedby": `${id}-error` }, ...options);
  input.addEventListener("change", () => act.set(control.id, input.value));
  return {
    parts: [input],
    show: (c) => {
      input.value = c.value;
      input.disabled = !c.enabled;
    },
  };
}

export function withUnit(value: number, unit: string | undefined): string {
  return `${short(value)}${unit ? ` ${unit}` : ""}`;
}

/// A slider and a number box. The box is not updated while the user types in it.
function numbers(control: NumberControl, id: string, act: Actions): Made<NumberControl> {
  const bounds = { min: control.min, max: control.max, step: control.step, "aria-describedby": `${id}-error` };
  const slider = make("input", { type: "range", id, ...bounds });
  const name = `${control.label}, as a number${control.unit ? ` in ${control.unit}` : ""}`;
  const box = make("input", { type: "number", ...bounds, "aria-label": name });
  let typing = false;
  let inForce = control;
  const paint = () => {
    const share = (Number(slider.value) - Number(slider.min)) / (Number(slider.max) - Number(slider.min) || 1);
    slider.style.setProperty("--share", `${100 * share}%`);
    slider.setAttribute("aria-valuetext", withUnit(Number(slider.value), control.unit));
  };
  const put = (c: NumberControl) => {
    slider.value = String(c.value);
    box.value = String(Number(c.value.toPrecision(10))); // 8.7, not 8.700000000000001
    paint();
  };
  slider.addEventListener("input", () => {
    box.value = slider.value;
    paint();
    act.set(control.id, Number(slider.value));
  });
  box.addEventListener("input", () => (typing = true));
  box.addEventListener("change", () => {
    typing = false;
    const value = Number(box.value);
    if (box.value.trim() !== "" && Number.isFinite(value)) return act.set(control.id, value);
    const { min, max, unit, value: now } = inForce;
    const stays = `it stays at ${withUnit(now, unit)}`;
    act.refuse(control.id, `Give a number from ${short(min)} to ${withUnit(max, unit)}; ${stays}.`);
  });
  box.addEventListener("blur", () => {
    typing = false;
    put(inForce);
  });
  return {
    parts: [box, make("span", { class: "unit" }, control.unit ?? ""), slider],
    show: (c, force) => {
      inForce = c;
      for (const input of [slider, box]) {
        input.disabled = !c.enabled;
        Object.assign(input, { min: String(c.min), max: String(c.max), step: String(c.step) });
      }
      typing &&= !force;
      if (!typing) put(c);
    },
  };
}

function onOff(control: Control, id: string, act: Actions): Made<Control> {
  const input = make("input", {
    type: "checkbox", role: "switch", id, class: "switch", "aria-describedby": `${id}-error`,
  });
  input.addEventListener("change", () => act.set(control.id, input.checked));
  return {
    parts: [input],
    show: (c) => {
      input.checked = c.value === true;
      input.disabled = !c.enabled;
    },
  };
}

function makeParts(control: Control, id: string, segmented: boolean, act: Actions): Made<never> {
  if (control.kind === "choice") return (segmented ? segments : list)(control, id, act);
  return control.kind === "number" ? numbers(control, id, act) : onOff(control, id, act);
}

export function makeField(control: Control, act: Actions): Field {
  const id = `control-${control.id}`;
  const letters = control.kind === "choice" ? control.choices.reduce((n, c) => n + c.label.length + 2, 0) : Infinity;
  const segmented = letters <= kWordsInARow;
  let last = control; // as last received from the program
  let wanted: Value | undefined; // set here, not yet confirmed; earlier states still in transit do not overwrite it
  let answer: ReturnType<typeof setTimeout> | undefined;

  const set = (of: string, value: Value) => {
    clearTimeout(answer);
    answer = setTimeout(() => { wanted = undefined; show(last); }, kAnswered);
    wanted = value;
    show(last);
    act.set(of, value);
  };
  const made = makeParts(control, id, segmented, { ...act, set });
  const label = segmented
    ? make("span", { class: "label", id: `${id}-label` }, control.label)
    : make("label", { class: "label", for: id }, control.label);
  const error = make("p", { class: "error", id: `${id}-error`, role: "alert" });
  for (const part of made.parts) part.setAttribute("aria-description", control.help);
  const attributes = { class: `field ${control.kind}`, "data-control": control.id };
  const name = make("div", { class: "name" }, label, tip(control.label, control.help));
  const root = make("div", attributes, name, ...made.parts, error);
  const show = (c: Control, force = false) => {
    last = c;
    if (force || c.value === wanted) wanted = undefined;
    root.dataset.value = String(c.value);
    root.classList.toggle("disabled", !c.enabled);
    (made.show as (c: Control, force: boolean) => void)({ ...c, value: wanted ?? c.value } as Control, force);
  };
  return { root, error, show };
}
