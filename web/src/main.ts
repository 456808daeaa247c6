import { CalibrationGuide } from "./controls/calibration";
import { Capture } from "./controls/capture";
import { Controls } from "./controls/controls";
import { Looks } from "./controls/looks";
import { PageHand } from "./controls/page_hand";
import { Transport } from "./controls/transport";
import { Connection } from "./connection";
import { find, make, reducedMotion } from "./dom";
import { Legend } from "./panels/legend";
import { Numbers } from "./panels/numbers";
import { Planes } from "./panels/planes";
import { Strips } from "./panels/strips";
import { kViews } from "./scene/camera";
import { kFieldModes, type FieldMode } from "./scene/field_maps";
import { View } from "./scene/view";
import "./inspection";
import type { PageMessage } from "./messages";
import "./style.css";
import type { Frame } from "./wire";

const view = new View(find<HTMLCanvasElement>("view"));
const planes = new Planes();
const legend = new Legend();
const strips = new Strips();
const numbers = new Numbers();

// what went wrong, said where it can be seen, for a while
const notice = find("notice");
let noticeTimer: number | undefined;
function say(sentence: string): void {
  notice.textContent = sentence;
  window.clearTimeout(noticeTimer);
  noticeTimer = window.setTimeout(() => (notice.textContent = ""), 8000);
}

const connection = new Connection(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`, {
  frame: (frame) => {
    if (still) return;
    shown = frame;
    dirty = true;
    strips.add(frame, performance.now() / 1000);
  },
  hello: (hello) => {
    view.array.set(hello);
    view.array.setDark(looks.dark);
    pageHand.setBox(hello);
    find("about").textContent = `prostm ${hello.prostm} · device ${hello.device}, ${hello.array.transducers_mm.length} transducers`;
  },
  state: (state) => {
    controls.show(state.controls);
    transport.show(state);
    guide.show(state);
  },
  error: (sentence) => {
    if (!guide.showError(sentence) && !controls.showError(sentence)) say(sentence);
  },
  link: (link, sentence) => {
    document.documentElement.dataset.link = link;
    find("link").textContent = sentence;
  },
});

const controls = new Controls((id, value) => connection.send({ type: "set", id, value }));
const sendOther = (message: PageMessage): void => {
  controls.forget();
  connection.send(message);
};
const transport = new Transport(sendOther);
const guide = new CalibrationGuide(sendOther, (calibration) => view.array.setCalibration(calibration));
const pageHand = new PageHand(view, sendOther);
const looks = new Looks((dark) => {
  view.setDark(dark);
  planes.setDark(dark);
  strips.setDark(dark);
  dirty = true;
});
new Capture({
  canvas: view.canvas,
  render: () => view.renderWell(),
  caption: () => {
    const { state } = connection;
    const frame = shown;
    const turned = (state?.controls ?? []).map((c) => `${c.label} ${c.kind === "choice" ? (c.choices.find((x) => x.value === c.value)?.label ?? c.value) : c.kind === "switch" ? (c.value ? "on" : "off") : `${c.value}${c.unit ? ` ${c.unit}` : ""}`}`);
    return [`prostm at ${frame === null ? "–" : frame.run.time.toFixed(2)} s`, frame === null ? "" : Numbers.caption(frame), turned.join("  ·  ")];
  },
}, say);

// what the picture shows
const slowest = [1, 2, 5, 10, 20, 50, 100];
const slow = find<HTMLInputElement>("slow-motion");
function setSlowMotion(): void {
  const factor = slowest[Number(slow.value)] ?? 50;
  view.paths.slowdown = factor;
  const words = factor === 1 ? "as played" : `1/${factor} of the speed`;
  find("slow-motion-value").textContent = factor === 1 ? "1/1" : `1/${factor}`;
  slow.setAttribute("aria-valuetext", words);
  slow.style.setProperty("--share", `${(100 * Number(slow.value)) / (slowest.length - 1)}%`);
}
slow.addEventListener("input", setSlowMotion);
let fieldMode: FieldMode = "rendered";
function setField(mode: FieldMode): void {
  fieldMode = mode;
  view.setField(mode);
  legend.show(mode, planes.scale, looks.dark);
}
const fieldNames: Record<FieldMode, string> = { target: "Target", rendered: "Rendered", difference: "Difference", none: "None" };
for (const mode of [...kFieldModes.slice(1), kFieldModes[0]] as FieldMode[]) {
  const radio = make("input", { type: "radio", name: "skin-field", id: `skin-${mode}`, value: mode, checked: mode === fieldMode });
  radio.addEventListener("change", () => radio.checked && setField(mode));
  find("skin-field").append(radio, make("label", { for: `skin-${mode}` }, fieldNames[mode]));
}
for (const { id, label } of kViews) {
  const button = make("button", { type: "button", "data-view": id }, label);
  button.addEventListener("click", () => view.eye.go(id));
  find("views").append(button);
}
const through = find<HTMLInputElement>("see-through");
through.addEventListener("change", () => view.hands.setOpacity(through.checked ? 0.62 : 1));
const smoky = find<HTMLInputElement>("show-smoke");
smoky.addEventListener("change", () => (view.showSmoke = smoky.checked));

view.canvas.addEventListener("keydown", (event) => {
  if (pageHand.key(event) || view.eye.key(event)) event.preventDefault();
});
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") pageHand.release();
  const typing = event.target instanceof HTMLElement && event.target.closest("input, select, button, summary, dialog") !== null;
  if (event.key === " " && !typing) {
    event.preventDefault();
    transport.toggle();
  }
});
document.addEventListener("visibilitychange", () => connection.sendRate());
reducedMotion.addEventListener("change", () => (view.eye.smooth = !reducedMotion.matches));

// pictures follow the screen; panels are drawn when there is something new, strips a few times a second
let shown: Frame | null = null, dirty = true, pictures = 0, before = 0, stripsAt = 0;
function draw(now: number): void {
  window.requestAnimationFrame(draw);
  if (!view.ready(now)) return;
  const dt = before === 0 ? 0 : (now - before) / 1000;
  before = now;
  const frame = shown;
  if (frame !== null && dirty) {
    dirty = false;
    view.maps.setMax(planes.measure(frame, now));
    view.setFrame(frame);
    planes.draw(frame);
    legend.show(fieldMode, planes.scale, looks.dark);
    numbers.show(frame);
    transport.frame(frame);
  }
  if (now - stripsAt > 150 && frame !== null && !still) {
    stripsAt = now;
    strips.draw(now / 1000);
  }
  view.render(dt);
  ++pictures;
}

// for pictures of the page: #still holds it as it is, and draws every pixel of that
let still = false;
window.addEventListener("hashchange", () => {
  still = location.hash === "#still";
  view.setUnhurried(still);
});

slow.value = reducedMotion.matches ? String(slowest.length - 1) : "5";
setSlowMotion();
view.eye.smooth = !reducedMotion.matches;
setField(fieldMode);
view.hands.setOpacity(0.62);
looks.apply();
connection.open();
window.requestAnimationFrame(draw);

window.prostm = {
  get frame() { return connection.frame; },
  get state() { return connection.state; },
  get frames() { return connection.frames; },
  get refused() { return connection.refused; },
  get connections() { return connection.opened; },
  get pictures() { return pictures; },
  get speed() { return view.speed; },
  get dark() { return looks.dark; },
};
