/// Shares the page's state as a link, a command line or a settings file, and resets it to the run's start.

import { askedSettings, inWords, type Address, type Asked } from "../address";
import { find, make } from "../dom";
import type { State, Value } from "../messages";
import { commandLine } from "./command_line";

export interface ShareActions {
  state(): State | null;
  set(id: string, value: Value): void;
  say(sentence: string): void;
}

/// "Paths 2, Speed 4 m/s"
function listed(asked: Asked[]): string {
  const words = ({ control: c, value }: Asked) => {
    if (c.kind === "choice") return `${c.label} ${c.choices.find((x) => x.value === value)?.label ?? String(value)}`;
    if (c.kind === "switch") return `${c.label} ${value ? "on" : "off"}`;
    return `${c.label} ${inWords(value)}${c.unit ? ` ${c.unit}` : ""}`;
  };
  return asked.map(words).join(", ");
}

export class Share {
  private readonly bar = find("asked");
  private waits: Record<string, string>; // settings of the address, until the user applies or ignores them

  constructor(private readonly act: ShareActions, private readonly address: Address) {
    this.waits = { ...address.state.settings };
    const copy = (id: string, text: () => string, done: string) =>
      find(id).addEventListener("click", () => void this.copy(text(), done));
    copy("copy-link", () => {
      address.write();
      return location.href;
    }, "The link is copied. It holds the settings, the view and the looks of this page.");
    find("copy-command").addEventListener("click", () => {
      const state = act.state();
      if (state === null) return;
      const { command, note } = commandLine(state);
      void this.copy(command, `Copied: ${command}${note ? `  (${note})` : ""}`);
    });
    find("copy-settings").addEventListener("click", () => {
      const text = act.state()?.settings ?? "";
      if (text === "") act.say("Every setting has its default, so there is nothing to put into a settings file.");
      else void this.copy(text, "The settings file is copied: save it as prostm.toml, for --settings prostm.toml.");
    });
    find("reset").addEventListener("click", () => {
      const changed = (act.state()?.controls ?? []).filter((c) => inWords(c.value) !== inWords(c.default));
      for (const c of changed) act.set(c.id, c.default);
      act.say(`All settings are ${changed.length > 0 ? "reset" : "already equal"} to the run's start.`);
    });
  }

  /// Shows the program's state. Asks once about the settings of a link and applies them only after a click: a link may
  /// come from anyone. @return whether nothing is being asked.
  show(state: State): boolean {
    const asked = askedSettings(state.controls, this.waits);
    if (asked.length === 0) {
      this.bar.hidden = true;
      this.waits = {};
      return true;
    }
    if (!this.bar.hidden) return false;
    const end = () => {
      this.waits = {};
      this.bar.hidden = true;
    };
    const apply = make("button", { type: "button", class: "strong", id: "asked-apply" }, "Apply");
    const leave = make("button", { type: "button", id: "asked-ignore" }, "Ignore");
    apply.addEventListener("click", () => {
      for (const { control, value } of asked) this.act.set(control.id, value);
      end();
    });
    leave.addEventListener("click", () => {
      end();
      this.address.set({ settings: {} });
    });
    this.bar.replaceChildren(make("span", {}, `This link asks for: ${listed(asked)}.`), apply, leave);
    this.bar.hidden = false;
    return false;
  }

  private async copy(text: string, done: string): Promise<void> {
    try {
      await navigator.clipboard.writeText(text);
      this.act.say(done);
    } catch {
      // only pages of this machine may write to the clipboard
      this.act.say(`This browser does not let the page copy. Copy it from here: ${text}`);
    }
  }
}
