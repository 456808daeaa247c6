/// The picture in three dimensions: array and box behind, hands and paths before them, smoke between and around, put together at the end.

import {
  BufferGeometry, Color, DepthTexture, DirectionalLight, Float32BufferAttribute, GLSL3, HalfFloatType, HemisphereLight, LinearFilter, Matrix4, Mesh, OrthographicCamera, Raycaster, RawShaderMaterial,
  Scene, UnsignedIntType, Vector2, Vector3, WebGLRenderer, WebGLRenderTarget, type Texture,
} from "three";
import type { Frame } from "../wire";
import { ArrayModel } from "./array_model";
import { OrbitCamera } from "./camera";
import { FieldMaps, type FieldMode } from "./field_maps";
import { Hands } from "./hands";
import { Paths } from "./paths";
import { kScreenVertex, SmokeVolume } from "./smoke";

const kTogether = /* glsl */ `
precision highp float;
in vec2 uv;
out vec4 colour;
uniform sampler2D back, backDepth, hand, handDepth, before, behind;
uniform vec3 middleColour, outerColour;
uniform float aspect, smoke;
vec3 encoded(vec3 x) { return mix(12.92 * x, 1.055 * pow(max(x, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x)); }
float noise(vec2 p) { return fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715)))); }
void main() {
  float r = length((uv - vec2(0.5, 0.54)) * vec2(aspect, 1.0));
  vec3 c = mix(middleColour, outerColour, smoothstep(0.0, 0.85, r));
  vec4 b = texture(back, uv), h = texture(hand, uv);
  // seen from under the array, the hand shows through it
  if (texture(backDepth, uv).r < texture(handDepth, uv).r) h *= 0.8;
  c = c * (1.0 - b.a) + b.rgb;
  if (smoke > 0.0) { vec4 s = texture(behind, uv); c = c * (1.0 - s.a) + s.rgb; }
  c = c * (1.0 - h.a) + h.rgb;
  // smoke before the hand veils it a little, and never hides what is on it
  if (smoke > 0.0) { vec4 s = texture(before, uv) * mix(1.0, 0.45, clamp(h.a, 0.0, 1.0)); c = c * (1.0 - s.a) + s.rgb; }
  colour = vec4(encoded(c) + (noise(gl_FragCoord.xy) - 0.5) / 255.0, 1.0);
}`;

function target(samples: number): WebGLRenderTarget {
  const made = new WebGLRenderTarget(1, 1, { type: HalfFloatType, samples, minFilter: LinearFilter, magFilter: LinearFilter });
  made.depthTexture = new DepthTexture(1, 1, UnsignedIntType);
  return made;
}

const kSoftwareInterval = 80; // between pictures that the processor draws [ms]

export interface Speed {
  framesPerSecond: number;
  pixelRatio: number;
}

export class View {
  readonly renderer: WebGLRenderer;
  readonly eye: OrbitCamera;
  readonly array = new ArrayModel();
  readonly maps = new FieldMaps();
  readonly hands = new Hands(this.maps);
  readonly paths = new Paths();
  readonly smoke = new SmokeVolume();
  readonly speed: Speed = { framesPerSecond: 0, pixelRatio: 1 };

  private readonly backScene = new Scene();
  private readonly handScene = new Scene();
  private readonly screen = new Mesh(new BufferGeometry());
  private readonly screenScene = new Scene();
  private readonly screenCamera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
  private readonly backTarget: WebGLRenderTarget;
  private readonly handTarget: WebGLRenderTarget;
  private readonly smokeTarget: WebGLRenderTarget;
  private readonly together: RawShaderMaterial;
  private smokeSequence = -1;
  private fieldSequence = -1;
  private quality = 1; // share of the screen's pixels along a side
  private steps = 56;
  private slow = 0; // [s], smoothed time of a frame
  private readonly software: boolean;
  private fence: WebGLSync | null = null;
  private drawn = -Infinity; // when a picture was last allowed [ms]
  showSmoke = true;

  private unhurried = false;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: false, alpha: false, powerPreference: "high-performance" });
    this.renderer.autoClear = false;
    const gl = this.renderer.getContext();
    const info = gl.getExtension("WEBGL_debug_renderer_info");
    const name = info === null ? "" : String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL));
    this.software = /swiftshader|llvmpipe|software/i.test(name);
    if (this.software) this.setQuality(0.6);
    const samples = this.software ? 0 : 4;
    this.backTarget = target(samples);
    this.handTarget = target(samples);
    this.smokeTarget = new WebGLRenderTarget(1, 1, { type: HalfFloatType, count: 2, depthBuffer: false, minFilter: LinearFilter, magFilter: LinearFilter });
    this.smoke.material.uniforms.backDepth!.value = this.backTarget.depthTexture;
    this.smoke.material.uniforms.handDepth!.value = this.handTarget.depthTexture;
    const image = (t: Texture | null | undefined) => ({ value: t ?? null });
    this.together = new RawShaderMaterial({
      glslVersion: GLSL3, vertexShader: kScreenVertex, fragmentShader: kTogether, depthTest: false, depthWrite: false,
      uniforms: {
        back: image(this.backTarget.texture), backDepth: image(this.backTarget.depthTexture), hand: image(this.handTarget.texture), handDepth: image(this.handTarget.depthTexture),
        before: image(this.smokeTarget.textures[0]), behind: image(this.smokeTarget.textures[1]),
        middleColour: { value: new Color() }, outerColour: { value: new Color() }, aspect: { value: 1 }, smoke: { value: 0 },
      },
    });

    this.screen.geometry.setAttribute("position", new Float32BufferAttribute([-1, -1, 0, 3, -1, 0, -1, 3, 0], 3));
    this.screen.frustumCulled = false;
    this.screenScene.add(this.screen);
    const key = new DirectionalLight("#ffffff", 1.9);
    key.position.set(-0.45, -0.55, 0.85);
    this.backScene.add(this.array.group, key, new HemisphereLight("#ffffff", "#8090a8", 1.1));
    this.handScene.add(this.hands.group, this.paths.group);
    this.eye = new OrbitCamera(canvas);
  }

  setFrame(frame: Frame): void {
    this.hands.set(frame.hands);
    this.paths.set(frame.plan);
    if (frame.smoke !== null && frame.smokeSequence !== this.smokeSequence) this.smoke.set(frame.smoke);
    if (frame.fieldSequence !== this.fieldSequence) this.maps.set(frame.field);
    this.smokeSequence = frame.smokeSequence;
    this.fieldSequence = frame.fieldSequence;
  }

  setField(mode: FieldMode): void { this.maps.setMode(mode); }

  setDark(dark: boolean): void {
    for (const part of [this.array, this.hands, this.paths, this.smoke, this.maps]) part.setDark(dark);
    (this.together.uniforms.middleColour!.value as Color).set(dark ? "#16202f" : "#ffffff");
    (this.together.uniforms.outerColour!.value as Color).set(dark ? "#080c13" : "#e3e9f1");
  }

  /// Where the ray through a place of the picture meets the horizontal plane at height z, in D [m].
  pointAt(clientX: number, clientY: number, z: number): Vector3 | null {
    const box = this.canvas.getBoundingClientRect();
    const at = new Vector2((2 * (clientX - box.left)) / box.width - 1, 1 - (2 * (clientY - box.top)) / box.height);
    const ray = new Raycaster();
    ray.setFromCamera(at, this.eye.camera);
    const { origin, direction } = ray.ray;
    const t = (z - origin.z) / direction.z;
    return Number.isFinite(t) && t > 0 ? origin.clone().addScaledVector(direction, t) : null;
  }

  /// Whether the next picture may be drawn: where pictures take long, no others are heaped upon them, and where the processor draws
  /// them it has other things to do, the run itself among them.
  ready(now: number): boolean {
    if (this.software && !this.unhurried && now - this.drawn < kSoftwareInterval) return false;
    if (this.fence === null) return this.allow(now);
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    if (gl.getSyncParameter(this.fence, gl.SYNC_STATUS) !== gl.SIGNALED) return false;
    gl.deleteSync(this.fence);
    this.fence = null;
    return this.allow(now);
  }
  private allow(now: number): true {
    this.drawn = now;
    return true;
  }

  /// Draws the next picture, dt seconds after the one before.
  render(dt: number): void {
    this.keepPace(dt);
    this.resize();
    const { width, height } = this.backTarget;
    this.eye.update(dt, width / height);
    this.paths.advance(dt);
    const { renderer } = this;
    const camera = this.eye.camera;

    renderer.setClearColor(0x000000, 0);
    renderer.setRenderTarget(this.backTarget);
    renderer.clear();
    renderer.render(this.backScene, camera);
    renderer.setRenderTarget(this.handTarget);
    renderer.clear();
    renderer.render(this.handScene, camera);

    const smoky = this.showSmoke && this.smoke.visible;
    if (smoky) {
      const u = this.smoke.material.uniforms;
      (u.toWorld!.value as Matrix4).multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).invert();
      (u.eye!.value as Vector3).copy(camera.position);
      u.steps!.value = this.steps;
      renderer.setRenderTarget(this.smokeTarget);
      this.draw(this.smoke.material);
    }
    this.together.uniforms.smoke!.value = smoky ? 1 : 0;
    this.together.uniforms.aspect!.value = width / height;
    renderer.setRenderTarget(null);
    this.draw(this.together);
    const gl = renderer.getContext() as WebGL2RenderingContext;
    if (this.fence === null) this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
  }

  /// From now on pictures are drawn with all their pixels, however long that takes, or as well as there is time for.
  setUnhurried(unhurried: boolean): void {
    this.unhurried = unhurried;
    this.setQuality(unhurried || !this.software ? 1 : 0.6);
    for (const t of [this.backTarget, this.handTarget]) {
      t.samples = unhurried || !this.software ? 4 : 0;
      t.dispose();
    }
  }

  /// Draws one picture with all its pixels.
  renderWell(): void {
    const { quality, steps, unhurried } = this;
    this.unhurried = true;
    this.setQuality(1);
    this.render(0);
    [this.quality, this.steps, this.unhurried] = [quality, steps, unhurried];
  }

  private draw(material: RawShaderMaterial): void {
    this.screen.material = material;
    this.renderer.render(this.screenScene, this.screenCamera);
  }

  private resize(): void {
    const scale = Math.min(2, window.devicePixelRatio || 1) * this.quality;
    const width = Math.max(2, Math.round(this.canvas.clientWidth * scale)), height = Math.max(2, Math.round(this.canvas.clientHeight * scale));
    this.speed.pixelRatio = scale;
    if (this.backTarget.width === width && this.backTarget.height === height && this.canvas.width === width) return;
    this.renderer.setSize(width, height, false);
    for (const t of [this.backTarget, this.handTarget]) t.setSize(width, height);
    const coarse = this.software && !this.unhurried ? 3 : 2;
    this.smokeTarget.setSize(Math.ceil(width / coarse), Math.ceil(height / coarse));
    this.paths.setViewport(width, height, scale);
  }

  /// Fewer pixels and shorter marches where pictures take too long, and more again where there is time.
  private keepPace(dt: number): void {
    if (dt <= 0 || this.unhurried) return;
    const time = Math.min(dt, 1);
    this.slow = this.slow === 0 ? time : 0.9 * this.slow + 0.1 * time;
    this.speed.framesPerSecond = 1 / this.slow;
    const lowest = this.software ? 0.4 : 0.6, highest = this.software ? 0.8 : 1;
    const enough = this.software ? kSoftwareInterval / 1000 + 0.02 : 1 / 45;
    if (this.slow > Math.max(1 / 15, 1.5 * enough) && this.quality > lowest) this.setQuality(Math.max(lowest, this.quality - 0.1));
    else if (this.slow < enough && this.quality < highest) this.setQuality(Math.min(highest, this.quality + 0.1));
  }
  private setQuality(quality: number): void {
    this.quality = quality;
    this.steps = Math.round(this.software && !this.unhurried ? 20 * quality + 6 : 56 * quality);
    this.slow = this.software ? 0.12 : 1 / 25; // measure anew
  }
}
