/// The static image of a question: a flat hand seen from above, and where smoke would hit it.

const kSvg = "http://www.w3.org/2000/svg";
/// Fingers of a right hand, palm down: base, tip and width [mm from the middle of the palm].
const kFingers: [number, number, number, number, number][] = [
  [-30, -10, -68, 22, 20], [-27, 30, -38, 98, 17], [-9, 36, -12, 112, 18], [9, 35, 13, 103, 17], [27, 28, 36, 80, 15],
];

function shape(name: string, attributes: Record<string, string | number>): SVGElement {
  const element = document.createElementNS(kSvg, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  return element;
}

/// @param jets x, y and radius of each [mm], with the fingers along +y.
export function drawHand(root: HTMLElement, jets: [number, number, number][]): void {
  const wanted = JSON.stringify(jets);
  if (root.dataset.jets === wanted) return;
  root.dataset.jets = wanted;
  const svg = shape("svg", { viewBox: "-90 -125 180 190", role: "img", "aria-label": "A hand, and smoke on it" });
  const hand = shape("g", { class: "hand" });
  hand.append(shape("rect", { x: -38, y: -42, width: 76, height: 84, rx: 26 }));
  hand.append(shape("rect", { x: -26, y: 20, width: 52, height: 45 }));
  for (const [x1, y1, x2, y2, width] of kFingers)
    hand.append(shape("line", { x1, y1: -y1, x2, y2: -y2, "stroke-width": width, "stroke-linecap": "round" }));
  svg.append(hand);
  for (const [x, y, r] of jets) svg.append(shape("circle", { class: "smoke", cx: x, cy: -y, r }));
  root.replaceChildren(svg);
}
