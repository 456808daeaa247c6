/// The camera. It orbits a point, controlled by mouse, touch and keyboard; z is up.

import { MathUtils, PerspectiveCamera, Vector3 } from "three";
import { entryOf } from "../keyboard";

export interface Place {
  azimuth: number; // [rad]; at 0 the camera looks along +y
  elevation: number; // [rad]
  distance: number; // [m]
  target: Vector3;
}
const degrees = Math.PI / 180;

interface NamedView {
  id: string;
  label: string;
  azimuth: number; // [degrees]
  elevation: number;
  distance: number; // [m]
  z: number; // height of the point it looks at [m]
}
const kHome: NamedView = { id: "home", label: "Oblique", azimuth: -32, elevation: 38, distance: 0.7, z: 0.125 };
export const kViews: NamedView[] = [
  kHome,
  { id: "front", label: "Front", azimuth: 0, elevation: 3, distance: 0.78, z: 0.165 },
  { id: "side", label: "Side", azimuth: 90, elevation: 3, distance: 0.78, z: 0.165 },
  { id: "above", label: "Above", azimuth: 0, elevation: 86, distance: 0.72, z: 0.16 },
  { id: "below", label: "Palm", azimuth: -18, elevation: -34, distance: 0.46, z: 0.2 },
];

export class OrbitCamera {
  readonly camera = new PerspectiveCamera(34, 1, 0.02, 6);
  private wanted: Place;
  private now: Place;
  /// whether the camera glides to a new view
  smooth = true;
  /// when true, the primary button and single touches belong to the page's hand
  primaryTaken = false;
  /// when true, the view is not shown, and stays
  idle = false;
  private readonly pointers = new Map<number, { x: number; y: number; button: number }>();

  constructor(private readonly element: HTMLElement) {
    this.camera.up.set(0, 0, 1);
    this.wanted = this.placeOf("home");
    this.now = this.placeOf("home");
    element.addEventListener("pointerdown", (e) => this.down(e));
    element.addEventListener("pointermove", (e) => this.move(e));
    for (const end of ["pointerup", "pointercancel"] as const) {
      element.addEventListener(end, (e) => this.pointers.delete(e.pointerId));
    }
    element.addEventListener("contextmenu", (e) => e.preventDefault());
  }

  private placeOf(id: string): Place {
    const { azimuth, elevation, distance, z } = kViews.find((v) => v.id === id) ?? kHome;
    return { azimuth: azimuth * degrees, elevation: elevation * degrees, distance, target: new Vector3(0, 0, z) };
  }
  go(view: string): void { this.wanted = this.placeOf(view); }

  /// The view it moves to: azimuth, elevation [degrees], distance and target x, y, z [mm]; undefined for the home view.
  get place(): number[] | undefined {
    const numbers = ({ azimuth, elevation, distance, target }: Place) =>
      [azimuth / degrees, elevation / degrees, 1000 * distance, ...target.toArray().map((v) => 1000 * v)];
    const here = numbers(this.wanted), home = numbers(this.placeOf("home"));
    return here.some((v, i) => Math.abs(v - home[i]!) > 0.05) ? here : undefined;
  }
  set place(numbers: number[] | undefined) {
    this.wanted = this.placeOf("home");
    const [azimuth, elevation, distance, x, y, z] = numbers ?? [];
    if (azimuth === undefined || elevation === undefined || distance === undefined) return;
    this.wanted.azimuth = azimuth * degrees;
    this.wanted.elevation = 0;
    this.turn(0, elevation * degrees);
    this.wanted.distance = distance / 1000;
    this.zoom(1);
    this.wanted.target.set((x ?? 0) / 1000, (y ?? 0) / 1000, (z ?? 0) / 1000).clampScalar(-0.5, 0.8);
  }

  turn(azimuth: number, elevation: number): void {
    this.wanted.azimuth += azimuth;
    this.wanted.elevation = MathUtils.clamp(this.wanted.elevation + elevation, -89 * degrees, 89 * degrees);
  }
  zoom(factor: number): void { this.wanted.distance = MathUtils.clamp(this.wanted.distance * factor, 0.15, 2.5); }
  /// Shifts the view by fractions of the picture's height.
  pan(right: number, up: number): void {
    const scale = 2 * this.wanted.distance * Math.tan((this.camera.fov * degrees) / 2);
    const axis = (column: number) => new Vector3().setFromMatrixColumn(this.camera.matrixWorld, column);
    this.wanted.target.addScaledVector(axis(0), right * scale).addScaledVector(axis(1), up * scale);
    this.wanted.target.clampScalar(-0.5, 0.8);
  }

  private down(event: PointerEvent): void {
    this.element.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY, button: event.button });
  }
  private move(event: PointerEvent): void {
    const pointer = this.pointers.get(event.pointerId);
    if (pointer === undefined || this.idle) return;
    const dx = event.clientX - pointer.x, dy = event.clientY - pointer.y;
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, p]) => p);
    const height = this.element.clientHeight || 1;
    if (others.length > 0) {
      // two fingers: zoom by their distance, shift by their common motion
      const other = others[0]!;
      const before = Math.hypot(pointer.x - other.x, pointer.y - other.y);
      const after = Math.hypot(event.clientX - other.x, event.clientY - other.y);
      this.zoom(before / Math.max(1, after));
      this.pan(-dx / (2 * height), dy / (2 * height));
    } else if (this.primaryTaken && pointer.button === 0) {
      // the page's hand is being moved
    } else if ((pointer.button === 2 && !this.primaryTaken) || event.shiftKey) {
      this.pan(-dx / height, dy / height);
    } else {
      this.turn((-dx / height) * 3, (dy / height) * 3);
    }
    pointer.x = event.clientX;
    pointer.y = event.clientY;
  }

  /// @return whether the key moves the camera.
  key(event: KeyboardEvent): boolean {
    if (this.idle) return false;
    const step = event.shiftKey ? 0.04 : 0.1;
    const nearer = () => this.zoom(0.9), home = () => this.go("home");
    const act = entryOf(event, {
      ArrowLeft: () => this.turn(-step, 0), ArrowRight: () => this.turn(step, 0),
      ArrowUp: () => this.turn(0, step), ArrowDown: () => this.turn(0, -step),
      "+": nearer, "=": nearer, "-": () => this.zoom(1 / 0.9), Home: home, "0": home,
    });
    act?.();
    return act !== undefined;
  }

  /// Advances the motion by dt [s]. @return whether the camera moved.
  update(dt: number, aspect: number): boolean {
    const share = this.smooth ? 1 - Math.exp(-dt / 0.07) : 1;
    const go = (from: number, to: number) => from + share * (to - from);
    const moved = Math.abs(this.now.azimuth - this.wanted.azimuth) + Math.abs(this.now.elevation - this.wanted.elevation) +
      Math.abs(this.now.distance - this.wanted.distance) + this.now.target.distanceTo(this.wanted.target) > 1e-5;
    this.now.azimuth = go(this.now.azimuth, this.wanted.azimuth);
    this.now.elevation = go(this.now.elevation, this.wanted.elevation);
    this.now.distance = go(this.now.distance, this.wanted.distance);
    this.now.target.lerp(this.wanted.target, share);
    const { azimuth, elevation, distance, target } = this.now;
    // a narrow picture is seen from further away, so that the box fits
    const far = distance * Math.max(1, 0.95 / aspect);
    this.camera.position.set(
      target.x + far * Math.cos(elevation) * Math.sin(azimuth),
      target.y - far * Math.cos(elevation) * Math.cos(azimuth),
      target.z + far * Math.sin(elevation),
    );
    this.camera.aspect = aspect;
    this.camera.lookAt(target);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    return moved;
  }
}
