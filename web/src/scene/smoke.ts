/// The smoke as a lit volume, ray-marched into two images: the smoke in front of the hands, and behind them.

import { Color, Data3DTexture, GLSL3, LinearFilter, Matrix4, RawShaderMaterial, RGFormat, UnsignedByteType, Vector3, type Texture } from "three";
import type { Smoke } from "../wire";

export const kScreenVertex = /* glsl */ `
in vec3 position;
out vec2 uv;
void main() {
  uv = 0.5 * position.xy + 0.5;
  gl_Position = vec4(position.xy, 0.0, 1.0);
}`;

const kFragment = /* glsl */ `
precision highp float;
precision highp sampler3D;
in vec2 uv;
layout(location = 0) out vec4 before;
layout(location = 1) out vec4 behind;
uniform sampler3D smoke;
uniform sampler2D backDepth, handDepth;
uniform mat4 toWorld;
uniform vec3 eye, corner, litColour, shadeColour;
uniform float edge, extinction;
uniform int steps;

vec3 unproject(vec2 at, float depth) {
  vec4 p = toWorld * vec4(2.0 * at - 1.0, 2.0 * depth - 1.0, 1.0);
  return p.xyz / p.w;
}
float noise(vec2 p) { return fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715)))); }

void main() {
  before = behind = vec4(0.0);
  vec3 far = unproject(uv, 1.0);
  vec3 ray = normalize(far - eye);
  vec3 a = (corner - eye) / ray, b = (corner + edge - eye) / ray;
  vec3 low = min(a, b), high = max(a, b);
  float from = max(0.0, max(low.x, max(low.y, low.z)));
  float to = min(high.x, min(high.y, high.z));
  to = min(to, distance(eye, unproject(uv, texture(backDepth, uv).r)));
  if (to <= from) return;
  float hand = distance(eye, unproject(uv, texture(handDepth, uv).r));

  float dt = (to - from) / float(steps);
  dt = max(dt, edge / 160.0);
  float t = from + dt * noise(gl_FragCoord.xy);
  vec4 sum = vec4(0.0);
  bool passed = false;
  for (int i = 0; i < 128; ++i) {
    if (i >= steps || t >= to || sum.a > 0.985) break;
    if (!passed && t >= hand) { before = sum; sum = vec4(0.0); passed = true; }
    vec3 at = (eye + t * ray - corner) / edge;
    vec2 s = texture(smoke, at).rg;
    // fades out at the walls of the box
    vec3 margin = smoothstep(vec3(0.0), vec3(0.05), at) * smoothstep(vec3(0.0), vec3(0.05), 1.0 - at);
    float density = s.r * margin.x * margin.y * smoothstep(0.0, 0.12, 1.0 - at.z);
    float alpha = 1.0 - exp(-extinction * density * dt);
    vec3 colour = mix(shadeColour, litColour, s.g);
    sum += (1.0 - sum.a) * alpha * vec4(colour, 1.0);
    t += dt;
  }
  if (passed) behind = sum; else before = sum;
}`;

/// Light that reaches each cell from above and from the side, 0 to 255.
function light(smoke: Smoke, lightOf: Float32Array): void {
  const { n, density } = smoke;
  const slice = n * n;
  const opacity = (14 * smoke.edge) / n; // opacity of a full cell, towards the light
  for (let z = n - 1; z >= 0; --z) for (let y = 0; y < n; ++y) for (let x = 0; x < n; ++x) {
    let above = 1;
    if (z + 1 < n) {
      // the light comes from the upper left front: half a cell sideways per cell up
      const x0 = Math.max(0, x - 1), y0 = Math.max(0, y - 1);
      const up = (z + 1) * slice;
      above = 0;
      for (const [i, j] of [[x, y], [x0, y], [x, y0], [x0, y0]] as const) {
        const c = up + j * n + i;
        above += 0.25 * lightOf[c]! * Math.exp((-opacity * density[c]!) / 255);
      }
    }
    lightOf[z * slice + y * n + x] = above;
  }
}

export class SmokeVolume {
  readonly material = new RawShaderMaterial({
    glslVersion: GLSL3, vertexShader: kScreenVertex, fragmentShader: kFragment, depthTest: false, depthWrite: false,
    uniforms: {
      smoke: { value: null as Data3DTexture | null }, backDepth: { value: null as Texture | null }, handDepth: { value: null as Texture | null },
      toWorld: { value: new Matrix4() }, eye: { value: new Vector3() }, corner: { value: new Vector3() }, edge: { value: 1 },
      litColour: { value: new Color() }, shadeColour: { value: new Color() }, extinction: { value: 30 }, steps: { value: 48 },
    },
  });
  private lightOf = new Float32Array(0);
  private texture: Data3DTexture | null = null;
  visible = false;

  set(smoke: Smoke): void {
    const cells = smoke.n ** 3;
    if (this.texture === null || this.texture.image.width !== smoke.n) {
      this.texture?.dispose();
      this.texture = new Data3DTexture(new Uint8Array(2 * cells), smoke.n, smoke.n, smoke.n);
      this.texture.format = RGFormat;
      this.texture.type = UnsignedByteType;
      this.texture.minFilter = this.texture.magFilter = LinearFilter;
      this.texture.unpackAlignment = 1;
      this.material.uniforms.smoke!.value = this.texture;
      this.lightOf = new Float32Array(cells);
    }
    light(smoke, this.lightOf);
    const data = this.texture.image.data as Uint8Array;
    for (let i = 0; i < cells; ++i) {
      data[2 * i] = smoke.density[i]!;
      data[2 * i + 1] = 255 * this.lightOf[i]!;
    }
    this.texture.needsUpdate = true;
    (this.material.uniforms.corner!.value as Vector3).set(...smoke.corner);
    this.material.uniforms.edge!.value = smoke.edge;
    this.visible = true;
  }

  setDark(dark: boolean): void {
    const u = this.material.uniforms;
    (u.litColour!.value as Color).set(dark ? "#a9c1e8" : "#8ea3c6");
    (u.shadeColour!.value as Color).set(dark ? "#1b2c52" : "#3d5684");
    u.extinction!.value = dark ? 11 : 15;
  }
}
