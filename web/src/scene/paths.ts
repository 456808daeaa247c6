/// The closed paths on the skin as ribbons, wide where the pressure is high, and their focal points in slow motion.

import { BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, GreaterDepth, Group, LessEqualDepth, Mesh, Points, ShaderMaterial, Vector2, type IUniform } from "three";
import { pathColour } from "../colours";
import type { Path } from "../wire";

const kRibbonVertex = /* glsl */ `
attribute vec3 tangent_D, colour;
attribute vec4 shape; // side −1 or 1, width [m], position along the path 0 to 1, position of its focal point
uniform vec2 viewport;
uniform float least;
varying vec3 vColour;
varying vec4 vShape;
void main() {
  vec4 at = viewMatrix * vec4(position, 1.0);
  vec4 clip = projectionMatrix * at;
  vec4 ahead = projectionMatrix * viewMatrix * vec4(position + tangent_D * 0.001, 1.0);
  vec2 along = (ahead.xy / ahead.w - clip.xy / clip.w) * viewport;
  vec2 across = length(along) > 1e-6 ? normalize(vec2(-along.y, along.x)) : vec2(0.0);
  float pixels = max(least, shape.y * projectionMatrix[1][1] / clip.w * viewport.y * 0.5);
  // slightly in front of the skin
  vec4 raised = projectionMatrix * vec4(at.xyz * (1.0 - 0.004 / length(at.xyz)), 1.0);
  clip.z = raised.z / raised.w * clip.w;
  clip.xy += across * shape.x * pixels / viewport * clip.w;
  gl_Position = clip;
  vColour = colour;
  vShape = shape;
}`;

const kRibbonFragment = /* glsl */ `
uniform float strength;
uniform vec3 casing;
varying vec3 vColour;
varying vec4 vShape;
void main() {
  float v = abs(vShape.x);
  float inside = smoothstep(0.78, 0.66, v);
  float behind = fract(vShape.w - vShape.z);
  float glow = vShape.w < 0.0 ? 0.0 : exp(-14.0 * behind);
  vec3 tube = mix(vColour * (0.72 + 0.4 * sqrt(max(0.0, 1.0 - v * v))), vec3(1.0), 0.75 * glow);
  float alpha = strength * smoothstep(1.0, 0.9, v);
  gl_FragColor = vec4(mix(casing, tube, inside) * alpha, alpha);
}`;

const kPointVertex = /* glsl */ `
attribute vec3 colour;
attribute float size; // glow radius [m]
uniform vec2 viewport;
varying vec3 vColour;
void main() {
  vec4 at = viewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * at;
  gl_PointSize = max(14.0 * step(1e-6, size), size * projectionMatrix[1][1] / gl_Position.w * viewport.y);
  vColour = colour;
}`;

const kPointFragment = /* glsl */ `
varying vec3 vColour;
void main() {
  float r = 2.0 * length(gl_PointCoord - 0.5);
  float core = smoothstep(0.36, 0.28, r), ring = smoothstep(0.52, 0.46, r), halo = 0.55 * pow(max(0.0, 1.0 - r), 1.6);
  float alpha = max(ring, halo);
  gl_FragColor = vec4(mix(vColour * max(ring, 0.6), vec3(1.0), core) * alpha, alpha);
}`;

/// Vertex attributes whose buffers grow on demand.
class Growing {
  readonly geometry = new BufferGeometry();
  private capacity = 0;
  constructor(private readonly sizes: Record<string, number>) {}
  reserve(vertices: number): void {
    if (vertices <= this.capacity) return;
    this.capacity = Math.ceil(1.5 * vertices);
    this.geometry.dispose();
    for (const [name, size] of Object.entries(this.sizes)) {
      this.geometry.setAttribute(name, new BufferAttribute(new Float32Array(size * this.capacity), size).setUsage(DynamicDrawUsage));
    }
  }
  data(name: string): Float32Array { return this.geometry.getAttribute(name).array as Float32Array; }
  changed(): void { for (const name of Object.keys(this.sizes)) this.geometry.getAttribute(name).needsUpdate = true; }
}

/// The position of a path's focal point, 0 to 1 along it.
interface Runner {
  phase: number;
  period: number; // as played [s]
}

export class Paths {
  readonly group = new Group();
  private readonly ribbons = new Growing({ position: 3, tangent_D: 3, colour: 3, shape: 4 });
  private readonly points = new Growing({ position: 3, colour: 3, size: 1 });
  private readonly viewport: IUniform<Vector2> = { value: new Vector2(1, 1) };
  private readonly casing: IUniform<Color> = { value: new Color("#ffffff") };
  private readonly least: IUniform<number> = { value: 2.5 };
  private plan: Path[] = [];
  private along: Float64Array[] = []; // per path: arc length from its first point to each, and of the whole loop [m]
  private begin: number[] = []; // first vertex of each path
  private readonly runners: Runner[] = [];
  private clock = 0; // as played [s]
  private linear = Array.from({ length: 8 }, (_, i) => new Color().setRGB(...pathColour(i), "srgb"));
  /// slow-motion factor
  slowdown = 50;

  constructor() {
    const uniforms = { viewport: this.viewport, casing: this.casing, least: this.least };
    const ribbon = (depthFunc: typeof GreaterDepth | typeof LessEqualDepth, strength: number): Mesh => {
      const material = new ShaderMaterial({
        vertexShader: kRibbonVertex, fragmentShader: kRibbonFragment, uniforms: { ...uniforms, strength: { value: strength } },
        transparent: true, premultipliedAlpha: true, depthWrite: false, depthFunc, side: 2,
      });
      return new Mesh(this.ribbons.geometry, material);
    };
    const dots = new ShaderMaterial({ vertexShader: kPointVertex, fragmentShader: kPointFragment, uniforms, transparent: true, premultipliedAlpha: true, depthTest: false, depthWrite: false });
    const hidden = ribbon(GreaterDepth, 0.62), seen = ribbon(LessEqualDepth, 1);
    hidden.renderOrder = 2;
    seen.renderOrder = 3;
    this.ribbons.reserve(64);
    this.points.reserve(8);
    const marks = new Points(this.points.geometry, dots);
    marks.renderOrder = 4;
    for (const object of [hidden, seen, marks]) {
      object.frustumCulled = false;
      this.group.add(object);
    }
  }

  set(plan: Path[]): void {
    this.plan = plan;
    const strongest = Math.max(1e-9, ...plan.flatMap((p) => Array.from({ length: p.count }, (_, i) => p.points[6 * i + 2]!)));
    const paths = plan.map((p) => (p.kind === "path" && p.count >= 2 ? p : null));
    const vertices = paths.reduce((sum, p) => sum + (p === null ? 0 : 2 * (p.count + 1)), 0);
    this.ribbons.reserve(vertices);
    const position = this.ribbons.data("position"), tangent = this.ribbons.data("tangent_D"), colour = this.ribbons.data("colour"), shape = this.ribbons.data("shape");
    const index: number[] = [];
    let v = 0;
    this.along = [];
    this.begin = [];
    paths.forEach((path, k) => {
      this.begin.push(v);
      const lengths = new Float64Array((path?.count ?? 0) + 1);
      this.along.push(lengths);
      if (path === null) return;
      const n = path.count;
      const at = (i: number, a: number) => path.points[6 * ((i + n) % n) + 3 + a]!;
      for (let i = 0; i < n; ++i) lengths[i + 1] = lengths[i]! + Math.hypot(at(i + 1, 0) - at(i, 0), at(i + 1, 1) - at(i, 1), at(i + 1, 2) - at(i, 2));
      const tint = this.linear[k % this.linear.length]!;
      for (let i = 0; i <= n; ++i) {
        const pressure = path.points[6 * (i % n) + 2]! / strongest;
        const width = 0.0022 + 0.0034 * Math.max(0, pressure);
        const t = [0, 1, 2].map((a) => at(i + 1, a) - at(i - 1, a));
        const length = Math.hypot(t[0]!, t[1]!, t[2]!) || 1;
        for (const side of [-1, 1]) {
          position.set([at(i, 0), at(i, 1), at(i, 2)], 3 * v);
          tangent.set([t[0]! / length, t[1]! / length, t[2]! / length], 3 * v);
          colour.set([tint.r, tint.g, tint.b], 3 * v);
          shape.set([side, width, lengths[i]! / (lengths[n]! || 1), 0], 4 * v);
          if (side === -1 && i < n) index.push(v, v + 1, v + 2, v + 1, v + 3, v + 2);
          ++v;
        }
      }
    });
    this.ribbons.geometry.setIndex(index);
    this.points.reserve(plan.length);
    while (this.runners.length < plan.length) this.runners.push({ phase: 0, period: 1 });
  }

  /// Advances the focal points by `dt` seconds of the viewer's time.
  advance(dt: number): void {
    const position = this.points.data("position"), colour = this.points.data("colour"), size = this.points.data("size");
    const shape = this.ribbons.data("shape");
    this.clock += dt / this.slowdown;
    this.plan.forEach((path, k) => {
      const runner = this.runners[k]!;
      runner.period = path.period > 0 ? path.period : 0.02;
      runner.phase = this.phase(path, runner, dt);
      const tint = this.linear[k % this.linear.length]!;
      colour.set([tint.r, tint.g, tint.b], 3 * k);
      if (path.kind === "focus") {
        // modulation in slow motion: from zero to full and back in a period
        const intensity = 0.5 - 0.5 * Math.cos(2 * Math.PI * runner.phase);
        position.set(path.points.subarray(3, 6), 3 * k);
        size[k] = 0.004 + 0.011 * intensity;
        return;
      }
      if (path.count < 2) {
        size[k] = 0;
        return;
      }
      const [i, u] = this.place(k, runner.phase);
      const next = (i + 1) % path.count;
      for (let a = 0; a < 3; ++a) position[3 * k + a] = path.points[6 * i + 3 + a]! * (1 - u) + path.points[6 * next + 3 + a]! * u;
      size[k] = 0.0105;
      for (let v = this.begin[k]!; v < this.begin[k]! + 2 * (path.count + 1); ++v) shape[4 * v + 3] = runner.phase;
    });
    this.points.geometry.setDrawRange(0, this.plan.length);
    this.ribbons.changed();
    this.points.changed();
  }

  /// The current position of a path's focal point, 0 to 1. Paths in step and foci share one clock.
  private phase(path: Path, runner: Runner, dt: number): number {
    if (path.kind === "focus") return (this.clock / runner.period + 1 - path.phase) % 1;
    if (path.loop > 0) return (Math.max(1, Math.round(path.loop / runner.period)) * (this.clock / path.loop)) % 1;
    return (runner.phase + dt / (this.slowdown * runner.period)) % 1;
  }

  /// The point of path k before a position along it, and the fraction of the way to the next.
  private place(k: number, phase: number): [number, number] {
    const lengths = this.along[k]!;
    const wanted = phase * lengths[lengths.length - 1]!;
    let i = 0;
    while (i + 2 < lengths.length && lengths[i + 1]! <= wanted) ++i;
    return [i, Math.min(1, (wanted - lengths[i]!) / (lengths[i + 1]! - lengths[i]! || 1))];
  }

  setViewport(width: number, height: number, pixelRatio: number): void {
    this.viewport.value.set(width, height);
    this.least.value = 2.6 * pixelRatio;
  }
  setDark(dark: boolean): void { this.casing.value.set(dark ? "#f4f6fa" : "#ffffff"); }
}
