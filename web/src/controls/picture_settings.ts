/// The settings of the picture, which affect this page only.

import { kPictures, type Address, type PictureMode } from "../address";
import { find, make, reducedMotion } from "../dom";
import { kViews } from "../scene/camera";
import { kFieldModes, type FieldMode } from "../scene/field_maps";
import type { SideView } from "../scene/side_view";
import type { View } from "../scene/view";

const kSlowest = [1, 2, 5, 10, 20, 50, 100];
const kFieldNames: Record<FieldMode, string> = {
  target: "Target", rendered: "Reconstruction", difference: "Difference", none: "None",
};
const kThrough = 0.62; // opacity of a hand with "See through the hand"

export class PictureSettings {
  field: FieldMode = "rendered";
  mode: PictureMode;
  private readonly slow = find<HTMLInputElement>("slow-motion");
  private readonly picture = find<HTMLSelectElement>("picture-mode");

  /// @param changed called when the picture has to be drawn differently.
  constructor(
    private readonly view: View, private readonly side: SideView, private readonly address: Address,
    private readonly changed: () => void,
  ) {
    const { skin } = address.state;
    if (kFieldModes.some((m) => m === skin)) this.field = skin as FieldMode;
    this.mode = address.state.picture ?? "auto";
    this.addFields();
    this.addViews();
    this.picture.value = this.mode;
    const chosen = () => kPictures.find((m) => m === this.picture.value) ?? "auto";
    this.picture.addEventListener("change", () => this.setMode(chosen()));
    this.slow.value = reducedMotion.matches ? String(kSlowest.length - 1) : "5";
    this.slow.addEventListener("input", () => this.setSlowMotion());
    this.setSlowMotion();
    const through = find<HTMLInputElement>("see-through");
    const setThrough = () => view.hands.setOpacity(through.checked ? kThrough : 1);
    through.addEventListener("change", setThrough);
    setThrough();
    const smoke = find<HTMLInputElement>("show-smoke");
    smoke.addEventListener("change", () => {
      view.showSmoke = smoke.checked;
      side.again();
    });
    view.setField(this.field);
    view.eye.place = address.state.eye;
  }

  setMode(mode: PictureMode): void {
    this.mode = this.picture.value = mode;
    if (mode !== "off") this.view.pace.begin();
    this.address.set({ picture: mode === "auto" ? undefined : mode });
    this.changed();
  }

  private addFields(): void {
    for (const mode of [...kFieldModes.slice(1), kFieldModes[0]] as FieldMode[]) {
      const checked = mode === this.field;
      const radio = make("input", { type: "radio", name: "skin-field", id: `skin-${mode}`, value: mode, checked });
      radio.addEventListener("change", () => {
        if (!radio.checked) return;
        this.field = mode;
        this.view.setField(mode);
        this.address.set({ skin: mode === "rendered" ? undefined : mode });
        this.changed();
      });
      find("skin-field").append(radio, make("label", { for: `skin-${mode}` }, kFieldNames[mode]));
    }
  }

  private addViews(): void {
    for (const { id, label } of kViews) {
      const button = make("button", { type: "button", "data-view": id }, label);
      button.addEventListener("click", () => this.view.eye.go(id));
      find("views").append(button);
    }
  }

  private setSlowMotion(): void {
    const factor = kSlowest[Number(this.slow.value)] ?? 50;
    this.view.paths.slowdown = this.side.slowdown = factor;
    find("slow-motion-value").textContent = factor === 1 ? "1/1" : `1/${factor}`;
    this.slow.setAttribute("aria-valuetext", factor === 1 ? "as played" : `1/${factor} of the speed`);
    this.slow.style.setProperty("--share", `${(100 * Number(this.slow.value)) / (kSlowest.length - 1)}%`);
  }
}
