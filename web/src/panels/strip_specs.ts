/// The contents of each strip.

import { numberOf, type Frame, type NumberName } from "../wire";

export type Colour = [light: string, dark: string];

export interface Series {
  label: string;
  value: (frame: Frame) => number;
  /// the value is a counter since the start of the run; its rate is shown
  counts?: boolean;
  colour: Colour;
  digits?: number;
  dash?: number[];
}
export interface StripSpec {
  id: string;
  title: string;
  unit: string;
  better?: "higher" | "lower";
  stacked?: boolean;
  atLeast: number; // lower limit of the axis's top
  atMost?: number; // upper limit of the axis's top
  bottom?: number; // of the axis; default 0
  series: Series[];
}

const of = (name: NumberName) => (frame: Frame) => numberOf(frame, name);
const kBlue: Colour = ["#0072b2", "#56b4e9"], kOrange: Colour = ["#b84e00", "#ff9a4d"];
const kGreen: Colour = ["#007a58", "#2fd0a5"], kViolet: Colour = ["#a3427f", "#e39ac6"];
const kYellow: Colour = ["#9a7000", "#f0c54a"], kGrey: Colour = ["#5c6675", "#a9b4c4"];

export const kStrips: StripSpec[] = [
  {
    id: "stages", title: "Stages", unit: "ms", better: "lower", stacked: true, atLeast: 10, series: [
      { label: "fluid", value: of("world_ms"), colour: kBlue },
      { label: "plan", value: of("plan_ms"), colour: kOrange },
      { label: "hand", value: of("hand_ms"), colour: kGreen },
      { label: "contact", value: of("contact_ms"), colour: kViolet },
      { label: "track", value: of("track_ms"), colour: kYellow },
      { label: "lift", value: of("lift_ms"), colour: kGrey },
    ],
  },
  {
    id: "rates", title: "Rates", unit: "Hz", better: "higher", atLeast: 30, series: [
      { label: "smoke", value: of("world_hz"), colour: kBlue, digits: 1 },
      { label: "plans", value: of("plan_hz"), colour: kOrange, digits: 1 },
    ],
  },
  {
    id: "latency", title: "Latency", unit: "ms", better: "lower", atLeast: 10, series: [
      { label: "last", value: of("latency_ms"), colour: kBlue },
      { label: "p50", value: of("latency_p50_ms"), colour: kGreen, dash: [6, 4] },
      { label: "p99", value: of("latency_p99_ms"), colour: kOrange, dash: [6, 4] },
    ],
  },
  {
    id: "blocks", title: "Blocks", unit: "", atLeast: 5, series: [
      { label: "late/s", value: of("late_blocks"), counts: true, colour: kYellow, digits: 0 },
      { label: "missed/s", value: of("missed_blocks"), counts: true, colour: kOrange, digits: 0 },
      { label: "queue", value: of("queue_blocks"), colour: kGrey, digits: 0 },
    ],
  },
  {
    id: "force", title: "Force on the hands", unit: "mN", atLeast: 0.5, series: [
      { label: "target", value: of("force_mn"), colour: kBlue },
      { label: "smoke", value: of("smoke_mn"), colour: kGreen, dash: [6, 4] },
      { label: "movement", value: of("movement_mn"), colour: kOrange, dash: [6, 4] },
    ],
  },
  {
    id: "quality", title: "Quality", unit: "", better: "higher", atLeast: 1, atMost: 1, series: [
      { label: "shape by Eq. (1)", value: of("skill_0"), colour: kBlue, digits: 2 },
      { label: "felt shape", value: of("felt_skill"), colour: kViolet, digits: 2 },
    ],
  },
  {
    id: "strength", title: "Felt strength", unit: "dB above the threshold of touch", better: "higher",
    atLeast: 10, bottom: -30, series: [
      { label: "strongest place", value: of("sensation_level"), colour: kBlue, digits: 0 },
    ],
  },
  {
    id: "error", title: "RMSE", unit: "of the largest target", better: "lower", atLeast: 0.1, series: [
      { label: "RMSE", value: of("rmse"), colour: kOrange, digits: 3 },
    ],
  },
];
