/// The field of each hand as a texture, and the shader code that lays it on the skin.

import { ClampToEdgeWrapping, DataTexture, DataUtils, HalfFloatType, LinearFilter, Matrix4, RGBAFormat, SRGBColorSpace, UnsignedByteType, Vector2, Vector4 } from "three";
import { kDifferenceTables, kFieldTable } from "../colours";
import type { Patch } from "../wire";

export const kFieldModes = ["none", "target", "rendered", "difference"] as const;
export type FieldMode = (typeof kFieldModes)[number];
const kMaps = 2;

function colourTexture(table: Uint8ClampedArray): DataTexture {
  const texture = new DataTexture(new Uint8Array(table), 256, 1, RGBAFormat, UnsignedByteType);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

const half = DataUtils.toHalfFloat.bind(DataUtils);

/// Target, rendered and height are premultiplied by the skin mask, so that interpolation at an edge can divide by it.
function fill(texture: DataTexture, patch: Patch): DataTexture {
  const cells = patch.rows * patch.cols;
  let map = texture;
  if (map.image.width !== patch.cols || map.image.height !== patch.rows) {
    map.dispose();
    map = emptyMap(patch.cols, patch.rows);
  }
  const data = map.image.data as unknown as Uint16Array;
  const one = half(1);
  for (let i = 0; i < cells; ++i) {
    const skin = patch.skin[i] !== 0;
    data[4 * i] = skin ? half(patch.target[i]! / 65535) : 0;
    data[4 * i + 1] = skin ? half(patch.rendered[i]! / 65535) : 0;
    data[4 * i + 2] = skin ? half(patch.height[i]! * patch.heightScale * 10) : 0; // in units of 0.1 m
    data[4 * i + 3] = skin ? one : 0;
  }
  map.needsUpdate = true;
  return map;
}

function emptyMap(cols: number, rows: number): DataTexture {
  const map = new DataTexture(new Uint16Array(4 * cols * rows) as unknown as Uint8Array, cols, rows, RGBAFormat, HalfFloatType);
  map.minFilter = map.magFilter = LinearFilter;
  map.wrapS = map.wrapT = ClampToEdgeWrapping;
  map.needsUpdate = true;
  return map;
}

export class FieldMaps {
  private readonly maps = Array.from({ length: kMaps }, () => emptyMap(1, 1));
  private readonly difference = { light: colourTexture(kDifferenceTables.light), dark: colourTexture(kDifferenceTables.dark) };

  readonly uniforms = {
    fieldMap0: { value: this.maps[0]! },
    fieldMap1: { value: this.maps[1]! },
    X_PD: { value: Array.from({ length: kMaps }, () => new Matrix4()) },
    fieldGrid: { value: Array.from({ length: kMaps }, () => new Vector4()) }, // x, y of the first cell's centre, cell [m], scale [Pa]
    fieldSize: { value: Array.from({ length: kMaps }, () => new Vector2()) },
    fieldCount: { value: 0 },
    fieldMode: { value: 0 },
    fieldMax: { value: 1 }, // [Pa]
    fieldColours: { value: colourTexture(kFieldTable) },
    differenceColours: { value: this.difference.light },
  };

  get textures(): DataTexture[] { return [...this.maps, this.difference.light, this.difference.dark]; }

  set(field: Patch[]): void {
    const u = this.uniforms;
    u.fieldCount.value = Math.min(kMaps, field.length);
    field.slice(0, kMaps).forEach((patch, k) => {
      this.maps[k] = fill(this.maps[k]!, patch);
      const m = patch.pose;
      u.X_PD.value[k]!.set(m[0]!, m[1]!, m[2]!, m[3]!, m[4]!, m[5]!, m[6]!, m[7]!, m[8]!, m[9]!, m[10]!, m[11]!, 0, 0, 0, 1).invert();
      u.fieldGrid.value[k]!.set(patch.centre[0], patch.centre[1], patch.cell, patch.scale);
      u.fieldSize.value[k]!.set(patch.cols, patch.rows);
    });
    u.fieldMap0.value = this.maps[0]!;
    u.fieldMap1.value = this.maps[1]!;
  }
  setMode(mode: FieldMode): void { this.uniforms.fieldMode.value = kFieldModes.indexOf(mode); }
  setMax(pressure: number): void { this.uniforms.fieldMax.value = Math.max(pressure, 1e-9); }
  setDark(dark: boolean): void { this.uniforms.differenceColours.value = dark ? this.difference.dark : this.difference.light; }
}

/// vec4 fieldColour(position in D, normal): the field's colour there, and its opacity.
export const kFieldShader = /* glsl */ `
uniform sampler2D fieldMap0, fieldMap1, fieldColours, differenceColours;
uniform mat4 X_PD[2];
uniform vec4 fieldGrid[2];
uniform vec2 fieldSize[2];
uniform int fieldCount, fieldMode;
uniform float fieldMax;

vec4 fieldOf(sampler2D map, mat4 X, vec4 grid, vec2 size, vec3 p, vec3 n) {
  vec3 p_P = (X * vec4(p, 1.0)).xyz;
  vec2 uv = ((p_P.xy - grid.xy) / grid.z + 0.5) / size;
  if (any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) return vec4(0.0);
  vec4 cell = texture(map, uv);
  if (cell.a < 0.02) return vec4(0.0);
  vec3 value = cell.rgb / cell.a;
  float away = abs(p_P.z - 0.1 * value.b);
  float facing = -normalize(mat3(X) * n).z;
  float share = smoothstep(0.3, 0.6, cell.a) * smoothstep(0.016, 0.009, away) * smoothstep(-0.15, 0.2, facing);
  float target = value.r * grid.w / fieldMax, rendered = value.g * grid.w / fieldMax;
  float t = fieldMode == 3 ? 0.5 + 0.5 * (rendered - target) : fieldMode == 2 ? rendered : target;
  // where the pressure is close to zero the skin shows
  share *= fieldMode == 3 ? smoothstep(0.005, 0.04, abs(rendered - target)) : smoothstep(0.01, 0.07, t);
  vec2 at = vec2((clamp(t, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5);
  return vec4(fieldMode == 3 ? texture(differenceColours, at).rgb : texture(fieldColours, at).rgb, share);
}

vec4 fieldColour(vec3 p, vec3 n) {
  if (fieldMode == 0 || fieldCount == 0) return vec4(0.0);
  vec4 colour = fieldOf(fieldMap0, X_PD[0], fieldGrid[0], fieldSize[0], p, n);
  if (fieldCount > 1) {
    vec4 other = fieldOf(fieldMap1, X_PD[1], fieldGrid[1], fieldSize[1], p, n);
    if (other.a > colour.a) colour = other;
  }
  return colour;
}
`;
