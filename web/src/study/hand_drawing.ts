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

/// Edges of the picture [mm]: the same for all questions, with the widest jet whole.
export const kBox = { x: -115, y: -132, width: 230, height: 242 };
const kWidest = 110; // radius above which smoke comes from everywhere [mm]

/// @param jets x, y and radius of each [mm], with the fingers along +y.
export function drawHand(root: HTMLElement, jets: [number, number, number][]): void {
  const wanted = JSON.stringify(jets);
  if (root.dataset.jets === wanted) return;
  root.dataset.jets = wanted;
  const svg = shape("svg", { viewBox: `${kBox.x} ${kBox.y} ${kBox.width} ${kBox.height}`, role: "img", "aria-label": "A hand, and smoke on it" });
  const hand = shape("g", { class: "hand" });
  hand.append(shape("rect", { x: -38, y: -42, width: 76, height: 84, rx: 26 }));
  hand.append(shape("rect", { x: -26, y: 20, width: 52, height: 45 }));
  for (const [x1, y1, x2, y2, width] of kFingers)
    hand.append(shape("line", { x1, y1: -y1, x2, y2: -y2, "stroke-width": width, "stroke-linecap": "round" }));
  svg.append(hand);
  for (const [x, y, r] of jets) {
    if (r > kWidest) svg.append(shape("rect", { class: "smoke everywhere", ...kBox }));
    else svg.append(shape("circle", { class: "smoke", cx: x, cy: -y, r }));
  }
  root.replaceChildren(svg);
}
