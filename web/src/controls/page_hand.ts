/// The page's own hand: mouse, touch and keys in the picture move a hand above the array.

import { Vector3 } from "three";
import { find, setText } from "../dom";
import { entryOf, isCommand } from "../keyboard";
import type { Hello, HandPose, PageMessage, Transport } from "../messages";
import type { View } from "../scene/view";
import { pixelsOf, zoomOf } from "../scene/wheel";

const kEvery = 1000 / 60; // shortest interval between messages [ms]
const kAlive = 100; // longest interval between messages [ms]; the program releases the hand after 500
const kStopped = 10_000; // interval between messages [ms] above which the page or its machine was suspended

const kWhy = {
  hidden: "The hand was released because this page was hidden. Switch it on to take it again.",
  stopped: "The hand was released because this page was suspended. Switch it on to take it again.",
  late: "The hand was released because this page's messages came late. It comes back when they are steady.",
};

export class PageHand {
  active = false;
  readonly pose: HandPose = { palm_mm: [0, 0, 190], yaw_deg: 0, pitch_deg: 0, roll_deg: 0, closure: 0, side: "right" };
  private readonly toggleBox = find<HTMLInputElement>("page-hand");
  private readonly help = find("page-hand-help");
  private readonly why = find("page-hand-why");
  private low = [-150, -150, 40];
  private high = [150, 150, 320];
  private dragging: number | null = null;
  private at = { x: 0, y: 0 };
  private sent = 0;
  private alive = 0; // time of the last check [ms, wall clock, which runs on while the machine sleeps]
  private waiting = false;
  private held = false; // confirmed by the program

  constructor(
    private readonly view: View, private readonly send: (message: PageMessage) => void,
    private readonly say: (sentence: string) => void,
    /// pixels per metre of the side view while it is shown, else null
    private readonly sideScale: () => number | null,
  ) {
    const { canvas } = view;
    this.toggleBox.addEventListener("change", () => (this.toggleBox.checked ? this.take() : this.release()));
    canvas.addEventListener("pointerdown", (e) => {
      if (!this.active || e.button !== 0) return;
      // a second finger pinches, which moves the view
      this.dragging = this.dragging === null ? e.pointerId : null;
      this.at = { x: e.clientX, y: e.clientY };
    });
    canvas.addEventListener("pointermove", (e) => e.pointerId === this.dragging && this.drag(e));
    for (const end of ["pointerup", "pointercancel"] as const) {
      canvas.addEventListener(end, (e) => e.pointerId === this.dragging && (this.dragging = null));
    }
    canvas.addEventListener("wheel", (e) => {
      const flat = this.sideScale() !== null;
      if (flat && !this.active) return; // the page scrolls
      e.preventDefault();
      if (flat && e.ctrlKey) return;
      if (!this.active || e.ctrlKey) return view.eye.zoom(zoomOf(e, canvas.clientHeight));
      const up = Math.max(-8, Math.min(8, -pixelsOf(e, canvas.clientHeight) / 12)); // [mm]
      this.change((p) => (p.palm_mm[2] += up));
    }, { passive: false });
    window.setInterval(() => this.keepAlive(), kAlive / 2);
    // a hidden page releases its hand: browsers slow its timers down, and nobody can see what the hand does
    document.addEventListener("visibilitychange", () => document.hidden && this.hide());
    document.addEventListener("freeze", () => this.hide());
    window.addEventListener("pagehide", () => this.hide());
  }

  setBox(hello: Hello): void {
    const { origin, edge } = hello.box_mm;
    this.low = [origin[0] + 20, origin[1] + 20, Math.max(30, origin[2] + 30)];
    this.high = [origin[0] + edge - 20, origin[1] + edge - 20, origin[2] + edge - 20];
  }

  take(): void {
    this.toggleBox.checked = !document.hidden;
    setText(this.why, document.hidden ? kWhy.hidden : "");
    if (document.hidden) return;
    this.active = true;
    this.held = false;
    this.alive = Date.now();
    this.view.eye.primaryTaken = true;
    this.help.hidden = false;
    this.view.canvas.focus();
    this.change(() => undefined);
  }
  release(): void {
    if (!this.active) return;
    this.end();
    this.send({ type: "hand", release: true });
  }
  private hide(): void {
    if (!this.active) return;
    this.end(kWhy.hidden);
    this.send({ type: "hand", release: true, hidden: true });
  }

  /// Keeps the hand where it is, unless the page was suspended: its user may have left.
  private keepAlive(): void {
    if (!this.active) return;
    const stopped = Date.now() - this.alive > kStopped;
    this.alive = Date.now();
    if (stopped) {
      this.release();
      setText(this.why, kWhy.stopped);
    } else if (performance.now() - this.sent >= kAlive) {
      this.tell();
    }
  }

  /// Updates the hand from the program's report of who holds it. @param page the number of this page.
  show({ hand_page: holder, page_hand: state }: Transport, page: number): void {
    if (!this.active) return;
    if (holder === page) this.held = true;
    if (this.held) setText(this.why, state === "late" ? kWhy.late : "");
    if (this.held && holder !== null && holder !== page) {
      this.end();
      this.say("Another page has the hand; switch it on here to take it back.");
    }
  }
  /// The connection is lost, and the hand with it.
  lost(): void {
    if (this.active) this.end();
  }

  /// @param why shown if the user did not ask for the end.
  private end(why = ""): void {
    setText(this.why, why);
    this.active = this.held = false;
    this.view.eye.primaryTaken = false;
    this.toggleBox.checked = false;
    this.help.hidden = true;
    this.dragging = null;
    this.view.array.setPlumb(null);
  }

  /// @return whether the key moves the hand.
  key(event: KeyboardEvent): boolean {
    if (!this.active) return false;
    if (event.key === "Escape") {
      this.release();
      return true;
    }
    const step = event.shiftKey ? 1 : 5; // [mm], and [degrees]
    const change = entryOf<(p: HandPose) => void>(event, {
      ArrowLeft: (p) => (p.palm_mm[0] -= step), ArrowRight: (p) => (p.palm_mm[0] += step),
      ArrowDown: (p) => (p.palm_mm[1] -= step), ArrowUp: (p) => (p.palm_mm[1] += step),
      PageUp: (p) => (p.palm_mm[2] += step), PageDown: (p) => (p.palm_mm[2] -= step),
      q: (p) => (p.yaw_deg += step), e: (p) => (p.yaw_deg -= step),
      w: (p) => (p.pitch_deg += step), s: (p) => (p.pitch_deg -= step),
      a: (p) => (p.roll_deg -= step), d: (p) => (p.roll_deg += step),
      c: (p) => (p.closure += 0.02 * step), o: (p) => (p.closure -= 0.02 * step),
      l: (p) => (p.side = p.side === "left" ? "right" : "left"),
    });
    if (change === undefined || isCommand(event)) return false;
    this.change(change);
    return true;
  }

  /// Moves the hand sideways and away from the viewer, whatever the view; in the side view sideways and up.
  private drag(event: PointerEvent): void {
    const side = this.sideScale(), right_px = event.clientX - this.at.x, up_px = this.at.y - event.clientY;
    if (side !== null) {
      this.at = { x: event.clientX, y: event.clientY };
      return this.change((p) => {
        p.palm_mm[0] += (1000 * right_px) / side;
        p.palm_mm[2] += (1000 * up_px) / side;
      });
    }
    const camera = this.view.eye.camera;
    const palm = new Vector3(...this.pose.palm_mm).divideScalar(1000);
    const height = 2 * camera.position.distanceTo(palm) * Math.tan((camera.fov * Math.PI) / 360); // of the picture [m]
    const metres = height / (this.view.canvas.clientHeight || 1);
    const right = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0).setZ(0).normalize();
    const away = new Vector3(0, 0, 1).cross(right);
    const dx = right_px * metres * 1000, dy = up_px * metres * 1000;
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
