/// The messages of a study, docs/reference/wire.md, as types, and the validation of those that arrive.

export const kPhases = [
  "consent", "about", "training", "ready", "settling", "presenting", "break", "paused", "done", "withdrawn",
] as const;
export type Phase = (typeof kPhases)[number];
export const kForms = ["yes-no", "interval", "tuned"] as const;
export type AnswerForm = (typeof kForms)[number];

/// How an answer is given, whatever the task: the pages derive their buttons and keys from it.
export interface Controls {
  form: AnswerForm;
  words: string[]; // on the buttons, from left to right; none when the level is tuned
  spoken: string; // sentence for participants who answer aloud
  intervals: number; // per trial
}

interface StudyBase {
  type: "study";
  title: string;
  phase: Phase;
  done: number; // answers so far
  trials: number; // total, or at most
  open: boolean; // whether the total may become smaller
  task: string; // name in the protocol
  controls: Controls;
  interval: number; // interval being presented, from 1; 0 between intervals and in a trial with one interval
  takes_answer: boolean;
  training_left_s: number;
  practice: number; // the current or next practice trial, from 1; 0 for none
  explored: number; // index of the training scene
  scenes: string[];
  answers: "experimenter" | "participant"; // who enters the answers
  hand: boolean; // in sight
  waits_for: string; // why the trial does not begin; "" when it can
}
/// The state of the participant's page, which reports it twice a second.
export interface PageReport {
  type: "page";
  visible: boolean;
  noise: "off" | "silent" | "playing";
  picture: boolean; // whether the simulation is drawn
}
export interface Experimenter extends StudyBase {
  room: "experimenter";
  participant: number;
  blind: boolean;
  output: boolean;
  question: string | null;
  condition: { method: string; scene: string; level?: number } | null;
  last: boolean | null; // the last answer: yes or no, or second or first interval
  needs: string; // what the participant's page lacks, and what to do; "" for nothing
  bound: string; // staircases at a limit of their range; "" for none
  strengths: string;
  practice_failed: string; // a practice that ended without its criterion; "" for none
  problem: string;
}
export interface Participant extends StudyBase {
  room: "participant";
  consent: string;
  noise: boolean; // whether noise plays in training and trials
  feedback: boolean | null;
  question: { text: string; jets_mm: [number, number, number][] } | null; // x, y, radius
}
export type Study = Experimenter | Participant;

export type StudyAct =
  | { type: "study"; do: "next" | "anyway" | "correct" | "pause" | "consent" | "withdraw" | "accept" | "end-training" | "practise" }
  | { type: "study"; do: "answer"; yes: boolean }
  | { type: "study"; do: "answer"; interval: number }
  | { type: "study"; do: "tune"; to: "less" | "more"; coarse: boolean }
  | { type: "study"; do: "explore"; scene: number }
  | { type: "study"; do: "about"; about: Record<string, string> };

const isText = (x: unknown): x is string => typeof x === "string";
const isList = (x: unknown, of: (v: unknown) => boolean): boolean => Array.isArray(x) && x.every(of);

function isControls(x: unknown): boolean {
  if (typeof x !== "object" || x === null) return false;
  const { form, words, spoken, intervals } = x as Record<string, unknown>;
  return kForms.includes(form as AnswerForm) && isList(words, isText) && isText(spoken) && Number.isFinite(intervals);
}

export function isStudy(x: Record<string, unknown>): boolean {
  const numbers = [x.done, x.trials, x.training_left_s, x.explored, x.interval, x.practice];
  const base = [x.title, x.waits_for].every(isText) && kPhases.includes(x.phase as Phase) && isText(x.task) && isControls(x.controls) &&
    typeof x.takes_answer === "boolean" && typeof x.open === "boolean" &&
    numbers.every((v) => Number.isFinite(v)) && isList(x.scenes, isText);
  if (!base) return false;
  if (x.room === "experimenter")
    return Number.isFinite(x.participant) && [x.problem, x.strengths, x.needs, x.bound, x.practice_failed].every(isText) && (x.question === null || isText(x.question));
  const asked = x.question as { text?: unknown; jets_mm?: unknown } | null;
  const isJet = (jet: unknown) => isList(jet, (v) => Number.isFinite(v)) && (jet as number[]).length === 3;
  return x.room === "participant" && isText(x.consent) && typeof x.noise === "boolean" && (asked === null || (isText(asked.text) && isList(asked.jets_mm, isJet)));
}
