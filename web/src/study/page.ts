/// Shared by the two pages of a study: the connection to the program, the theme, and keys.

import { Connection } from "../connection";
import { find, setText } from "../dom";
import { entryOf, isCommand } from "../keyboard";
import { answerOf } from "./answer_keys";
import { Picture } from "./picture";
import { progress } from "./progress";
import type { Controls, Study, StudyAct } from "./messages";

export function minutes(seconds: number): string {
  return `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, "0")}`;
}

export class StudyPage<S extends Study> {
  study: S | null = null;
  readonly connection: Connection;
  readonly picture: Picture;

  /// @param path of the WebSocket. @param show called with each new state.
  /// @param opened called whenever the connection opens.
  constructor(path: string, private readonly room: S["room"], private readonly show: (study: S) => void, opened?: () => void) {
    const dark = window.matchMedia("(prefers-color-scheme: dark)");
    const theme = () => (document.documentElement.dataset.theme = dark.matches ? "dark" : "light");
    dark.addEventListener("change", theme);
    theme();
    const picture = this.picture = new Picture(find<HTMLCanvasElement>("view"));
    this.connection = new Connection(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}${path}`, {
      frame: (frame) => picture.show(frame),
      hello: (hello) => picture.setHello(hello),
      state: () => undefined,
      study: (study) => this.take(study),
      error: (sentence) => setText(find("error"), sentence),
      link: (link, sentence) => {
        document.documentElement.dataset.link = link;
        setText(find("link"), sentence);
        for (const part of document.querySelectorAll<HTMLFieldSetElement>("fieldset.program")) part.disabled = link !== "open";
        if (link === "open") opened?.();
      },
    });
    this.connection.open();
  }

  act(act: StudyAct): void {
    setText(find("error"), "");
    this.connection.send(act);
  }

  private take(study: Study): void {
    if (study.room !== this.room) return;
    this.study = study as S;
    document.documentElement.dataset.phase = study.phase;
    document.title = study.title || "A study";
    setText(find("title"), study.title || "A study");
    const bar = find<HTMLProgressElement>("progress");
    [bar.max, bar.value] = [study.trials, study.open && study.phase === "done" ? study.trials : study.done];
    setText(find("count"), progress(study));
    this.show(this.study);
  }
}

/// Buttons for the scenes of a training. They are kept while the scenes stay the same.
export function showScenes(root: HTMLElement, study: Study, explore: (scene: number) => void): void {
  if (root.childElementCount !== study.scenes.length) {
    root.replaceChildren(...study.scenes.map((scene, i) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = scene.replaceAll("-", " ");
      button.addEventListener("click", () => explore(i));
      return button;
    }));
  }
  [...root.children].forEach((button, i) => button.setAttribute("aria-pressed", String(i === study.explored)));
}

/// Shows the answer buttons: two are part of the page, and more are added for tasks with more answers.
function showAnswers(words: string[]): void {
  const [first, second] = words;
  setText(find("first-word"), first ?? "");
  setText(find("second-word"), second ?? "");
  const root = find("answers"), more = [...root.querySelectorAll<HTMLButtonElement>("button.more-answers")];
  for (let i = more.length; i < words.length - 2; ++i) {
    const button = document.createElement("button");
    [button.type, button.className] = ["button", "more-answers"];
    button.dataset.button = String(i + 2);
    root.append(button);
  }
  root.querySelectorAll<HTMLButtonElement>("button.more-answers").forEach((button, i) => {
    button.hidden = i + 2 >= words.length;
    setText(button, words[i + 2] ?? "");
  });
}

/// Shows the task's buttons and the current interval, the same on both pages.
export function showTask(study: Study, answers: boolean): void {
  const { form, words, intervals } = study.controls;
  const tuned = form === "tuned";
  find("answers").hidden = !answers || tuned;
  find("tuning").hidden = !answers || !tuned;
  if (!tuned) showAnswers(words);
  for (const button of document.querySelectorAll<HTMLButtonElement>("#first, #second, #accept, .more-answers")) button.disabled = !study.takes_answer;
  const silent = intervals > 1 && (tuned || !study.takes_answer) ? "…" : "";
  setText(find("interval"), study.phase !== "presenting" ? "" : study.interval > 0 ? `${study.interval}` : silent);
}

type Acting = Pick<StudyPage<Study>, "study" | "act">;

/// Ways to answer, by the index of a button from 0 at the left, and to tune.
export interface Answering {
  answer(button: number): void;
  tune(to: "less" | "more", coarse: boolean): void;
  accept(): void;
}

/// @param may whether the user of this page may answer now.
export function answering(page: Acting, may: () => boolean): Answering {
  const study = () => (page.study?.phase === "presenting" && may() ? page.study : null);
  const ways: Answering = {
    answer: (button) => {
      const now = study();
      if (now === null || !now.takes_answer || now.controls.form === "tuned") return;
      if (now.controls.form === "interval") page.act({ type: "study", do: "answer", interval: button + 1 });
      else page.act({ type: "study", do: "answer", yes: button === 0 });
    },
    tune: (to, coarse) => {
      if (study()?.controls.form === "tuned") page.act({ type: "study", do: "tune", to, coarse });
    },
    accept: () => {
      const now = study();
      if (now?.controls.form === "tuned" && now.takes_answer) page.act({ type: "study", do: "accept" });
    },
  };
  find("first").addEventListener("click", () => ways.answer(0));
  find("second").addEventListener("click", () => ways.answer(1));
  find("answers").addEventListener("click", (event) => {
    const more = (event.target as HTMLElement).closest<HTMLElement>(".more-answers");
    if (more !== null) ways.answer(Number(more.dataset.button));
  });
  addTuning(find("tuning"), ways);
  return ways;
}

/// Adds the buttons of an adjustment.
function addTuning(root: HTMLElement, ways: Answering): void {
  const add = (id: string, words: string, keys: string, act: () => void) => {
    const button = document.createElement("button");
    [button.id, button.type, button.textContent] = [id, "button", words];
    button.setAttribute("aria-keyshortcuts", keys);
    button.addEventListener("click", act);
    root.append(button);
    return button;
  };
  add("much-less", "Much less", "Shift+ArrowLeft", () => ways.tune("less", true));
  add("less", "Less", "ArrowLeft", () => ways.tune("less", false));
  add("more", "More", "ArrowRight", () => ways.tune("more", false));
  add("much-more", "Much more", "Shift+ArrowRight", () => ways.tune("more", true));
  const accept = add("accept", "They are alike", "Enter", () => {
    ways.accept();
    accept.blur();
  });
  accept.className = "strong";
}

/// @return whether the key answers or tunes. Only tuning repeats while a key is held.
function press(event: KeyboardEvent, controls: Controls, ways: Answering): boolean {
  const act = answerOf(event, controls);
  if (act?.do === "tune") ways.tune(act.to, act.coarse);
  if (act?.do === "answer" && !event.repeat) ways.answer(act.button);
  if (act?.do === "accept" && !event.repeat) ways.accept();
  return act !== null;
}

/// Handles keys that answer, tune or continue. Only tuning repeats while a key is held, and keys typed into a field are
/// ignored.
export function listen(page: Acting, ways: Answering, others: Record<string, () => void> = {}): void {
  document.addEventListener("keydown", (event) => {
    const element = event.target as HTMLElement;
    if (isCommand(event)) return;
    if (element.closest("input, select, textarea, dialog")) return;
    const onButton = element.closest("button") !== null && (event.key === "Enter" || event.key === " ");
    if (onButton) return;
    const study = page.study;
    const other = entryOf(event, others);
    if (study?.phase === "presenting" && press(event, study.controls, ways)) event.preventDefault();
    else if (other && !event.repeat) {
      other();
      event.preventDefault();
    }
  });
}
