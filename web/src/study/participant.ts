/// The participant's page. It shows only what the protocol allows.

import { find, setText } from "../dom";
import { drawHand } from "./hand_drawing";
import { Noise } from "./noise";
import { answering, listen, minutes, showScenes, showTask, StudyPage } from "./page";
import type { Participant, Phase } from "./messages";
import "../styles/base.css";
import "../styles/study.css";

const kWords: Record<Phase, string> = {
  consent: "", about: "A few things about you",
  training: "Hold your hand flat above the device, palm down, and feel the smoke.",
  ready: "Rest your hand. The study continues in a moment.",
  settling: "Hold your hand flat above the device, palm down, and wait.",
  presenting: "", break: "A break. Rest your hand.", paused: "A pause. Rest your hand.",
  done: "That was all. Thank you!", withdrawn: "You have left the study. Thank you for your time.",
};

const kReports = 500; // interval between reports of this page's state [ms]

const noise = new Noise(() => {
  find("noise").hidden = !page.study?.noise || noise.state !== "off";
  report();
});
const page = new StudyPage<Participant>("/guest/live", "participant", (study) => {
  const { phase, question } = study;
  setText(find("words"), kWords[phase]);
  setText(find("waits"), phase === "settling" ? study.waits_for : "");
  find("consent").hidden = phase !== "consent";
  setText(find("consent-text"), study.consent);
  find("about").hidden = phase !== "about";
  find("training").hidden = phase !== "training";
  setText(find("left"), minutes(study.training_left_s));
  showScenes(find("scenes"), study, (scene) => page.act({ type: "study", do: "explore", scene }));
  find("asked").hidden = question === null;
  if (question !== null) {
    setText(find("question"), question.text);
    drawHand(find("drawing"), question.jets_mm);
  }
  find("drawing").hidden = question === null || question.jets_mm.length === 0;
  showTask(study, phase === "presenting" && study.answers === "participant");
  setText(find("spoken"), phase === "presenting" && study.answers === "experimenter" ? study.controls.spoken : "");
  const told = study.feedback === null || phase === "presenting" ? "" : study.feedback ? "That was right." : "That was wrong.";
  setText(find("feedback"), told);
  noise.play(study.noise && (phase === "training" || phase === "settling" || phase === "presenting"));
  find("noise").hidden = !study.noise || noise.state !== "off";
}, () => report());

/// The program holds trials until this page meets their requirements.
function report(): void {
  page.connection.send({ type: "page", visible: !document.hidden, noise: noise.state, picture: page.picture.draws });
}
window.setInterval(report, kReports);
document.addEventListener("visibilitychange", report);

find("agree").addEventListener("click", () => page.act({ type: "study", do: "consent" }));
find("refuse").addEventListener("click", () => page.act({ type: "study", do: "withdraw" }));
find("noise").addEventListener("click", () => void noise.begin());
find<HTMLFormElement>("about-form").addEventListener("submit", (event) => {
  event.preventDefault();
  const fields = new FormData(event.target as HTMLFormElement);
  const about: Record<string, string> = {};
  for (const [name, value] of fields) if (typeof value === "string" && value !== "") about[name] = value;
  page.act({ type: "study", do: "about", about });
});
listen(page, answering(page, () => page.study?.answers === "participant"));
