/// Lengths in the picture: a ruler of heights at the left, the width of the box, and the height of the palm.

import {
  BufferGeometry, Color, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments, Vector3, type Camera,
} from "three";
import type { Hello } from "../messages";
import type { Hand } from "../wire";
import type { Label } from "./label";

const kTick = 0.05, kNumber = 0.1; // spacing of ticks and of numbers [m]
const kTickLength = 0.008; // [m]
const kParts = [[0, 0.2], [0.1, 0.3], [0.2, 0.3]] as const; // heights to be visible, in order of preference [m]
const kBeside = 45; // space for the numbers next to the ruler [pixels]
const kUpAndDown = 0.86; // vertical share of the picture in which the ruler should lie
const kShares = Array.from({ length: 15 }, (_, i) => 1 - i / 20); // from the middle of the floor to a corner

/// The leftmost position in the picture, on the lines from the floor's middle to its corners, at which one of kParts is
/// visible, if possible the first. In a narrow picture a corner itself is often out of sight.
function leftmost(corners: Vector3[], middle: Vector3, camera: Camera, width: number): Vector3 {
  const room = 1 - (2 * kBeside) / width;
  const feet = corners.flatMap((corner) => kShares.map((share) => middle.clone().lerp(corner, share)));
  for (const part of kParts) {
    const seen = feet.map((foot) => ({ foot, ends: part.map((z) => foot.clone().setZ(z).project(camera)) }));
    const inside = seen.filter(({ ends }) => ends.every((p) => Math.abs(p.x) < room && Math.abs(p.y) < kUpAndDown));
    const left = ({ ends }: typeof seen[number]) => Math.min(...ends.map((p) => p.x));
    if (inside.length > 0) return inside.reduce((a, b) => (left(b) < left(a) ? b : a)).foot;
  }
  return corners[0]!; // the camera looks elsewhere
}

export class Ruler {
  readonly group = new Group();
  private readonly material = new LineBasicMaterial({ transparent: true, opacity: 0.9, depthWrite: false });
  private readonly accent = new LineBasicMaterial({ transparent: true, depthWrite: false });
  private readonly upright = new LineSegments(new BufferGeometry(), this.material);
  private readonly palm = new LineSegments(new BufferGeometry(), this.accent);
  private readonly low = new Vector3();
  private edge = 0; // [m]
  private palmHeight: number | null = null; // [m]

  constructor() {
    const line = [0, 0, 0, 0.02, 0, 0];
    this.palm.geometry.setAttribute("position", new Float32BufferAttribute(line, 3));
    this.group.add(this.upright, this.palm);
  }

  set(hello: Hello): void {
    this.placeBox(new Vector3(...hello.box_mm.origin).divideScalar(1000), hello.box_mm.edge / 1000);
  }

  /// Moves the box, which may follow a hand. @param corner its smallest coordinates [m].  @param edge its edge [m].
  placeBox(corner: Vector3, edge: number): void {
    if (this.low.equals(corner) && this.edge === edge) return;
    this.low.copy(corner);
    this.edge = edge;
    const top = corner.z + edge;
    const points = [0, 0, 0, 0, 0, top];
    for (let z = 0; z <= top + 1e-9; z += kTick) points.push(0, 0, z, -kTickLength, 0, z);
    const { geometry } = this.upright;
    geometry.setAttribute("position", new Float32BufferAttribute(points, 3));
    geometry.computeBoundingSphere(); // an earlier picture cached an empty sphere, which is never in sight
  }

  setHand(hand: Hand | undefined): void { this.palmHeight = hand === undefined ? null : hand.joints[2]!; }

  setDark(dark: boolean): void {
    this.material.color = new Color(dark ? "#9fb3d1" : "#4d5d78");
    this.accent.color = new Color(dark ? "#ffb454" : "#b84e00");
  }

  /// Puts the ruler at the left of the picture, on an edge of the box if there is room. @return its numbers.
  /// @param width the picture's width [pixels].
  update(camera: Camera, width: number): Label[] {
    if (this.edge === 0) return [];
    const { low, edge } = this;
    const middle = new Vector3(low.x + edge / 2, low.y + edge / 2, low.z);
    const corners = [0, 1, 2, 3].map((i) => new Vector3(low.x + (i & 1 ? edge : 0), low.y + (i & 2 ? edge : 0), low.z));
    const foot = leftmost(corners, middle, camera, width);
    this.group.position.set(foot.x, foot.y, 0);
    // ticks point away from the box
    this.group.rotation.z = Math.atan2(foot.y - middle.y, foot.x - middle.x) - Math.PI;
    const labels: Label[] = [];
    for (let z = 0; z <= low.z + edge + 1e-9; z += kNumber) {
      const last = z + kNumber > low.z + edge + 1e-9;
      const text = `${Math.round(1000 * z)}${last ? " mm" : ""}`;
      labels.push({ text, at: new Vector3(foot.x, foot.y, z), side: "left" });
    }
    this.palm.visible = this.palmHeight !== null;
    if (this.palmHeight !== null) {
      this.palm.position.z = this.palmHeight;
      const at = new Vector3(foot.x, foot.y, this.palmHeight);
      labels.push({ text: `palm ${Math.round(1000 * this.palmHeight)} mm`, at, side: "right", strong: true });
    }
    return [...labels, ...this.widths(camera)];
  }

  /// Labels of the two bottom edges nearest to the camera.
  private widths(camera: Camera): Label[] {
    const { low, edge } = this;
    const nearer = (a: Vector3, b: Vector3) => (a.distanceTo(camera.position) < b.distanceTo(camera.position) ? a : b);
    const along = (x: number, y: number) => new Vector3(low.x + x * edge, low.y + y * edge, low.z);
    const words = `${Math.round(1000 * edge)} mm`;
    return [
      { text: `x · ${words}`, at: nearer(along(0.5, 0), along(0.5, 1)), side: "middle" },
      { text: `y · ${words}`, at: nearer(along(0, 0.5), along(1, 0.5)), side: "middle" },
    ];
  }
}
