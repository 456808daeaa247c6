/// An open, flat hand with the bone lengths of a tracked hand: the rest pose in which its skin is built.

import { Matrix4, Quaternion, Vector3 } from "three";
import { kJoints, type Hand } from "../wire";

export const kPalm = 0, kWrist = 1, kThumb = 2;
export const kFingers = [6, 11, 16, 21]; // the joints of their metacarpals: index, middle, ring, little

export interface RestHand {
  side: "left" | "right";
  position: Vector3[]; // joints, in the palm's frame [m]
  frame: Matrix4[]; // joint frames: −z along the bone, +y dorsal
  radius: number[]; // [m]
}

export function jointPosition(hand: Hand, joint: number): Vector3 {
  return new Vector3().fromArray(hand.joints, 8 * joint);
}
export function jointFrame(hand: Hand, joint: number, out = new Matrix4()): Matrix4 {
  const q = new Quaternion().fromArray(hand.joints, 8 * joint + 3).normalize();
  return out.compose(jointPosition(hand, joint), q, new Vector3(1, 1, 1));
}

/// Returns a frame with −z along `along`, and +y as close to `dorsal` as possible.
function boneFrame(at: Vector3, along: Vector3, dorsal: Vector3): Matrix4 {
  const z = along.clone().normalize().negate();
  const x = new Vector3().crossVectors(dorsal, z).normalize();
  const y = new Vector3().crossVectors(z, x);
  return new Matrix4().makeBasis(x, y, z).setPosition(at);
}

export function boneLengths(hand: Hand): number[] {
  const lengths: number[] = [];
  for (let j = kThumb; j < kJoints - 1; ++j) lengths.push(jointPosition(hand, j).distanceTo(jointPosition(hand, j + 1)));
  return lengths;
}

/// Length along the joints from the wrist to the tip of the middle finger, whatever the pose [mm].
export function handLength(hand: Hand): number {
  const joints = [kWrist, 11, 12, 13, 14, 15];
  let length = 0;
  for (let i = 1; i < joints.length; ++i) {
    const a = 8 * joints[i - 1]!, b = 8 * joints[i]!;
    length += Math.hypot(...[0, 1, 2].map((k) => hand.joints[b + k]! - hand.joints[a + k]!));
  }
  return 1000 * length;
}

export function restHand(hand: Hand): RestHand {
  const toPalm = jointFrame(hand, kPalm).invert();
  const frame: Matrix4[] = [];
  for (let j = 0; j < kJoints; ++j) frame.push(jointFrame(hand, j).premultiply(toPalm));
  const position = frame.map((m) => new Vector3().setFromMatrixPosition(m));
  const radius = Array.from({ length: kJoints }, (_, j) => Math.min(0.04, Math.max(0.003, hand.joints[8 * j + 7] ?? 0)));
  const mirror = hand.side === "left" ? -1 : 1;

  const layStraight = (first: number, bones: number, along: Vector3, dorsal: Vector3) => {
    const direction = along.clone().normalize();
    for (let b = 0; b < bones; ++b) {
      const length = jointPosition(hand, first + b).distanceTo(jointPosition(hand, first + b + 1));
      frame[first + b] = boneFrame(position[first + b]!, direction, dorsal);
      position[first + b + 1] = position[first + b]!.clone().addScaledVector(direction, length);
    }
    frame[first + bones] = boneFrame(position[first + bones]!, direction, dorsal);
  };

  // the palm keeps its shape; the fingers extend their metacarpals, fanned out to stay apart
  const up = new Vector3(0, 1, 0);
  const fan = [5, 0.5, -3.5, -8];
  kFingers.forEach((base, f) => {
    const along = position[base + 1]!.clone().sub(position[base]!);
    along.y *= 0.4;
    along.applyAxisAngle(up, ((fan[f] ?? 0) * mirror * Math.PI) / 180);
    layStraight(base + 1, 3, along, up);
  });
  // the thumb is abducted
  layStraight(kThumb, 3, new Vector3(-0.66 * mirror, -0.26, -0.72), new Vector3(-0.7 * mirror, 0.35, 0.6));
  return { side: hand.side, position, frame, radius };
}
