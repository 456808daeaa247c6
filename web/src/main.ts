import { Address, changedSettings } from "./address";
import { CalibrationGuide } from "./controls/calibration";
import { caption } from "./controls/caption";
import { Capture } from "./controls/capture";
import { Controls } from "./controls/controls";
import { offer, stamp } from "./controls/download";
import { Folds } from "./controls/folds";
import { Help } from "./controls/help";
import { listen } from "./controls/keys";
import { Looks } from "./controls/looks";
import { Menu } from "./controls/menu";
import { Mute } from "./controls/mute";
import { PageHand } from "./controls/page_hand";
import { PictureSettings } from "./controls/picture_settings";
import { Pointer } from "./controls/point";
import { SettingsSender } from "./controls/settings_sender";
import { Rewind } from "./controls/rewind";
import { Share } from "./controls/share";
import { addTips } from "./controls/tips";
import { Transport } from "./controls/transport";
import { TurnDown } from "./controls/turn_down";
import { Connection, type Link } from "./connection";
import { find, reducedMotion, setText } from "./dom";
import { Drawing } from "./drawing";
import { Legend } from "./panels/legend";
import { showNoHand } from "./panels/no_hand";
import { Numbers } from "./panels/numbers";
import { Past } from "./panels/past";
import { Planes } from "./panels/planes";
import { RateWatch } from "./panels/rates";
import { Strips } from "./panels/strips";
import { Things } from "./panels/things";
import { VerdictSign } from "./panels/verdict_sign";
import { SideView } from "./scene/side_view";
import { View } from "./scene/view";
import "./inspection";
import type { Hello, PageMessage, State } from "./messages";
import "./styles/base.css";
import "./styles/controls.css";
import "./styles/stage.css";
import "./styles/panels.css";
import "./styles/layout.css"; // last: rules that depend on the page's width take precedence
import type { Frame } from "./wire";

const address = new Address();
const view = new View(find<HTMLCanvasElement>("view"));
const side = new SideView();
const planes = new Planes(address);
const legend = new Legend();
const verdict = new VerdictSign();
const strips = new Strips(address);
const past = new Past();
const numbers = new Numbers();
const things = new Things();
const rates = new RateWatch();
const help = new Help();
new Menu();
addTips();
const pointer = new Pointer(view, () => !drawing.flat);

// messages to the user, shown for a while where they are visible
const notice = find("notice");
let noticeTimer: number | undefined;
function say(sentence: string): void {
  notice.textContent = sentence;
  window.clearTimeout(noticeTimer);
  noticeTimer = window.setTimeout(() => (notice.textContent = ""), 8000);
}

const connection = new Connection(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`, {
  frame: takeFrame, hello: takeHello, state: takeState, link: takeLink,
  error: (sentence, control) => {
    if (!guide.showError(sentence) && !controls.showError(sentence, control)) say(sentence);
  },
});
const sendOther = (message: PageMessage): void => {
  controls.forget();
  connection.send(message);
};
const settings = new SettingsSender((id, value) => connection.send({ type: "set", id, value }));
const controls = new Controls((id, value) => settings.set(id, value), new Folds(address));
const turnDown = new TurnDown((id, value) => settings.set(id, value));
const share = new Share({ state: () => connection.state, set: (id, value) => settings.set(id, value), say }, address);
const transport = new Transport(sendOther);
const mute = new Mute(sendOther);
const guide = new CalibrationGuide(sendOther, (calibration) => view.array.setCalibration(calibration));
const pageHand = new PageHand(view, sendOther, say, () => (drawing.flat ? side.scale : null));
const looks = new Looks(address, (dark) => {
  view.setDark(dark);
  side.setDark(dark);
  planes.setDark(dark);
  strips.setDark(dark);
  drawing.again();
});
const picture = new PictureSettings(view, side, address, () => {
  drawing.begin();
  drawing.again();
});
const drawing = new Drawing(view, side, {
  panels, live, strips: (now, due) => strips.draw(now / 1000, due),
  mode: () => picture.mode, held: () => missed === "", rate: (hz) => connection.setRate(hz),
  side: (frame, now) => side.draw(frame, now, { smoke: view.showSmoke, plumb: pageHand.active }),
});
new Capture({
  get canvas() { return drawing.flat ? find<HTMLCanvasElement>("side") : view.canvas; },
  render: () => { if (!drawing.flat) view.renderWell(); },
  caption: () => caption(drawing.shown, connection.state, planes.scale.end, new Date()),
}, say);

const rewind = new Rewind(past, {
  show: (frame, time) => {
    drawing.showPast(frame);
    strips.rewind(frame === null ? null : time);
  },
});
find("save-csv").addEventListener("click", () => {
  offer(new Blob([strips.table()], { type: "text/csv" }), `prostm-${stamp()}.csv`);
});

let missed = ""; // why the run misses its rates
function takeFrame(frame: Frame): void {
  if (drawing.still) return;
  const now = performance.now() / 1000;
  drawing.show(frame);
  strips.add(frame, now);
  rates.add(frame, now);
  past.add(frame, now);
  verdict.add(frame, now);
  mute.frame(frame);
  if (connection.state === null) return;
  missed = rates.sentence(connection.state.rates, now, view.software && find("picture").dataset.drawn === "true");
}

function takeHello(hello: Hello): void {
  view.setHello(hello);
  side.setHello(hello);
  view.array.setDark(looks.dark);
  pageHand.setBox(hello);
  things.setHello(hello);
  const { length } = hello.array.transducers_mm;
  setText(find("about"), `prostm ${hello.prostm} · device ${hello.device}, ${length} transducers`);
}

function takeState(state: State): void {
  const page = connection.hello?.page ?? 0;
  controls.show(state.controls);
  transport.show(state, page);
  guide.show(state);
  pageHand.show(state.transport, page);
  // the address follows the program once the settings of the opened address are dealt with
  if (share.show(state)) address.set({ settings: changedSettings(state.controls) });
}

function takeLink(link: Link, sentence: string): void {
  document.documentElement.dataset.link = link;
  setText(find("link"), sentence);
  const lost = link !== "open";
  for (const part of document.querySelectorAll<HTMLFieldSetElement>("fieldset.program")) part.disabled = lost;
  if (!lost) return;
  settings.forget();
  rates.forget();
  missed = "";
  turnDown.show("", null);
  controls.lost();
  drawing.lost();
  verdict.lost();
  pageHand.lost();
}

/// Draws what is about the present, whatever moment is shown.
function live(frame: Frame, now: number): void {
  const { hello, state } = connection;
  verdict.show({ frame, state, sensation: hello?.sensation ?? null, ratesMissed: missed !== "" }, now);
  transport.frame(frame);
  turnDown.show(missed, missed === "" ? null : state!.rates.advice);
  rewind.update(now / 1000, pageHand.active);
}

/// Draws new data next to the picture.
function panels(frame: Frame, now: number): void {
  planes.draw(frame, now);
  view.maps.setMax(planes.scale.end);
  legend.show(picture.field, planes.scale.end, looks.dark);
  things.show(frame, { mode: drawing.flat ? "none" : picture.field, smoke: view.showSmoke, pageHand: pageHand.active });
  numbers.show(frame);
  showNoHand(frame, connection.state);
  address.set({ eye: view.eye.place });
  pointer.update(false);
}

view.canvas.addEventListener("keydown", (event) => {
  if (pageHand.key(event) || view.eye.key(event)) event.preventDefault();
});
listen({
  help: () => help.toggle(), mute: () => mute.toggle(), freeze: () => strips.toggle(), play: () => transport.toggle(),
  letGo: () => pageHand.release(),
});
document.addEventListener("visibilitychange", () => connection.sendRate());
reducedMotion.addEventListener("change", () => (view.eye.smooth = !reducedMotion.matches));
find("lock-scale").addEventListener("click", () => drawing.again());
find("draw-anyway").addEventListener("click", () => picture.setMode("on"));

// for screenshots: #still holds the page and draws every pixel
function holdStill(): void {
  const still = new URLSearchParams(location.hash.slice(1)).has("still");
  if (still === drawing.still) return;
  drawing.still = still;
  address.set({ still: still || undefined });
  view.setUnhurried(still);
  drawing.again();
}
window.addEventListener("hashchange", holdStill);

view.eye.smooth = !reducedMotion.matches;
looks.apply();
connection.open();

window.prostm = {
  get frame() { return connection.frame; },
  get state() { return connection.state; },
  get frames() { return connection.frames; },
  get refused() { return connection.refused; },
  get connections() { return connection.opened; },
  get pictures() { return drawing.pictures; },
  get sideViews() { return side.pictures; },
  get past() { return { frames: past.length, bytes: past.bytes }; },
  get speed() { return view.speed; },
  get dark() { return looks.dark; },
};
