/// Functions that make and find elements.

type Child = Node | string;
type Attributes = Record<string, string | number | boolean | undefined>;

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: Attributes = {}, ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...children);
  return element;
}

/// Returns an element of index.html.
export function find<T extends HTMLElement>(id: string): T {
  const element = document.getElementById(id);
  if (element === null) throw new Error(`the page has no element ${id}`);
  return element as T;
}

/// Sets a text. An unchanged text is left alone, so that screen readers do not repeat it.
export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

export const reducedMotion = window.matchMedia("(prefers-reduced-motion: reduce)");
