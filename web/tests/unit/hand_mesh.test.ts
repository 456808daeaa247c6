import { Matrix4, Quaternion, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { restHand } from "../../src/scene/hand_bones";
import { HandSkin } from "../../src/scene/hand_skin";
import { surfaceNets, type Surface } from "../../src/scene/surface_nets";
import type { Hand } from "../../src/wire";
import { skeleton } from "../support/skeleton";

const somewhere = new Matrix4().makeRotationX(1.2).setPosition(0.02, -0.03, 0.2);
const hands = [skeleton(somewhere, 0, "right"), skeleton(somewhere, 0.6, "left")];

/// In a closed surface every edge is in two triangles, once in each direction.
function openEdges(surface: Surface): number {
  const seen = new Map<string, number>();
  for (let t = 0; t < surface.indices.length; t += 3) {
    for (let e = 0; e < 3; ++e) {
      const [a, b] = [surface.indices[t + e]!, surface.indices[t + ((e + 1) % 3)]!];
      const key = a < b ? `${a} ${b}` : `${b} ${a}`;
      seen.set(key, (seen.get(key) ?? 0) + (a < b ? 1 : -1));
    }
  }
  return [...seen.values()].filter((v) => v !== 0).length;
}
function volume(surface: Surface): number {
  const at = (i: number) => new Vector3().fromArray(surface.positions, 3 * surface.indices[i]!);
  let sum = 0;
  for (let t = 0; t < surface.indices.length; t += 3) sum += at(t).dot(at(t + 1).cross(at(t + 2))) / 6;
  return sum;
}

describe("surfaceNets", () => {
  const radius = 0.03;
  const sphere = surfaceNets((x, y, z) => Math.hypot(x, y, z) - radius, new Vector3(-0.04, -0.04, -0.04), new Vector3(0.04, 0.04, 0.04), 0.003);
  it("makes a closed sphere of the right size, with outward normals", () => {
    expect(openEdges(sphere)).toBe(0);
    expect(volume(sphere) / ((4 / 3) * Math.PI * radius ** 3)).toBeCloseTo(1, 1);
    for (let v = 0; v < sphere.positions.length; v += 3) {
      const p = new Vector3().fromArray(sphere.positions, v), n = new Vector3().fromArray(sphere.normals, v);
      expect(Math.abs(p.length() - radius)).toBeLessThan(0.0002);
      expect(p.normalize().dot(n)).toBeGreaterThan(0.95);
    }
  });
});

describe("the skin of a tracked hand", () => {
  const made = hands.map((hand) => {
    const rest = restHand(hand);
    const skin = new HandSkin(rest);
    return { hand, rest, skin, surface: surfaceNets((x, y, z) => skin.distance(x, y, z), skin.lower, skin.upper, 0.003) };
  });

  it.each(made.map((m) => [m.hand.side, m] as const))("is closed, and as large as a hand (%s)", (_, { surface }) => {
    expect(openEdges(surface)).toBe(0);
    expect(volume(surface)).toBeGreaterThan(250e-6);
    expect(volume(surface)).toBeLessThan(500e-6);
  });

  it.each(made.map((m) => [m.hand.side, m] as const))("lies about the joints in the pose of the tracker (%s)", (_, { hand, rest, skin }) => {
    // a point in the middle of each bone, moved by the joints, ends on the tracked bone
    for (const bone of skin.bones.filter((b) => b.chain < 5)) {
      const middle = bone.a.clone().lerp(bone.b, 0.5);
      const carried = carry(hand, rest.frame, skin, middle);
      const tracked = at(hand, bone.joint).lerp(at(hand, bone.joint + 1), 0.5);
      expect(carried.distanceTo(tracked)).toBeLessThan(0.003);
    }
  });
});

function at(hand: Hand, joint: number): Vector3 { return new Vector3().fromArray(hand.joints, 8 * joint); }

function carry(hand: Hand, frames: Matrix4[], skin: HandSkin, p: Vector3): Vector3 {
  const { joints, weights } = skin.weights(p.x, p.y, p.z);
  const sum = new Vector3();
  joints.forEach((j, i) => {
    const now = new Matrix4().compose(at(hand, j), new Quaternion().fromArray(hand.joints, 8 * j + 3), new Vector3(1, 1, 1));
    sum.addScaledVector(p.clone().applyMatrix4(frames[j]!.clone().invert()).applyMatrix4(now), weights[i]!);
  });
  return sum;
}
