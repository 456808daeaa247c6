/// The zero surface of a signed distance, by naive surface nets (S. F. F. Gibson, "Constrained elastic surface nets", 1998):
/// one vertex in each cell that the surface crosses, one quad across each edge that it crosses.

export interface Surface {
  positions: Float32Array; // 3 per vertex
  normals: Float32Array;
  indices: Uint32Array; // triangles, counter-clockwise from outside
}

type Distance = (x: number, y: number, z: number) => number;
type Point = { x: number; y: number; z: number };

/// Distances at the corners of a grid. Far from the surface only the signs are correct, which suffices.
function sample(distance: Distance, lower: Point, step: number, size: [number, number, number]): Float32Array {
  const [nx, ny, nz] = size;
  const values = new Float32Array(nx * ny * nz);
  const block = 4;
  const reach = block * step * 0.95; // more than from the middle of a block to its corners
  for (let z0 = 0; z0 < nz; z0 += block) for (let y0 = 0; y0 < ny; y0 += block) for (let x0 = 0; x0 < nx; x0 += block) {
    const half = (block / 2) * step;
    const middle = distance(lower.x + x0 * step + half, lower.y + y0 * step + half, lower.z + z0 * step + half);
    for (let z = z0; z < Math.min(nz, z0 + block); ++z) for (let y = y0; y < Math.min(ny, y0 + block); ++y) for (let x = x0; x < Math.min(nx, x0 + block); ++x) {
      values[(z * ny + y) * nx + x] = Math.abs(middle) > reach ? middle : distance(lower.x + x * step, lower.y + y * step, lower.z + z * step);
    }
  }
  return values;
}

export function surfaceNets(distance: Distance, lower: Point, upper: Point, step: number): Surface {
  const count = (a: number, b: number) => Math.ceil((b - a) / step) + 2;
  const size: [number, number, number] = [count(lower.x, upper.x), count(lower.y, upper.y), count(lower.z, upper.z)];
  const [nx, ny, nz] = size;
  const values = sample(distance, lower, step, size);
  const at = (x: number, y: number, z: number) => values[(z * ny + y) * nx + x]!;

  // vertices: mean of the crossings of a cell's edges
  const vertexOf = new Int32Array(nx * ny * nz).fill(-1);
  const points: number[] = [];
  const corner = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1, (i >> 1) & 1, (i >> 2) & 1] as const);
  const d = new Float32Array(8);
  for (let z = 0; z + 1 < nz; ++z) for (let y = 0; y + 1 < ny; ++y) for (let x = 0; x + 1 < nx; ++x) {
    let inside = 0;
    for (let c = 0; c < 8; ++c) {
      d[c] = at(x + (c & 1), y + ((c >> 1) & 1), z + (c >> 2));
      if (d[c]! < 0) ++inside;
    }
    if (inside === 0 || inside === 8) continue;
    let crossings = 0, sx = 0, sy = 0, sz = 0;
    for (let a = 0; a < 8; ++a) for (const bit of [1, 2, 4]) {
      const b = a | bit;
      if (b === a || d[a]! < 0 === d[b]! < 0) continue;
      const u = d[a]! / (d[a]! - d[b]!);
      sx += corner[a]![0] + u * (bit === 1 ? 1 : 0);
      sy += corner[a]![1] + u * (bit === 2 ? 1 : 0);
      sz += corner[a]![2] + u * (bit === 4 ? 1 : 0);
      ++crossings;
    }
    vertexOf[(z * ny + y) * nx + x] = points.length / 3;
    points.push(lower.x + (x + sx / crossings) * step, lower.y + (y + sy / crossings) * step, lower.z + (z + sz / crossings) * step);
  }

  // quads, wound to face the positive side
  const indices: number[] = [];
  const cell = (x: number, y: number, z: number) => vertexOf[(z * ny + y) * nx + x]!;
  const quad = (a: number, b: number, c: number, d: number, outwards: boolean) => {
    if (outwards) indices.push(a, b, c, a, c, d);
    else indices.push(a, c, b, a, d, c);
  };
  for (let z = 1; z + 1 < nz; ++z) for (let y = 1; y + 1 < ny; ++y) for (let x = 1; x + 1 < nx; ++x) {
    const inside = at(x, y, z) < 0;
    if (inside !== at(x + 1, y, z) < 0) quad(cell(x, y - 1, z - 1), cell(x, y, z - 1), cell(x, y, z), cell(x, y - 1, z), inside);
    if (inside !== at(x, y + 1, z) < 0) quad(cell(x - 1, y, z - 1), cell(x - 1, y, z), cell(x, y, z), cell(x, y, z - 1), inside);
    if (inside !== at(x, y, z + 1) < 0) quad(cell(x - 1, y - 1, z), cell(x, y - 1, z), cell(x, y, z), cell(x - 1, y, z), inside);
  }

  // projects onto the surface along the gradient, which is the normal there
  const positions = Float32Array.from(points);
  const normals = new Float32Array(positions.length);
  const h = step / 4;
  for (let v = 0; v < positions.length; v += 3) {
    for (let round = 0; round < 2; ++round) {
      const [x, y, z] = [positions[v]!, positions[v + 1]!, positions[v + 2]!];
      const d = distance(x, y, z);
      const g = [distance(x + h, y, z) - d, distance(x, y + h, z) - d, distance(x, y, z + h) - d];
      const length = Math.hypot(g[0]!, g[1]!, g[2]!) || 1;
      const move = Math.max(-step, Math.min(step, d)) * 0.9;
      for (let i = 0; i < 3; ++i) {
        normals[v + i] = g[i]! / length;
        positions[v + i] = positions[v + i]! - (move * g[i]!) / length;
      }
    }
  }
  return { positions, normals, indices: Uint32Array.from(indices) };
}
