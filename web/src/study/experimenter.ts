/// The experimenter's page: the state of the session, what to read aloud, and the keys for the next step.

import { find, setText } from "../dom";
import { answering, listen, minutes, showScenes, showTask, StudyPage } from "./page";
import type { Experimenter, Phase } from "./messages";
import "../styles/base.css";
import "../styles/study.css";

const kTitles: Record<Phase, string> = {
  consent: "The participant reads and agrees",
  about: "The participant says a few things",
  training: "Training",
  ready: "Ready for the trials",
  settling: "The trial is prepared",
  presenting: "The participant feels the stimulus",
  break: "Break",
  paused: "Paused",
  done: "All answers are recorded",
  withdrawn: "The participant has left",
};
const kNext: Partial<Record<Phase, string>> = {
  training: "End the training…", ready: "Begin the trials", break: "Go on", paused: "Go on", done: "Close", withdrawn: "Close",
};

const kAnswers = [["yes", "no"], ["the second", "the first"]];

const ending = find<HTMLDialogElement>("ending");
const page = new StudyPage<Experimenter>("/live", "experimenter", (study) => {
  const { phase } = study;
  setText(find("participant"), `Participant ${study.participant}`);
  find("blind").hidden = !study.blind;
  const practises = phase === "ready" && study.practice > 0;
  setText(find("phase"), practises ? "Ready for the practice" : kTitles[phase]);
  setText(find("question"), study.question ?? "");
  find("asked").hidden = study.question === null;
  const c = study.condition;
  setText(find("condition"), c === null ? "" : `${c.scene} with ${c.method}${c.level === undefined ? "" : ` at ${c.level}`}`);
  setText(find("left"), phase === "training" ? `${minutes(study.training_left_s)} left` : "");
  setText(find("waits"), phase === "settling" ? study.waits_for || (study.needs === "" ? "The smoke develops." : "") : !study.hand ? "No hand in sight." : "");
  setText(find("output"), study.output ? "The array is on" : "The array is silent");
  find("output").dataset.on = String(study.output);
  setText(find("needs"), study.needs);
  setText(find("bound"), study.bound);
  setText(find("problem"), study.problem);
  setText(find("strengths"), study.strengths);
  const next = kNext[phase];
  find("next").hidden = next === undefined;
  setText(find("next-word"), practises ? "Begin the practice" : next ?? "");
  if (phase !== "training") ending.close();
  setText(find("ending-words"), `${minutes(study.training_left_s)} of the training is left.`);
  find("practise").hidden = phase !== "ready" || study.practice_failed === "";
  setText(find("practice-failed"), study.practice_failed);
  showTask(study, phase === "presenting");
  const forced = study.controls.form === "interval";
  setText(find("first-key"), forced ? "1" : "Y");
  setText(find("second-key"), forced ? "2" : "N");
  setText(find("answers-by"), phase === "presenting" && study.answers === "participant" ? "The participant answers; use these buttons only if they cannot." : "");
  find("anyway").hidden = phase !== "settling" || (study.waits_for === "" && study.needs === "");
  find("pause").hidden = phase !== "settling" && phase !== "presenting";
  find("correct").hidden = study.last === null || study.controls.words.length !== 2 || phase === "presenting" || phase === "withdrawn";
  setText(find("last"), study.last === null ? "" : `The last answer was ${kAnswers[forced ? 1 : 0]![study.last ? 0 : 1]}: change it`);
  find("withdraw").hidden = phase === "done" || phase === "withdrawn";
  find("scenes").hidden = phase !== "training";
  showScenes(find("scenes"), study, (scene) => page.act({ type: "study", do: "explore", scene }));
});

const next = () => {
  if (page.study === null || kNext[page.study.phase] === undefined) return;
  if (page.study.phase === "training") ending.showModal(); // a stray key must not end it
  else page.act({ type: "study", do: "next" });
};
const pause = () => page.act({ type: "study", do: "pause" });
find("next").addEventListener("click", next);
find("anyway").addEventListener("click", () => page.act({ type: "study", do: "anyway" }));
find("pause").addEventListener("click", pause);
find("correct").addEventListener("click", () => {
  page.act({ type: "study", do: "correct" });
  find("correct").blur(); // Enter is for the next step, not for changing the answer back
});
const leave = find<HTMLDialogElement>("leave");
find("withdraw").addEventListener("click", () => leave.showModal());
find("stay").addEventListener("click", () => leave.close());
find("go").addEventListener("click", () => {
  leave.close();
  page.act({ type: "study", do: "withdraw" });
});
find("train-on").addEventListener("click", () => {
  ending.close();
  find("train-on").blur(); // the closed dialog's button keeps the focus until the next frame, and would take a key
});
find("end-training").addEventListener("click", () => {
  ending.close();
  page.act({ type: "study", do: "end-training" });
});
find("practise").addEventListener("click", () => page.act({ type: "study", do: "practise" }));
listen(page, answering(page, () => true), { Enter: next, " ": next, p: pause });
