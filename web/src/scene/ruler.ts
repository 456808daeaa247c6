/// Lengths in the picture: heights above the array along an edge of the box, the box's width, and how high the palm is.

import {
  BufferGeometry, Color, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments, Vector3, type Camera,
} from "three";
import type { Hello } from "../messages";
import type { Hand } from "../wire";
import type { Label } from "./labels";

const kTick = 0.05, kNumber = 0.1; // between ticks, and between numbers [m]
const kTickLength = 0.008; // [m]
const kSeen = 0.2; // height up to which the ruler is to be in the picture [m]
const kRoom = 0.86; // share of the picture's half in which there is room for numbers

/// The corner whose upright edge is leftmost in the picture, of those whose lower part is in it.
function leftmost(corners: Vector3[], camera: Camera): Vector3 {
  const seen = corners.map((corner) => {
    const ends = [0, kSeen].map((z) => corner.clone().setZ(corner.z + z).project(camera));
    const x = Math.min(...ends.map((p) => p.x));
    const inside = ends.every((p) => Math.abs(p.x) < kRoom && Math.abs(p.y) < kRoom);
    return { corner, x, inside };
  });
  const inside = seen.filter((s) => s.inside);
  // where none is, the one that is least far outside
  if (inside.length === 0) return seen.reduce((a, b) => (Math.abs(b.x) < Math.abs(a.x) ? b : a)).corner;
  return inside.reduce((a, b) => (b.x < a.x ? b : a)).corner;
}

export class Ruler {
  readonly group = new Group();
  private readonly material = new LineBasicMaterial({ transparent: true, opacity: 0.9, depthWrite: false });
  private readonly accent = new LineBasicMaterial({ transparent: true, depthWrite: false });
  private readonly upright = new LineSegments(new BufferGeometry(), this.material);
  private readonly palm = new LineSegments(new BufferGeometry(), this.accent);
  private low = new Vector3();
  private edge = 0; // [m]
  private palmHeight: number | null = null; // [m]

  constructor() {
    const line = [0, 0, 0, 0.02, 0, 0];
    this.palm.geometry.setAttribute("position", new Float32BufferAttribute(line, 3));
    this.group.add(this.upright, this.palm);
  }

  set(hello: Hello): void {
    this.low = new Vector3(...hello.box_mm.origin).divideScalar(1000);
    this.edge = hello.box_mm.edge / 1000;
    const top = this.low.z + this.edge;
    const points = [0, 0, 0, 0, 0, top];
    for (let z = 0; z <= top + 1e-9; z += kTick) points.push(0, 0, z, -kTickLength, 0, z);
    this.upright.geometry.setAttribute("position", new Float32BufferAttribute(points, 3));
  }

  setHand(hand: Hand | undefined): void { this.palmHeight = hand === undefined ? null : hand.joints[2]!; }

  setDark(dark: boolean): void {
    this.material.color = new Color(dark ? "#9fb3d1" : "#4d5d78");
    this.accent.color = new Color(dark ? "#ffb454" : "#b84e00");
  }

  /// Puts the ruler on that edge of the box which is leftmost in the picture. @return the numbers on it.
  update(camera: Camera): Label[] {
    if (this.edge === 0) return [];
    const { low, edge } = this;
    const middle = low.clone().addScalar(edge / 2);
    const corners = [0, 1, 2, 3].map((i) => new Vector3(low.x + (i & 1 ? edge : 0), low.y + (i & 2 ? edge : 0), low.z));
    const corner = leftmost(corners, camera);
    this.group.position.set(corner.x, corner.y, 0);
    // ticks point away from the box
    this.group.rotation.z = Math.atan2(corner.y - middle.y, corner.x - middle.x) - Math.PI;
    const labels: Label[] = [];
    for (let z = 0; z <= low.z + edge + 1e-9; z += kNumber) {
      const last = z + kNumber > low.z + edge + 1e-9;
      const text = `${Math.round(1000 * z)}${last ? " mm" : ""}`;
      labels.push({ text, at: new Vector3(corner.x, corner.y, z), side: "left" });
    }
    this.palm.visible = this.palmHeight !== null;
    if (this.palmHeight !== null) {
      this.palm.position.z = this.palmHeight;
      const at = new Vector3(corner.x, corner.y, this.palmHeight);
      labels.push({ text: `palm ${Math.round(1000 * this.palmHeight)} mm`, at, side: "right", strong: true });
    }
    return [...labels, ...this.widths(camera)];
  }

  /// Names of the two edges at the bottom that are nearest to the eye.
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
