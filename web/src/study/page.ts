/// The two pages of a study have these in common: the link to the program, the theme, and keys.

import { Connection } from "../connection";
import { find, setText } from "../dom";
import { Picture } from "./picture";
import type { Study, StudyAct } from "./messages";

/// How far the session is, in words.
export function progress(study: Study): string {
  const next = Math.min(study.done + 1, study.trials);
  return study.phase === "done" ? `All ${study.trials} trials done` : `Trial ${next} of ${study.trials}`;
}

export function minutes(seconds: number): string {
  return `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, "0")}`;
}

export class StudyPage<S extends Study> {
  study: S | null = null;
  readonly connection: Connection;

  /// @param path of the WebSocket. @param show a new state.
  constructor(path: string, private readonly room: S["room"], private readonly show: (study: S) => void) {
    const dark = window.matchMedia("(prefers-color-scheme: dark)");
    const theme = () => (document.documentElement.dataset.theme = dark.matches ? "dark" : "light");
    dark.addEventListener("change", theme);
    theme();
    const picture = new Picture(find<HTMLCanvasElement>("view"));
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
    [bar.max, bar.value] = [study.trials, study.done];
    setText(find("count"), progress(study));
    this.show(this.study);
  }
}

/// Buttons that stand for a scene of training. The same ones stay while the scenes do.
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

/// Keys of answers: letters, arrows, and those that foot switches and remote controls send.
const kYes = ["y", "Y", "ArrowRight", "PageDown"], kNo = ["n", "N", "ArrowLeft", "PageUp"];

/// Listens for keys that answer or go on. A key that is held down counts once, and what is typed into a field not at all.
export function listen(answer: (yes: boolean) => void, others: Record<string, () => void> = {}): void {
  document.addEventListener("keydown", (event) => {
    const element = event.target as HTMLElement;
    if (event.repeat || event.ctrlKey || event.altKey || event.metaKey) return;
    if (element.closest("input, select, textarea, dialog")) return;
    const onButton = element.closest("button") !== null && (event.key === "Enter" || event.key === " ");
    if (onButton) return;
    const other = others[event.key];
    if (kYes.includes(event.key) || kNo.includes(event.key)) answer(kYes.includes(event.key));
    else if (other) other();
    else return;
    event.preventDefault();
  });
}
