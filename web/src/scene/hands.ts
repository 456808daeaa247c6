/// The hands as smooth skin on the 26 joints, coloured by the field.

import { BufferAttribute, BufferGeometry, Color, DoubleSide, DynamicDrawUsage, FrontSide, GreaterDepth, Group, Matrix4, Mesh, ShaderMaterial } from "three";
import { kJoints, type Hand } from "../wire";
import { kFieldShader, type FieldMaps } from "./field_maps";
import { boneLengths, jointFrame, restHand } from "./hand_bones";
import { HandSkin } from "./hand_skin";
import { surfaceNets, type Surface } from "./surface_nets";

const kStep = 0.0032; // grid step of the skin's surface [m]

const kVertexShader = /* glsl */ `
varying vec3 p_D, normal_D;
void main() {
  p_D = position;
  normal_D = normal;
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
}`;

const kFragmentShader = /* glsl */ `
varying vec3 p_D, normal_D;
uniform vec3 skinColour, shadeColour, rimColour;
uniform float opacity, fieldOnly;
${kFieldShader}
void main() {
  vec3 n = normalize(normal_D);
  vec3 view = normalize(cameraPosition - p_D);
  vec4 field = fieldColour(p_D, n);
  if (fieldOnly > 0.0) {
    // the far side shines through
    gl_FragColor = vec4(field.rgb * field.a, field.a) * fieldOnly;
    return;
  }
  vec3 key = normalize(vec3(-0.45, -0.55, 0.85)), fill = normalize(vec3(0.8, -0.35, -0.25));
  float wrap = 0.35;
  float lit = max(0.0, (dot(n, key) + wrap) / (1.0 + wrap));
  float filled = max(0.0, (dot(n, fill) + 0.5) / 1.5);
  float rim = pow(1.0 - max(0.0, dot(n, view)), 3.0);
  vec3 h = normalize(key + view);
  float gloss = 0.10 * pow(max(0.0, dot(n, h)), 28.0);
  vec3 colour = mix(shadeColour, skinColour, 0.18 + 0.62 * lit + 0.26 * filled) + gloss + rimColour * rim;
  // the field keeps its own colours, which match the colour scale
  colour = mix(colour, field.rgb * (0.9 + 0.1 * lit), field.a);
  float alpha = mix(opacity, max(opacity, 0.97), max(field.a, rim));
  gl_FragColor = vec4(colour * alpha, alpha);
}`;

/// Tracked lengths fluctuate; the skin is rebuilt only if they differ by more than this [m].
const kLengthTolerance = 0.002;

class HandFigure {
  readonly mesh: Mesh;
  readonly through: Mesh;
  private lengths: number[] = [];
  private side = "";
  // the skin in the rest pose, and the four joints that move each vertex
  private rest: Surface = { positions: new Float32Array(0), normals: new Float32Array(0), indices: new Uint32Array(0) };
  private joints = new Uint8Array(0);
  private weights = new Float32Array(0);
  private toJoint: Matrix4[] = [];
  private readonly carry = new Float32Array(16 * kJoints);

  constructor(material: ShaderMaterial, throughMaterial: ShaderMaterial) {
    const make = (of: ShaderMaterial, order: number): Mesh => {
      const mesh = new Mesh(new BufferGeometry(), of);
      mesh.frustumCulled = false;
      mesh.renderOrder = order;
      mesh.visible = false;
      return mesh;
    };
    this.mesh = make(material, 0);
    this.through = make(throughMaterial, 1);
  }

  set(hand: Hand | undefined, opaque: boolean): void {
    this.mesh.visible = hand !== undefined;
    this.through.visible = hand !== undefined && !opaque;
    if (hand === undefined) return;
    const lengths = boneLengths(hand);
    if (hand.side !== this.side || lengths.some((l, i) => Math.abs(l - (this.lengths[i] ?? 0)) > kLengthTolerance)) {
      this.grow(hand);
      this.lengths = lengths;
      this.side = hand.side;
    }
    this.pose(hand);
  }

  /// Rebuilds the skin in the rest pose.
  private grow(hand: Hand): void {
    const rest = restHand(hand);
    const skin = new HandSkin(rest);
    this.rest = surfaceNets((x, y, z) => skin.distance(x, y, z), skin.lower, skin.upper, kStep);
    const { positions, indices } = this.rest;
    const vertices = positions.length / 3;
    this.joints = new Uint8Array(4 * vertices);
    this.weights = new Float32Array(4 * vertices);
    for (let v = 0; v < vertices; ++v) {
      const w = skin.weights(positions[3 * v]!, positions[3 * v + 1]!, positions[3 * v + 2]!);
      this.joints.set(w.joints, 4 * v);
      this.weights.set(w.weights, 4 * v);
    }
    this.toJoint = rest.frame.map((m) => m.clone().invert());
    const geometry = new BufferGeometry();
    for (const name of ["position", "normal"]) geometry.setAttribute(name, new BufferAttribute(new Float32Array(3 * vertices), 3).setUsage(DynamicDrawUsage));
    geometry.setIndex(new BufferAttribute(indices, 1));
    this.mesh.geometry.dispose();
    this.mesh.geometry = this.through.geometry = geometry;
  }

  /// Moves each vertex with its joints, by their weights (linear blend skinning).
  private pose(hand: Hand): void {
    const matrix = new Matrix4();
    this.toJoint.forEach((inverse, j) => jointFrame(hand, j, matrix).multiply(inverse).toArray(this.carry, 16 * j));
    const { carry, joints, weights } = this;
    const { positions, normals } = this.rest;
    const position = this.mesh.geometry.getAttribute("position"), normal = this.mesh.geometry.getAttribute("normal");
    const outP = position.array as Float32Array, outN = normal.array as Float32Array;
    for (let v = 0, i = 0; v < positions.length; v += 3, i += 4) {
      const x = positions[v]!, y = positions[v + 1]!, z = positions[v + 2]!, a = normals[v]!, b = normals[v + 1]!, c = normals[v + 2]!;
      let px = 0, py = 0, pz = 0, nx = 0, ny = 0, nz = 0;
      for (let k = i; k < i + 4; ++k) {
        const w = weights[k]!;
        if (w === 0) continue;
        const m = 16 * joints[k]!;
        px += w * (carry[m]! * x + carry[m + 4]! * y + carry[m + 8]! * z + carry[m + 12]!);
        py += w * (carry[m + 1]! * x + carry[m + 5]! * y + carry[m + 9]! * z + carry[m + 13]!);
        pz += w * (carry[m + 2]! * x + carry[m + 6]! * y + carry[m + 10]! * z + carry[m + 14]!);
        nx += w * (carry[m]! * a + carry[m + 4]! * b + carry[m + 8]! * c);
        ny += w * (carry[m + 1]! * a + carry[m + 5]! * b + carry[m + 9]! * c);
        nz += w * (carry[m + 2]! * a + carry[m + 6]! * b + carry[m + 10]! * c);
      }
      outP[v] = px; outP[v + 1] = py; outP[v + 2] = pz;
      outN[v] = nx; outN[v + 1] = ny; outN[v + 2] = nz;
    }
    position.needsUpdate = normal.needsUpdate = true;
  }
}

export class Hands {
  readonly group = new Group();
  private readonly material: ShaderMaterial;
  private readonly through: ShaderMaterial;
  private readonly figures: HandFigure[];
  private opaque = false;

  constructor(maps: FieldMaps) {
    const common = { vertexShader: kVertexShader, fragmentShader: kFragmentShader, transparent: true, premultipliedAlpha: true };
    const uniforms = (fieldOnly: number) => ({
      ...maps.uniforms,
      skinColour: { value: new Color() }, shadeColour: { value: new Color() }, rimColour: { value: new Color() },
      opacity: { value: 1 }, fieldOnly: { value: fieldOnly },
    });
    this.material = new ShaderMaterial({ ...common, uniforms: uniforms(0), side: FrontSide });
    this.through = new ShaderMaterial({ ...common, uniforms: uniforms(0.85), side: DoubleSide, depthFunc: GreaterDepth, depthWrite: false });
    this.figures = [0, 1].map(() => new HandFigure(this.material, this.through));
    for (const f of this.figures) this.group.add(f.mesh, f.through);
  }

  set(hands: Hand[]): void {
    this.figures.forEach((figure, i) => figure.set(hands[i], this.opaque));
  }
  setOpacity(opacity: number): void {
    this.material.uniforms.opacity!.value = opacity;
    this.opaque = opacity > 0.98;
  }
  setDark(dark: boolean): void {
    const u = this.material.uniforms;
    (u.skinColour!.value as Color).set(dark ? "#dfa98a" : "#eebfa0");
    (u.shadeColour!.value as Color).set(dark ? "#3a1f22" : "#a0625a");
    (u.rimColour!.value as Color).set(dark ? "#4a6a92" : "#5c4038");
  }
}
