/// The point where a ray from the camera meets the skin that the program computes with.

import { Matrix4, Vector3 } from "three";
import { cellAt } from "../panels/plane_layout";
import type { Patch } from "../wire";

export interface Hit {
  patch: Patch;
  cell: number;
  point: Vector3; // in D [m]
}

const kRounds = 6; // iterations from the plane to the skin

/// Intersects a ray with a patch: first with its plane, then with the skin at its height over the plane.
function hitPatch(patch: Patch, origin: Vector3, direction: Vector3): Hit | null {
  const X_DP = new Matrix4().fromArray([...patch.pose, 0, 0, 0, 1]).transpose();
  const X_PD = X_DP.clone().invert();
  const from = origin.clone().applyMatrix4(X_PD), along = direction.clone().transformDirection(X_PD);
  if (Math.abs(along.z) < 1e-6) return null;
  let height = 0, cell = -1;
  const at = new Vector3();
  for (let round = 0; round < kRounds; ++round) {
    const t = (height - from.z) / along.z;
    if (!(t > 0)) return null;
    at.copy(from).addScaledVector(along, t);
    const next = cellAt(patch, at.x, at.y);
    if (next < 0) return null;
    if (next === cell) break;
    cell = next;
    height = patch.height[cell]! * patch.heightScale;
  }
  return { patch, cell, point: at.applyMatrix4(X_DP) };
}

/// The nearest skin along a ray; null if the ray misses.
export function pick(field: Patch[], origin: Vector3, direction: Vector3): Hit | null {
  let nearest: Hit | null = null;
  for (const patch of field) {
    const hit = hitPatch(patch, origin, direction);
    if (hit === null) continue;
    if (nearest === null || hit.point.distanceTo(origin) < nearest.point.distanceTo(origin)) nearest = hit;
  }
  return nearest;
}
