/// A tracking service like Leap's for a program under test: a right hand whose index fingertip rests where a test puts it.

import { once } from "node:events";
import type { AddressInfo } from "node:net";
import { Matrix4, Quaternion, Vector3 } from "three";
import { WebSocketServer } from "ws";
import { skeleton } from "../support/skeleton";

const kIndexTip = 10;
const kThumbMetacarpal = 2, kIndexMetacarpal = 6;
export const kFlesh = 0.8 * 0.0085; // radius of the fingertip, as the program derives it from the finger's width [m]

export class FakeTracker {
  /// Position of the fingertip in the tracker's frame [m].
  readonly tip = new Vector3(0, 0.2, 0);
  private noise = 2e-5; // of each coordinate [m]
  private readonly timer: NodeJS.Timeout;
  private readonly begun = performance.now();

  static async start(): Promise<FakeTracker> {
    const server = new WebSocketServer({ host: "127.0.0.1", port: 0, path: "/v6.json" });
    await once(server, "listening");
    return new FakeTracker(server);
  }
  private constructor(private readonly server: WebSocketServer) {
    this.server.on("connection", (socket) => socket.send('{"serviceVersion":"2.3.1+33747","version":6}'));
    this.timer = setInterval(() => {
      const frame = this.frame();
      for (const client of this.server.clients) client.send(frame);
    }, 10);
  }

  get address(): string { return `leap://127.0.0.1:${(this.server.address() as AddressInfo).port}`; }

  stop(): void {
    clearInterval(this.timer);
    for (const client of this.server.clients) client.terminate();
    this.server.close();
  }

  private frame(): string {
    const { joints } = skeleton(new Matrix4(), 0.1, "right");
    const at = (joint: number) => new Vector3().fromArray(joints, 8 * joint);
    // like a real tracker, it is never quite still: joints without any motion are rejected
    this.noise = -this.noise;
    const shift = this.tip.clone().sub(at(kIndexTip)).addScalar(this.noise);
    const place = (joint: number) => at(joint).add(shift).multiplyScalar(1000).toArray();
    const axes = (joint: number) => {
      const turn = new Quaternion().fromArray(joints, 8 * joint + 3);
      return [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)].map((axis) => axis.applyQuaternion(turn).toArray());
    };
    const pointables = [0, 1, 2, 3, 4].map((finger) => {
      // the thumb's metacarpal has no length
      const joint = (bone: number) => (finger === 0 ? kThumbMetacarpal + Math.max(0, bone - 1) : kIndexMetacarpal + 5 * (finger - 1) + bone);
      return {
        id: 10 + finger, handId: 1, type: finger, tool: false, width: 2000 * joints[8 * joint(2) + 7]!, bases: [0, 1, 2, 3].map((bone) => axes(joint(bone))),
        carpPosition: place(joint(0)), mcpPosition: place(joint(1)), pipPosition: place(joint(2)), dipPosition: place(joint(3)), btipPosition: place(joint(4)),
      };
    });
    const hand = { id: 1, type: "right", confidence: 1, palmPosition: place(0), palmNormal: [0, -1, 0], direction: [0, 0, -1], wrist: place(1) };
    return JSON.stringify({ id: 1, timestamp: Math.round(1000 * (performance.now() - this.begun)), hands: [hand], pointables });
  }
}
