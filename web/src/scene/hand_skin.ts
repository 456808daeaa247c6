/// The signed distance to the skin of a hand at rest: smoothly blended round cones along the fingers and flesh across the
/// palm, the model of the program, (H12) of docs/design/hands.md.

import { Vector3 } from "three";
import { kFingers, kPalm, kThumb, kWrist, type RestHand } from "./hand_bones";

/// A straight piece of flesh that moves with a joint.
export interface Bone {
  joint: number;
  chain: number; // 0–3 the fingers, 4 the thumb, 5 the palm
  a: Vector3;
  b: Vector3;
  ra: number;
  rb: number;
}

// blending widths [m]
const kPalmBlend = 0.005, kFingerBlend = 0.002, kRootBlend = 0.006;

type Corner = { p: Vector3; r: number };

/// Smaller of two distances, smoothed over `k` where they meet.
function smoothMin(a: number, b: number, k: number): number {
  const h = Math.max(k - Math.abs(a - b), 0) / k;
  return Math.min(a, b) - (h * h * k) / 4;
}

/// Several times faster than Math.hypot.
function length(x: number, y: number, z: number): number {
  return Math.sqrt(x * x + y * y + z * z);
}

/// Distance to a segment whose radius varies linearly.
export function boneDistance(bone: Bone, x: number, y: number, z: number): number {
  const { a, b, ra, rb } = bone;
  const dx = b.x - a.x, dy = b.y - a.y, dz = b.z - a.z;
  const px = x - a.x, py = y - a.y, pz = z - a.z;
  const u = Math.min(1, Math.max(0, (px * dx + py * dy + pz * dz) / (dx * dx + dy * dy + dz * dz + 1e-12)));
  return length(px - u * dx, py - u * dy, pz - u * dz) - (ra + u * (rb - ra));
}

/// A sphere that encloses some corners.
class Bounds {
  private readonly middle = new Vector3();
  private readonly reach: number;
  constructor(corners: Corner[]) {
    for (const c of corners) this.middle.addScaledVector(c.p, 1 / corners.length);
    this.reach = Math.max(...corners.map((c) => c.p.distanceTo(this.middle) + c.r));
  }
  atLeast(x: number, y: number, z: number): number {
    return length(x - this.middle.x, y - this.middle.y, z - this.middle.z) - this.reach;
  }
}

/// A triangle whose thickness varies linearly.
class Flesh {
  private readonly ab: Vector3;
  private readonly ac: Vector3;
  private readonly d00: number;
  private readonly d01: number;
  private readonly d11: number;
  private readonly ab_: Bone;
  private readonly bc_: Bone;
  private readonly ca_: Bone;
  private readonly bounds: Bounds;

  constructor(private readonly a: Corner, private readonly b: Corner, private readonly c: Corner) {
    this.ab = b.p.clone().sub(a.p);
    this.ac = c.p.clone().sub(a.p);
    this.d00 = this.ab.dot(this.ab);
    this.d01 = this.ab.dot(this.ac);
    this.d11 = this.ac.dot(this.ac);
    const edge = (s: Corner, t: Corner): Bone => ({ joint: 0, chain: 5, a: s.p, b: t.p, ra: s.r, rb: t.r });
    [this.ab_, this.bc_, this.ca_] = [edge(a, b), edge(b, c), edge(c, a)];
    this.bounds = new Bounds([a, b, c]);
  }

  /// A lower bound of the distance.
  atLeast(x: number, y: number, z: number): number { return this.bounds.atLeast(x, y, z); }

  distance(x: number, y: number, z: number): number {
    const px = x - this.a.p.x, py = y - this.a.p.y, pz = z - this.a.p.z;
    const d20 = px * this.ab.x + py * this.ab.y + pz * this.ab.z;
    const d21 = px * this.ac.x + py * this.ac.y + pz * this.ac.z;
    const det = this.d00 * this.d11 - this.d01 * this.d01 + 1e-18;
    const v = (this.d11 * d20 - this.d01 * d21) / det;
    const w = (this.d00 * d21 - this.d01 * d20) / det;
    if (v >= 0 && w >= 0 && v + w <= 1) {
      const qx = px - v * this.ab.x - w * this.ac.x, qy = py - v * this.ab.y - w * this.ac.y, qz = pz - v * this.ab.z - w * this.ac.z;
      return length(qx, qy, qz) - (this.a.r + v * (this.b.r - this.a.r) + w * (this.c.r - this.a.r));
    }
    return Math.min(boneDistance(this.ab_, x, y, z), boneDistance(this.bc_, x, y, z), boneDistance(this.ca_, x, y, z));
  }
}

export class HandSkin {
  readonly bones: Bone[] = [];
  readonly lower = new Vector3(Infinity, Infinity, Infinity);
  readonly upper = new Vector3(-Infinity, -Infinity, -Infinity);
  private readonly chains: { bones: Bone[]; bounds: Bounds }[] = [];
  private readonly flesh: Flesh[] = [];

  constructor(rest: RestHand) {
    const palm = rest.radius[kPalm] ?? 0.015;
    const corner = (j: number, least = 0): Corner => ({ p: rest.position[j]!, r: Math.max(rest.radius[j]!, least * palm) });
    const bone = (joint: number, chain: number, s: Corner, t: Corner): Bone => {
      const made: Bone = { joint, chain, a: s.p, b: t.p, ra: s.r, rb: t.r };
      this.bones.push(made);
      return made;
    };
    const chain = (bones: Bone[]) => this.chains.push({ bones, bounds: new Bounds(bones.flatMap((b) => [{ p: b.a, r: b.ra }, { p: b.b, r: b.rb }])) });

    kFingers.forEach((base, f) => {
      chain([1, 2, 3].map((i) => bone(base + i, f, corner(base + i), corner(base + i + 1))));
      bone(base, 5, corner(base, 0.85), corner(base + 1, 0.8));
    });
    chain([1, 2].map((i) => bone(kThumb + i, 4, corner(kThumb + i), corner(kThumb + i + 1))));
    bone(kThumb, 5, corner(kThumb, 0.95), corner(kThumb + 1, 0.75));
    bone(kWrist, 5, corner(kWrist), corner(kFingers[1]!, 0.85));

    // the palm, the ball of the thumb, the web next to it, the wrist
    const base = kFingers.map((j) => corner(j, 0.85));
    const knuckle = kFingers.map((j) => corner(j + 1, 0.8));
    const add = (a: Corner, b: Corner, c: Corner) => this.flesh.push(new Flesh(a, b, c));
    for (let f = 0; f < 3; ++f) {
      add(base[f]!, base[f + 1]!, knuckle[f]!);
      add(knuckle[f]!, base[f + 1]!, knuckle[f + 1]!);
    }
    const root = corner(kThumb, 0.95), thumb = corner(kThumb + 1, 0.75), wrist = corner(kWrist);
    add(root, thumb, base[0]!);
    add(thumb, base[0]!, { p: base[0]!.p.clone().lerp(knuckle[0]!.p, 0.65), r: 0.6 * palm });
    add(wrist, base[0]!, base[3]!);
    add(wrist, root, base[0]!);

    for (const b of this.bones) {
      for (const [p, r] of [[b.a, b.ra], [b.b, b.rb]] as const) {
        this.lower.min(p.clone().subScalar(r + 0.004));
        this.upper.max(p.clone().addScalar(r + 0.004));
      }
    }
  }

  distance(x: number, y: number, z: number): number {
    // parts too far away to be blended in are skipped
    let palm = 1;
    for (const f of this.flesh) {
      if (f.atLeast(x, y, z) < palm + kPalmBlend) palm = smoothMin(palm, f.distance(x, y, z), kPalmBlend);
    }
    let all = palm;
    for (const { bones, bounds } of this.chains) {
      if (bounds.atLeast(x, y, z) > all + kRootBlend) continue;
      let finger = 1;
      for (const b of bones) finger = smoothMin(finger, boneDistance(b, x, y, z), kFingerBlend);
      all = smoothMin(all, finger, kRootBlend);
    }
    return all;
  }

  /// The joints that move the skin at a point, with their weights: those of the nearest bone and of its neighbours.
  weights(x: number, y: number, z: number): { joints: number[]; weights: number[] } {
    const near = this.bones.map((b) => ({ bone: b, d: boneDistance(b, x, y, z) })).sort((p, q) => p.d - q.d);
    const first = near[0]!;
    const joined = near.filter(({ bone: b }) => b.chain === first.bone.chain || (b.chain === 5 && this.meets(b, first.bone)) || (first.bone.chain === 5 && this.meets(first.bone, b)));
    const kept = joined.slice(0, 4).map(({ bone: b, d }) => ({ joint: b.joint, w: Math.exp((first.d - d) / 0.004) }));
    const sum = kept.reduce((s, k) => s + k.w, 0);
    while (kept.length < 4) kept.push({ joint: first.bone.joint, w: 0 });
    return { joints: kept.map((k) => k.joint), weights: kept.map((k) => k.w / sum) };
  }
  private meets(palm: Bone, finger: Bone): boolean {
    return palm.b === finger.a;
  }
}
