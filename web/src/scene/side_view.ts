/// The side view: array, smoke, hand and focal points from the front, on a canvas without WebGL. x is to the right, z up.

import { css, pathColour } from "../colours";
import { find } from "../dom";
import type { Hello } from "../messages";
import type { Frame, Hand, Path } from "../wire";
import { kFingers, kThumb, kWrist } from "./hand_bones";
import { densityAlongY, sideLayout, type SideBox, type SideLayout } from "./side_layout";

const kEvery = 500; // between two pictures [ms]
const kRoom = 60; // for the numbers of the ruler [pixels]
const kTick = 0.1; // spacing of the ruler's numbers [m]
const kOpaque = 4; // opacity of smoke of full density along the whole box, before it is cut at 1
const kSmoke = { light: [92, 116, 160], dark: [150, 176, 216] } as const;

/// The joints of the hand, in chains along its bones.
const kChains = [
  [kWrist, kThumb, 3, 4, 5],
  ...kFingers.map((first) => [kWrist, first, first + 1, first + 2, first + 3, first + 4]),
  kFingers.map((first) => first + 1), // the knuckles
];

export class SideView {
  pictures = 0;
  /// focal points run at 1/slowdown of their speed
  slowdown = 50;
  private readonly canvas = find<HTMLCanvasElement>("side");
  private readonly image = document.createElement("canvas");
  private box: SideBox = { x: -0.18, z: 0, edge: 0.36 };
  private array: { low: number; high: number } | null = null; // its ends along x [m]
  private smokeSequence = -1;
  private dark = false;
  private drawn = -Infinity; // [ms]

  setHello(hello: Hello): void {
    const [x, , z] = hello.box_mm.origin;
    this.box = { x: x / 1000, z: z / 1000, edge: hello.box_mm.edge / 1000 };
    const across = hello.array.transducers_mm.map(([at]) => at / 1000);
    this.array = across.length === 0 ? null : { low: Math.min(...across) - 0.005, high: Math.max(...across) + 0.005 };
  }
  setDark(dark: boolean): void {
    this.dark = dark;
    this.smokeSequence = -1;
    this.again();
  }
  /// Draws the next frame at once.
  again(): void { this.drawn = -Infinity; }

  /// Pixels of the page per metre.
  get scale(): number { return this.layout.pixels; }
  private get layout(): SideLayout {
    return sideLayout(this.box, this.canvas.clientWidth, this.canvas.clientHeight, kRoom);
  }

  /// Draws a frame, at most twice a second. @param now [ms]. @return whether it was drawn.
  draw(frame: Frame, now: number, shown: { smoke: boolean; plumb: boolean }): boolean {
    if (now - this.drawn < kEvery) return false;
    const { canvas } = this, context = canvas.getContext("2d");
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (context === null || width === 0 || height === 0) return false;
    this.drawn = now;
    ++this.pictures;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    if (frame.smoke !== null) {
      this.box = { x: frame.smoke.corner[0], z: frame.smoke.corner[2], edge: frame.smoke.edge };
    }
    const place = this.layout;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
    context.lineCap = context.lineJoin = "round";
    if (shown.smoke) this.drawSmoke(context, place, frame);
    this.drawGround(context, place);
    for (const hand of frame.hands) this.drawHand(context, place, hand);
    frame.plan.forEach((path, i) => this.drawPath(context, place, path, i, now));
    this.drawRuler(context, place, frame.hands[0], shown.plumb);
    return true;
  }

  private colour(name: string): string {
    return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  }

  private drawSmoke(context: CanvasRenderingContext2D, { pixels, x, y }: SideLayout, frame: Frame): void {
    const { smoke } = frame;
    if (smoke === null) return;
    if (this.smokeSequence !== frame.smokeSequence) {
      this.smokeSequence = frame.smokeSequence;
      const { n } = smoke, mean = densityAlongY(smoke);
      [this.image.width, this.image.height] = [n, n];
      const made = new ImageData(n, n), [r, g, b] = kSmoke[this.dark ? "dark" : "light"];
      for (let row = 0; row < n; ++row) for (let column = 0; column < n; ++column) {
        const alpha = Math.min(1, kOpaque * mean[(n - 1 - row) * n + column]!);
        made.data.set([r, g, b, Math.round(255 * alpha)], 4 * (row * n + column));
      }
      this.image.getContext("2d")?.putImageData(made, 0, 0);
    }
    const edge = smoke.edge * pixels;
    context.imageSmoothingEnabled = true;
    context.drawImage(this.image, x(smoke.corner[0]), y(smoke.corner[2] + smoke.edge), edge, edge);
  }

  private drawGround(context: CanvasRenderingContext2D, { pixels, x, y }: SideLayout): void {
    const { box, array } = this;
    context.strokeStyle = this.colour("--line");
    context.lineWidth = 1;
    context.strokeRect(x(box.x), y(box.z + box.edge), box.edge * pixels, box.edge * pixels);
    if (array === null) return;
    context.fillStyle = this.colour("--edge");
    context.fillRect(x(array.low), y(0), (array.high - array.low) * pixels, Math.max(4, 0.01 * pixels));
  }

  private drawHand(context: CanvasRenderingContext2D, { pixels, x, y }: SideLayout, hand: Hand): void {
    const at = (joint: number, k: number) => hand.joints[8 * joint + k]!;
    const bones = kChains.flatMap((chain) => chain.slice(1).map((joint, i) => [chain[i]!, joint] as const));
    // an outline first, so that the hand stands out from the smoke
    for (const [colour, wider] of [[this.colour("--ink"), 2], [this.dark ? "#c98f70" : "#e3b094", 0]] as const) {
      context.strokeStyle = colour;
      for (const [from, to] of bones) {
        context.lineWidth = (at(from, 7) + at(to, 7)) * pixels + wider;
        context.beginPath();
        context.moveTo(x(at(from, 0)), y(at(from, 2)));
        context.lineTo(x(at(to, 0)), y(at(to, 2)));
        context.stroke();
      }
    }
  }

  private drawPath(context: CanvasRenderingContext2D, { x, y }: SideLayout, path: Path, i: number, now: number): void {
    const point = (n: number) => [x(path.points[6 * n + 3]!), y(path.points[6 * n + 5]!)] as const;
    if (path.count > 1) {
      context.beginPath();
      for (let n = 0; n < path.count; ++n) context.lineTo(...point(n));
      context.closePath();
      for (const [colour, width] of [["#ffffff", 4], [css(pathColour(i)), 2]] as const) {
        context.strokeStyle = colour;
        context.lineWidth = width;
        context.stroke();
      }
    }
    const period = path.period > 0 ? path.period : 0.02;
    const lap = path.kind === "path" ? (now / 1000 / (period * this.slowdown)) % 1 : 0;
    context.beginPath();
    context.arc(...point(Math.floor(lap * path.count)), 5, 0, 2 * Math.PI);
    context.fillStyle = "#ffffff";
    context.fill();
    context.strokeStyle = css(pathColour(i));
    context.lineWidth = 3;
    context.stroke();
  }

  /// Heights over the array, the height of the palm, and a line from the page's hand down to the array.
  private drawRuler(context: CanvasRenderingContext2D, { x, y }: SideLayout, hand: Hand | undefined, plumb: boolean): void {
    const { box } = this, left = x(box.x), top = box.z + box.edge;
    context.font = "12px system-ui, sans-serif";
    context.textBaseline = "middle";
    context.textAlign = "right";
    context.fillStyle = this.colour("--ink");
    context.strokeStyle = this.colour("--edge");
    context.lineWidth = 1;
    for (let z = 0; z <= top + 1e-9; z += kTick) {
      const last = z + kTick > top + 1e-9;
      context.fillText(`${Math.round(1000 * z)}${last ? " mm" : ""}`, left - 8, y(z));
      context.beginPath();
      context.moveTo(left - 5, y(z));
      context.lineTo(left, y(z));
      context.stroke();
    }
    if (hand === undefined) return;
    const [palm, height] = [hand.joints[0]!, hand.joints[2]!];
    context.strokeStyle = context.fillStyle = this.colour("--focus");
    context.textAlign = "left";
    context.fillText(`palm ${Math.round(1000 * height)} mm`, left + 6, y(height) - 10);
    context.beginPath();
    context.moveTo(left, y(height));
    context.lineTo(left + 12, y(height));
    if (plumb) {
      context.moveTo(x(palm), y(height));
      context.lineTo(x(palm), y(0));
    }
    context.stroke();
  }
}
