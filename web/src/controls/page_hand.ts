/// The page's own hand: mouse, touch and keys over the picture move a hand above the array.

import { Vector3 } from "three";
import { find } from "../dom";
import type { Hello, HandPose, PageMessage } from "../messages";
import type { View } from "../scene/view";

const kEvery = 1000 / 60; // [ms] between messages at least
const kAlive = 200; // [ms] between messages at most; the program lets go after 500

export class PageHand {
  active = false;
  readonly pose: HandPose = { palm_mm: [0, 0, 190], yaw_deg: 0, pitch_deg: 0, roll_deg: 0, closure: 0, side: "right" };
  private readonly toggleBox = find<HTMLInputElement>("page-hand");
  private readonly help = find("page-hand-help");
  private low = [-150, -150, 40];
  private high = [150, 150, 320];
  private dragging: number | null = null;
  private at = { x: 0, y: 0 };
  private sent = 0;
  private waiting = false;
  private held = false; // the program has said so

  constructor(
    private readonly view: View, private readonly send: (message: PageMessage) => void,
    private readonly say: (sentence: string) => void,
  ) {
    const { canvas } = view;
    this.toggleBox.addEventListener("change", () => (this.toggleBox.checked ? this.take() : this.release()));
    canvas.addEventListener("pointerdown", (e) => {
      if (!this.active || e.button !== 0 || this.dragging !== null) return;
      this.dragging = e.pointerId;
      this.at = { x: e.clientX, y: e.clientY };
    });
    canvas.addEventListener("pointermove", (e) => e.pointerId === this.dragging && this.drag(e));
    for (const end of ["pointerup", "pointercancel"] as const) {
      canvas.addEventListener(end, (e) => e.pointerId === this.dragging && (this.dragging = null));
    }
    canvas.addEventListener("wheel", (e) => {
      e.preventDefault();
      const up = -Math.sign(e.deltaY) * Math.min(8, Math.abs(e.deltaY) / 12); // [mm]
      if (this.active) this.change((p) => (p.palm_mm[2] += up));
      else view.eye.zoom(Math.exp(Math.max(-60, Math.min(60, e.deltaY)) * 0.002));
    }, { passive: false });
    window.setInterval(() => this.active && performance.now() - this.sent >= kAlive && this.tell(), kAlive / 2);
  }

  setBox(hello: Hello): void {
    const { origin, edge } = hello.box_mm;
    this.low = [origin[0] + 20, origin[1] + 20, Math.max(30, origin[2] + 30)];
    this.high = [origin[0] + edge - 20, origin[1] + edge - 20, origin[2] + edge - 20];
  }

  take(): void {
    this.active = true;
    this.held = false;
    this.view.eye.primaryTaken = true;
    this.toggleBox.checked = true;
    this.help.hidden = false;
    this.view.canvas.focus();
    this.change(() => undefined);
  }
  release(): void {
    if (!this.active) return;
    this.end();
    this.send({ type: "hand", release: true });
  }

  /// Who holds the hand, as the program says, and which page this one is.
  show(holder: number | null, page: number): void {
    if (!this.active) return;
    if (holder === page) {
      this.held = true;
    } else if (this.held && holder !== null) {
      this.end();
      this.say("Another page has the hand; switch it on here to take it back.");
    }
  }
  /// The program is gone, and the hand with it.
  lost(): void {
    if (this.active) this.end();
  }

  private end(): void {
    this.active = this.held = false;
    this.view.eye.primaryTaken = false;
    this.toggleBox.checked = false;
    this.help.hidden = true;
    this.dragging = null;
    this.view.array.setPlumb(null);
  }

  /// @return whether the key is one of the hand's.
  key(event: KeyboardEvent): boolean {
    if (!this.active) return false;
    if (event.key === "Escape") {
      this.release();
      return true;
    }
    const step = event.shiftKey ? 1 : 5; // [mm], and [degrees]
    const keys: Record<string, (p: HandPose) => void> = {
      ArrowLeft: (p) => (p.palm_mm[0] -= step), ArrowRight: (p) => (p.palm_mm[0] += step),
      ArrowDown: (p) => (p.palm_mm[1] -= step), ArrowUp: (p) => (p.palm_mm[1] += step),
      PageUp: (p) => (p.palm_mm[2] += step), PageDown: (p) => (p.palm_mm[2] -= step),
      q: (p) => (p.yaw_deg += step), e: (p) => (p.yaw_deg -= step),
      w: (p) => (p.pitch_deg += step), s: (p) => (p.pitch_deg -= step),
      a: (p) => (p.roll_deg -= step), d: (p) => (p.roll_deg += step),
      c: (p) => (p.closure += 0.02 * step), o: (p) => (p.closure -= 0.02 * step),
      l: (p) => (p.side = p.side === "left" ? "right" : "left"),
    };
    const change = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (change === undefined || event.ctrlKey || event.altKey || event.metaKey) return false;
    this.change(change);
    return true;
  }

  /// Sideways and away from the eye, however it looks.
  private drag(event: PointerEvent): void {
    const camera = this.view.eye.camera;
    const palm = new Vector3(...this.pose.palm_mm).divideScalar(1000);
    const height = 2 * camera.position.distanceTo(palm) * Math.tan((camera.fov * Math.PI) / 360); // of the picture [m]
    const metres = height / (this.view.canvas.clientHeight || 1);
    const right = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0).setZ(0).normalize();
    const away = new Vector3(0, 0, 1).cross(right);
    const dx = (event.clientX - this.at.x) * metres * 1000, dy = (this.at.y - event.clientY) * metres * 1000;
    this.at = { x: event.clientX, y: event.clientY };
    this.change((p) => {
      p.palm_mm[0] += dx * right.x + dy * away.x;
      p.palm_mm[1] += dx * right.y + dy * away.y;
    });
  }

  private change(how: (pose: HandPose) => void): void {
    const { pose } = this;
    how(pose);
    const turn = (a: number) => Math.max(-180, Math.min(180, a));
    for (let i = 0; i < 3; ++i) pose.palm_mm[i] = Math.max(this.low[i]!, Math.min(this.high[i]!, pose.palm_mm[i]!));
    Object.assign(pose, {
      yaw_deg: turn(pose.yaw_deg), pitch_deg: turn(pose.pitch_deg), roll_deg: turn(pose.roll_deg),
      closure: Math.max(0, Math.min(1, pose.closure)),
    });
    this.view.array.setPlumb(new Vector3(...pose.palm_mm).divideScalar(1000));
    if (this.waiting) return;
    const later = this.sent + kEvery - performance.now();
    if (later <= 0) return this.tell();
    this.waiting = true;
    window.setTimeout(() => {
      this.waiting = false;
      if (this.active) this.tell();
    }, later);
  }
  private tell(): void {
    this.sent = performance.now();
    const rounded = (x: number) => Math.round(100 * x) / 100;
    const { pose } = this, [x, y, z] = pose.palm_mm;
    this.send({
      type: "hand", ...(this.held ? {} : { take: true as const }), palm_mm: [rounded(x), rounded(y), rounded(z)],
      yaw_deg: pose.yaw_deg, pitch_deg: pose.pitch_deg, roll_deg: pose.roll_deg,
      closure: rounded(pose.closure), side: pose.side,
    });
  }
}
