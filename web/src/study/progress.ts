import type { Study } from "./messages";

/// The session's progress in words. Training is not a trial.
export function progress(study: Pick<Study, "phase" | "done" | "trials" | "open">): string {
  if (study.phase === "consent" || study.phase === "about") return "";
  if (study.phase === "training") return "Training";
  const next = Math.min(study.done + 1, study.trials);
  if (study.phase === "done") return `All ${study.open ? study.done : study.trials} trials done`;
  return study.open ? `Trial ${next}` : `Trial ${next} of ${study.trials}`;
}
