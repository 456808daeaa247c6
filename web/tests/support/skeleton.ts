/// A hand of average size in any pose, like the program's scripted hand: (H2) and (H3) of docs/design/hands.md.

import { Matrix4, Quaternion, Vector3 } from "three";
import type { Hand } from "../../src/wire";

const kFingers = [
  { base: 6, at: [-11, -1, 33], splay: 10, spread: 2, length: [68.12, 39.78, 22.38, 15.82], radius: [18.2, 10.3, 8.5, 7.6, 6.6] },
  { base: 11, at: [0, 0, 32.3], splay: 0, spread: 0, length: [64.6, 44.63, 26.33, 17.4], radius: [18.2, 11.2, 8, 7.6, 6.6] },
  { base: 16, at: [9.5, -0.5, 31], splay: -8.5, spread: -1, length: [57.95, 41.37, 25.65, 17.3], radius: [16.6, 9.9, 7.6, 7.2, 6.2] },
  { base: 21, at: [18, -3.5, 29], splay: -17, spread: -4, length: [53.69, 32.74, 18.11, 15.96], radius: [15.6, 8.5, 6.8, 6.4, 5.4] },
] as const;
const kThumb = { length: [46.22, 31.57, 21.67], radius: [17, 12.3, 9.8, 8.8] };
const kOpen = [6, 10, 6], kClosed = [70, 95, 55], kThumbOpen = [0, 8, 6], kThumbClosed = [12, 40, 45];
const kDegree = Math.PI / 180;

const flexed = (angle: number) => new Matrix4().makeRotationX(-angle);
const splayed = (degrees: number) => new Matrix4().makeRotationY(degrees * kDegree);

/// A right hand, or its mirror image; `pose` is X_DH: x towards a right hand's little finger, y dorsal, z to the wrist.
export function skeleton(pose: Matrix4, closure: number, side: "left" | "right", id = 1): Hand {
  const frame: Matrix4[] = [];
  const radius: number[] = [];
  const put = (joint: number, rotation: Matrix4, p: Vector3, r: number) => {
    frame[joint] = rotation.clone().setPosition(p);
    radius[joint] = r / 1000;
  };
  const mm = (x: number, y: number, z: number) => new Vector3(x, y, z).divideScalar(1000);
  const still = new Matrix4();
  put(0, still, mm(0, 0, 0), 15);
  put(1, still, mm(2, -2, 58), 20);

  const walk = (first: number, from: Vector3, start: Matrix4, lengths: readonly number[], flexion: number[], radii: readonly number[]) => {
    const at = from.clone(), turned = start.clone();
    lengths.forEach((length, b) => {
      if (b > 0) turned.multiply(flexed(flexion[b - 1] ?? 0));
      put(first + b, turned, at, radii[b] ?? 0);
      at.addScaledVector(new Vector3().setFromMatrixColumn(turned, 2), -length / 1000);
    });
    put(first + lengths.length, turned, at, radii[lengths.length] ?? 0);
  };
  const bent = (open: number[], closed: number[]) => open.map((o, i) => (o + closure * ((closed[i] ?? 0) - o)) * kDegree);

  for (const finger of kFingers) {
    const flexion = bent(kOpen, kClosed);
    const metacarpal = splayed(finger.splay);
    const [x, y, z] = finger.at;
    const base = mm(x, y, z);
    const knuckle = base.clone().addScaledVector(new Vector3().setFromMatrixColumn(metacarpal, 2), -finger.length[0] / 1000);
    put(finger.base, metacarpal, base, finger.radius[0]);
    const first = metacarpal.clone().multiply(splayed(finger.spread)).multiply(flexed(flexion[0] ?? 0));
    walk(finger.base + 1, knuckle, first, finger.length.slice(1), flexion.slice(1), finger.radius.slice(1));
  }
  const flexion = bent(kThumbOpen, kThumbClosed);
  const z = new Vector3(0.62, 0.3, 0.72).normalize();
  const x = new Vector3(-0.7, 0.35, 0.6).cross(z).normalize();
  const root = new Matrix4().makeBasis(x, z.clone().cross(x), z).multiply(flexed(flexion[0] ?? 0));
  walk(2, mm(-20, -10, 42), root, kThumb.length, flexion.slice(1), kThumb.radius);

  const joints = new Float32Array(26 * 8);
  frame.forEach((inHand, j) => {
    const p = new Vector3().setFromMatrixPosition(inHand), q = new Quaternion().setFromRotationMatrix(inHand);
    if (side === "left") {
      p.x = -p.x;
      q.set(q.x, -q.y, -q.z, q.w);
    }
    p.applyMatrix4(pose);
    q.premultiply(new Quaternion().setFromRotationMatrix(pose));
    joints.set([p.x, p.y, p.z, q.x, q.y, q.z, q.w, radius[j] ?? 0], 8 * j);
  });
  return { id, side, confidence: 1, joints };
}
