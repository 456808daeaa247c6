/// The guided calibration of the tracker's pose: touch the marks on the array, solve, check the residual, save.

import { find, make } from "../dom";
import type { Calibration, PageMessage, State } from "../messages";
import { short } from "../text";

export class CalibrationGuide {
  private readonly dialog = find<HTMLDialogElement>("calibration");
  private readonly button = find<HTMLButtonElement>("calibrate");
  private readonly steps = find("calibration-marks");
  private readonly sentence = find("calibration-sentence");
  private readonly error = find("calibration-error");
  private readonly solve = find<HTMLButtonElement>("calibration-solve");
  private readonly save = find<HTMLButtonElement>("calibration-save");
  private readonly cancel = find<HTMLButtonElement>("calibration-cancel");
  private told = ""; // the calibration shown, as received

  constructor(private readonly send: (message: PageMessage) => void, private readonly shown: (calibration: Calibration | null) => void) {
    this.button.addEventListener("click", () => send({ type: "calibration", do: "begin" }));
    this.solve.addEventListener("click", () => this.tell({ type: "calibration", do: "solve" }));
    this.save.addEventListener("click", () => this.tell({ type: "calibration", do: "save" }));
    this.cancel.addEventListener("click", () => this.tell({ type: "calibration", do: "cancel" }));
    this.dialog.addEventListener("keydown", (e) => e.key === "Escape" && this.tell({ type: "calibration", do: "cancel" }));
  }
  private tell(message: PageMessage): void {
    this.error.textContent = "";
    this.send(message);
  }

  show(state: State): void {
    const { calibration } = state;
    // only live trackers have a pose to calibrate
    this.button.hidden = state.tracker === null && calibration === null;
    this.button.disabled = calibration !== null;
    // states arrive all the time: without news the elements stay, so that a button can be pressed
    const told = JSON.stringify(calibration);
    if (told === this.told) return;
    this.told = told;
    this.shown(calibration);
    if (calibration === null) {
      if (this.dialog.open) {
        this.dialog.close();
        this.button.focus();
      }
      return;
    }
    const rows = calibration.marks.map((mark, i) => {
      const take = make("button", { type: "button", "data-mark": i }, mark.taken ? "Again" : "Take");
      take.addEventListener("click", () => this.tell({ type: "calibration", do: "take", mark: i }));
      const [x, y] = mark.p_mm;
      const result = mark.taken ? `spread ${mark.spread_mm === null ? "–" : short(mark.spread_mm)} mm` : "not yet";
      return make("li", { class: mark.taken ? "taken" : "" }, make("span", {}, make("b", {}, mark.name), make("small", {}, `${short(x)}, ${short(y)} mm · ${result}`)), take);
    });
    const focused = document.activeElement instanceof HTMLElement ? document.activeElement.dataset.mark : undefined;
    this.steps.replaceChildren(...rows);
    this.sentence.textContent = calibration.sentence;
    find("calibration-muted").textContent = calibration.muted ? "The array is muted for the calibration." : "";
    const found = calibration.residual_mm !== null;
    find("calibration-residual").textContent = found ? `Residual ${short(calibration.residual_mm ?? NaN)} mm` : "";
    this.save.disabled = !found;
    find("calibration-saved").textContent = calibration.saved ? `Saved${calibration.file ? ` to ${calibration.file}` : ""}.` : "";
    this.cancel.textContent = calibration.saved ? "Close" : "Cancel";
    if (!this.dialog.open) {
      this.error.textContent = "";
      this.dialog.show();
    }
    if (focused !== undefined) this.steps.querySelector<HTMLElement>(`[data-mark="${focused}"]`)?.focus();
  }

  /// @return whether the guide is open and shows the error.
  showError(sentence: string): boolean {
    if (!this.dialog.open) return false;
    this.error.textContent = sentence;
    return true;
  }
}
