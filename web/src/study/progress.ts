import type { Study } from "./messages";

/// The session's progress in words. Training and practice are not trials.
export function progress(study: Pick<Study, "phase" | "done" | "trials" | "open" | "practice">): string {
  if (study.phase === "consent" || study.phase === "about") return "";
  if (study.phase === "training") return "Training";
  if (study.practice > 0) return `Practice ${study.practice}`;
  const next = Math.min(study.done + 1, study.trials);
  if (study.phase === "done") return `All ${study.open ? study.done : study.trials} trials done`;
  return study.open ? `Trial ${next}` : `Trial ${next} of ${study.trials}`;
}
