/// Explanations. A button next to a name opens one: with a tap, a click, Enter, or the mouse over it. Esc, the next tap
/// elsewhere, and the end of the focus close it. The text is a live region, so that screen readers read it.

import { find, make, setText } from "../dom";

const kGap = 6; // between the button and the text, and at the window's edges [pixels]

const note = find("tip");
let opener: HTMLButtonElement | null = null;
let pinned = false; // opened on purpose, so that it stays when the mouse leaves

/// Puts the text below its button, or above it if there is no room, within the window.
function place(): void {
  if (opener === null) return;
  const button = opener.getBoundingClientRect(), { width, height } = note.getBoundingClientRect();
  const below = button.bottom + kGap, above = button.top - kGap - height;
  const left = Math.min(button.left, window.innerWidth - width - kGap);
  note.style.setProperty("left", `${Math.max(kGap, left)}px`);
  note.style.setProperty("top", `${below + height + kGap > window.innerHeight && above > 0 ? above : below}px`);
}

function close(): void {
  opener?.setAttribute("aria-expanded", "false");
  opener?.removeAttribute("aria-describedby");
  opener = null;
  pinned = false;
  note.hidden = true;
  note.textContent = "";
}

function open(button: HTMLButtonElement, text: string): void {
  if (opener !== button) close();
  opener = button;
  note.hidden = false;
  setText(note, text);
  button.setAttribute("aria-expanded", "true");
  button.setAttribute("aria-describedby", note.id);
  place();
}

/// Makes the button that opens an explanation. @param name what is explained. @param text the explanation.
export function tip(name: string, text: string): HTMLButtonElement {
  const button = make("button", {
    class: "tip", "aria-label": `About ${name}`, "aria-expanded": "false", "aria-controls": note.id, type: "button",
  }, make("span", { "aria-hidden": "true" }, "?"));
  button.addEventListener("click", () => {
    if (opener === button && pinned) return close();
    open(button, text);
    pinned = true;
  });
  button.addEventListener("pointerenter", (e) => e.pointerType === "mouse" && opener !== button && open(button, text));
  button.addEventListener("pointerleave", (e) => e.pointerType === "mouse" && opener === button && !pinned && close());
  button.addEventListener("blur", () => opener === button && close());
  return button;
}

/// Adds the buttons of the explanations in index.html: to the elements with data-tip, named by their data-about.
export function addTips(): void {
  for (const element of document.querySelectorAll<HTMLElement>("[data-tip]")) {
    element.append(" ", tip(element.dataset.about ?? "", element.dataset.tip ?? ""));
  }
}

document.addEventListener("pointerdown", ({ target }) => {
  if (opener !== null && target instanceof Node && !opener.contains(target) && !note.contains(target)) close();
}, { capture: true });
// before the page's own keys: Esc closes the text only
document.addEventListener("keydown", (event) => {
  if (opener === null || event.key !== "Escape") return;
  event.preventDefault();
  event.stopPropagation();
  close();
}, { capture: true });
document.addEventListener("scroll", place, { capture: true, passive: true });
window.addEventListener("resize", place);
