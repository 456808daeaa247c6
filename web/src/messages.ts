/// The text messages of docs/reference/wire.md as types, and the validation of those that arrive.

import { isStudy, type PageReport, type Study, type StudyAct } from "./study/messages";

export interface Hello {
  type: "hello";
  version: number;
  page: number; // the number of this page, for hand_page
  prostm: string;
  device: string;
  numbers: string[];
  array: { name: string; transducers_mm: [number, number, number][] };
  box_mm: { origin: [number, number, number]; edge: number };
  sensation: { below_db: number; above_db: number; sound: string }; // interval of sensation levels
}

interface ControlBase {
  id: string;
  group: string;
  label: string;
  help: string;
  unit?: string;
  enabled: boolean;
}
export interface ChoiceControl extends ControlBase {
  kind: "choice";
  value: string;
  default: string; // at the run's start
  choices: { value: string; label: string }[];
}
export interface NumberControl extends ControlBase {
  kind: "number";
  value: number;
  default: number;
  min: number;
  max: number;
  step: number;
}
export interface SwitchControl extends ControlBase {
  kind: "switch";
  value: boolean;
  default: boolean;
}
export type Value = string | number | boolean;
export type Control = ChoiceControl | NumberControl | SwitchControl;

export interface Transport {
  playing: boolean;
  recording: null | { length_s: number; seekable: boolean };
  source: string;
  base: string;
  hand_page: number | null; // the page whose hand is used
  page_hand: "free" | "held" | "late" | "hidden";
}
/// The program's advice where the rates are missed; it knows the effect on rates and stimulus.
export interface Advice {
  sentence: string;
  set: null | { id: string; value: Value; label: string }; // a control, its new value, and the button's label
}
/// The rates set for the run.
export interface Rates {
  world_hz: number;
  plan_hz: number;
  advice: Advice | null;
}
export interface Tracker {
  connected: boolean;
  sentence: string;
  frames: number;
  dropped: number;
  repeated: number;
  dropped_hands: number;
  unsure: number;
  frozen: number;
}
export interface Mark {
  name: string;
  p_mm: [number, number, number];
  taken: boolean;
  spread_mm: number | null;
}
export interface Calibration {
  marks: Mark[];
  residual_mm: number | null;
  file: string | null;
  saved: boolean;
  sentence: string;
  muted: boolean;
}
export interface State {
  type: "state";
  controls: Control[];
  transport: Transport;
  rates: Rates;
  settings: string; // settings that differ from their defaults, as TOML
  tracker: Tracker | null;
  calibration: Calibration | null;
}
export interface ErrorMessage {
  type: "error";
  id?: string; // the control that could not be set
  sentence: string;
}
export type ServerMessage = Hello | State | Study | ErrorMessage;

export interface HandPose {
  palm_mm: [number, number, number];
  yaw_deg: number;
  pitch_deg: number;
  roll_deg: number;
  closure: number;
  side: "left" | "right";
}
export type PageMessage =
  | { type: "set"; id: string; value: Value }
  | { type: "transport"; do: "play" | "pause" | "step" }
  | { type: "transport"; do: "seek"; time_s: number }
  | ({ type: "hand"; take?: true } & HandPose)
  | { type: "mute"; on: boolean }
  | { type: "hand"; release: true; hidden?: true }
  | { type: "calibration"; do: "begin" | "solve" | "save" | "cancel" }
  | { type: "calibration"; do: "take"; mark: number }
  | { type: "rate"; hz: number }
  | PageReport
  | StudyAct;

type Json = Record<string, unknown>;
const isObject = (x: unknown): x is Json => typeof x === "object" && x !== null && !Array.isArray(x);
const isPoint = (x: unknown): boolean => Array.isArray(x) && x.length === 3 && x.every((v) => Number.isFinite(v));
const isText = (x: unknown): x is string => typeof x === "string";

function isControl(x: unknown): boolean {
  if (!isObject(x) || ![x.id, x.group, x.label].every(isText) || typeof x.enabled !== "boolean") return false;
  if (x.kind === "choice") {
    const isChoice = (c: unknown) => isObject(c) && isText(c.value) && isText(c.label);
    return isText(x.value) && isText(x.default) && Array.isArray(x.choices) && x.choices.every(isChoice);
  }
  if (x.kind === "number") return [x.value, x.default, x.min, x.max, x.step].every((v) => Number.isFinite(v));
  return x.kind === "switch" && typeof x.value === "boolean" && typeof x.default === "boolean";
}

function isTransport(x: unknown): boolean {
  if (!isObject(x) || typeof x.playing !== "boolean" || !isText(x.source) || !isText(x.base)) return false;
  if (!isText(x.page_hand) || (x.hand_page !== null && !Number.isFinite(x.hand_page))) return false;
  return x.recording === null || (isObject(x.recording) && Number.isFinite(x.recording.length_s));
}

function isAdvice(x: unknown): boolean {
  if (!isObject(x) || !isText(x.sentence)) return false;
  return x.set === null || (isObject(x.set) && isText(x.set.id) && isText(x.set.label));
}

function isRates(x: unknown): boolean {
  if (!isObject(x) || ![x.world_hz, x.plan_hz].every((v) => typeof v === "number" && v > 0)) return false;
  x.advice ??= null;
  return x.advice === null || isAdvice(x.advice);
}

function isSensation(x: unknown): boolean {
  return isObject(x) && Number.isFinite(x.below_db) && Number.isFinite(x.above_db) && isText(x.sound);
}

function isCalibration(x: unknown): boolean {
  if (!isObject(x) || !Array.isArray(x.marks)) return false;
  return x.marks.every((m) => isObject(m) && isText(m.name) && isPoint(m.p_mm));
}

/// @return the message, or null if it is unknown or malformed.
export function parseMessage(text: string): ServerMessage | null {
  let message: unknown;
  try {
    message = JSON.parse(text);
  } catch {
    return null;
  }
  if (!isObject(message)) return null;
  let known = false;
  if (message.type === "hello") {
    const { array, box_mm: box } = message;
    known = isText(message.device) && Number.isFinite(message.page) &&
      Array.isArray(message.numbers) && message.numbers.every(isText) && isObject(array) && isText(array.name) &&
      Array.isArray(array.transducers_mm) && array.transducers_mm.every(isPoint) &&
      isObject(box) && isPoint(box.origin) && Number.isFinite(box.edge) && isSensation(message.sensation);
  } else if (message.type === "state") {
    message.tracker ??= null;
    message.calibration ??= null;
    known = Array.isArray(message.controls) && message.controls.every(isControl) && isTransport(message.transport) &&
      isRates(message.rates) && isText(message.settings) &&
      (message.calibration === null || isCalibration(message.calibration)) &&
      (message.tracker === null || isObject(message.tracker));
  } else if (message.type === "study") {
    known = isStudy(message);
  } else if (message.type === "error") {
    known = isText(message.sentence) && (message.id === undefined || isText(message.id));
  }
  return known ? (message as unknown as ServerMessage) : null;
}
