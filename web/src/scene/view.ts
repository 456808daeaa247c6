/// The three-dimensional picture: array and box at the back, hands and paths in front, and the smoke.

import {
  BufferGeometry, Color, DepthTexture, DirectionalLight, Float32BufferAttribute, GLSL3, HalfFloatType, HemisphereLight,
  LinearFilter, Matrix4, Mesh, OrthographicCamera, Raycaster, RawShaderMaterial, Scene, UnsignedIntType, Vector2,
  Vector3, WebGLRenderer, WebGLRenderTarget, type Texture,
} from "three";
import type { Hello } from "../messages";
import type { Frame } from "../wire";
import { ArrayModel } from "./array_model";
import { OrbitCamera } from "./camera";
import { FieldMaps, type FieldMode } from "./field_maps";
import { Hands } from "./hands";
import { Labels } from "./labels";
import { Pace } from "./pace";
import { Paths } from "./paths";
import { pick, type Hit } from "./pick";
import { freeMaterial, freeResources } from "./resources";
import { Ruler } from "./ruler";
import { kScreenVertex, SmokeVolume } from "./smoke";
import { kTogether } from "./together";

function target(): WebGLRenderTarget {
  const linear = { minFilter: LinearFilter, magFilter: LinearFilter } as const;
  const made = new WebGLRenderTarget(1, 1, { type: HalfFloatType, ...linear });
  made.depthTexture = new DepthTexture(1, 1, UnsignedIntType);
  return made;
}

const kContext: WebGLContextAttributes = { alpha: false, antialias: false, powerPreference: "high-performance" };

/// State of the graphics context, which the browser may take away at any time, or not have at all.
export type Graphics = "ready" | "lost" | "none";

/// Smallest and largest share of the screen's pixels along a side; times per picture above which the share is lowered,
/// and below which it is raised [ms].
const kQuality = {
  graphics: { least: 0.6, most: 1, slow: 66, fast: 30 }, processor: { least: 0.35, most: 0.8, slow: 90, fast: 45 },
};

export interface Speed {
  framesPerSecond: number;
  pixelRatio: number;
}

export class View {
  readonly eye: OrbitCamera;
  readonly array = new ArrayModel();
  readonly maps = new FieldMaps();
  readonly hands = new Hands(this.maps);
  readonly paths = new Paths();
  readonly smoke = new SmokeVolume();
  readonly ruler = new Ruler();
  pace = new Pace(false);
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
  private quality = 1; // fraction of the screen's pixels along a side
  private steps = 56;
  private readonly labels = new Labels();
  private field: Frame["field"] = [];
  software = false; // whether the processor draws
  graphics: Graphics = "none";
  private gl: WebGL2RenderingContext | null = null;
  private renderer: WebGLRenderer | null = null;
  private fence: WebGLSync | null = null;
  private drawn = -Infinity; // when ready() last allowed a picture [ms]
  private begun = 0; // when its drawing began [ms]
  showSmoke = true;
  private smokeKnown = false; // whether the frame shown has smoke

  private unhurried = false;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.backTarget = target();
    this.handTarget = target();
    this.smokeTarget = new WebGLRenderTarget(1, 1, {
      type: HalfFloatType, count: 2, depthBuffer: false, minFilter: LinearFilter, magFilter: LinearFilter,
    });
    this.smoke.material.uniforms.backDepth!.value = this.backTarget.depthTexture;
    this.smoke.material.uniforms.handDepth!.value = this.handTarget.depthTexture;
    const image = (t: Texture | null | undefined) => ({ value: t ?? null });
    this.together = new RawShaderMaterial({
      glslVersion: GLSL3, vertexShader: kScreenVertex, fragmentShader: kTogether, depthTest: false, depthWrite: false,
      uniforms: {
        back: image(this.backTarget.texture), backDepth: image(this.backTarget.depthTexture),
        hand: image(this.handTarget.texture), handDepth: image(this.handTarget.depthTexture),
        before: image(this.smokeTarget.textures[0]), behind: image(this.smokeTarget.textures[1]),
        middleColour: { value: new Color() }, outerColour: { value: new Color() },
        aspect: { value: 1 }, smoke: { value: 0 },
      },
    });

    this.screen.geometry.setAttribute("position", new Float32BufferAttribute([-1, -1, 0, 3, -1, 0, -1, 3, 0], 3));
    this.screen.frustumCulled = false;
    this.screenScene.add(this.screen);
    const key = new DirectionalLight("#ffffff", 1.9);
    key.position.set(-0.45, -0.55, 0.85);
    this.backScene.add(this.array.group, this.ruler.group, key, new HemisphereLight("#ffffff", "#8090a8", 1.1));
    this.handScene.add(this.hands.group, this.paths.group);
    this.eye = new OrbitCamera(canvas);
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault(); // otherwise the browser does not restore it
      this.lose();
    });
    canvas.addEventListener("webglcontextrestored", () => this.begin());
    this.begin();
  }

  /// Starts drawing once the browser provides a context, at first and after a loss.
  begin(): void {
    if (this.renderer !== null) return;
    this.gl ??= this.canvas.getContext("webgl2", kContext);
    this.graphics = this.gl === null ? "none" : "lost";
    if (this.gl === null || this.gl.isContextLost()) return;
    const info = this.gl.getExtension("WEBGL_debug_renderer_info");
    const name = info === null ? "" : String(this.gl.getParameter(info.UNMASKED_RENDERER_WEBGL));
    this.software = /swiftshader|llvmpipe|software/i.test(name);
    this.pace = new Pace(this.software);
    this.setUnhurried(this.unhurried);
    try {
      this.renderer = new WebGLRenderer({ canvas: this.canvas, context: this.gl });
      this.renderer.autoClear = false;
      this.graphics = "ready";
    } catch (error) {
      if (this.gl.isContextLost()) return; // lost in the meantime
      this.graphics = "none";
      console.error(error);
    }
  }

  /// Drops all resources of a lost context: a new one does not have them.
  private lose(): void {
    this.graphics = "lost";
    this.fence = null;
    for (const scene of [this.backScene, this.handScene]) freeResources(scene);
    for (const material of [this.smoke.material, this.together]) freeMaterial(material);
    for (const texture of this.maps.textures) texture.dispose();
    for (const target of [this.backTarget, this.handTarget, this.smokeTarget]) target.dispose();
    this.screen.geometry.dispose();
    this.renderer?.dispose();
    this.renderer = null;
  }

  setHello(hello: Hello): void {
    this.array.set(hello);
    this.ruler.set(hello);
  }

  setFrame(frame: Frame): void {
    this.hands.set(frame.hands);
    this.ruler.setHand(frame.hands[0]);
    this.field = frame.field;
    this.smokeKnown = frame.smoke !== null;
    this.paths.set(frame.plan);
    if (frame.smoke !== null && frame.smokeSequence !== this.smokeSequence) {
      this.smoke.set(frame.smoke);
      const corner = new Vector3(...frame.smoke.corner);
      for (const part of [this.array, this.ruler]) part.placeBox(corner, frame.smoke.edge);
    }
    if (frame.fieldSequence !== this.fieldSequence) this.maps.set(frame.field);
    this.smokeSequence = frame.smokeSequence;
    this.fieldSequence = frame.fieldSequence;
  }

  setField(mode: FieldMode): void { this.maps.setMode(mode); }

  setDark(dark: boolean): void {
    for (const part of [this.array, this.ruler, this.hands, this.paths, this.smoke, this.maps]) part.setDark(dark);
    (this.together.uniforms.middleColour!.value as Color).set(dark ? "#16202f" : "#ffffff");
    (this.together.uniforms.outerColour!.value as Color).set(dark ? "#080c13" : "#e3e9f1");
  }

  /// The skin seen at a position of the page, as the program computes with it.
  skinAt(clientX: number, clientY: number): Hit | null {
    const box = this.canvas.getBoundingClientRect();
    const x = (2 * (clientX - box.left)) / box.width - 1, y = 1 - (2 * (clientY - box.top)) / box.height;
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2(x, y), this.eye.camera);
    return pick(this.field, caster.ray.origin, caster.ray.direction);
  }

  /// Whether the next picture may be drawn: the previous one is finished, and was allowed `interval` [ms] ago.
  ready(now: number, interval: number): boolean {
    const { gl } = this;
    if (gl === null || this.graphics !== "ready" || gl.isContextLost()) return false;
    if (this.fence !== null) {
      if (gl.getSyncParameter(this.fence, gl.SYNC_STATUS) !== gl.SIGNALED) return false;
      gl.deleteSync(this.fence);
      this.fence = null;
      this.pace.drew(performance.now() - this.begun);
    }
    if (!this.unhurried && now - this.drawn < interval) return false;
    this.drawn = now;
    return true;
  }

  /// Draws the next picture, dt seconds after the previous one.
  render(dt: number): void {
    const { gl, renderer } = this;
    if (gl === null || renderer === null) return;
    this.begun = performance.now();
    this.keepPace(dt);
    this.resize(renderer);
    const { width, height } = this.backTarget;
    this.eye.update(dt, width / height);
    this.labels.show(this.ruler.update(this.eye.camera, this.canvas.clientWidth), this.eye.camera, this.canvas);
    this.paths.advance(dt);
    const camera = this.eye.camera;

    renderer.setClearColor(0x000000, 0);
    renderer.setRenderTarget(this.backTarget);
    renderer.clear();
    renderer.render(this.backScene, camera);
    renderer.setRenderTarget(this.handTarget);
    renderer.clear();
    renderer.render(this.handScene, camera);

    const smoky = this.showSmoke && this.smokeKnown && this.smoke.visible;
    if (smoky) {
      const u = this.smoke.material.uniforms;
      (u.toWorld!.value as Matrix4).multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).invert();
      (u.eye!.value as Vector3).copy(camera.position);
      u.steps!.value = this.steps;
      renderer.setRenderTarget(this.smokeTarget);
      this.draw(renderer, this.smoke.material);
    }
    this.together.uniforms.smoke!.value = smoky ? 1 : 0;
    this.together.uniforms.aspect!.value = width / height;
    renderer.setRenderTarget(null);
    this.draw(renderer, this.together);
    if (this.fence === null) this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
  }

  /// Draws later pictures with all their pixels, however long it takes, or again as time permits.
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

  private draw(renderer: WebGLRenderer, material: RawShaderMaterial): void {
    this.screen.material = material;
    renderer.render(this.screenScene, this.screenCamera);
  }

  private resize(renderer: WebGLRenderer): void {
    const scale = Math.min(2, window.devicePixelRatio || 1) * this.quality;
    const pixels = (length: number) => Math.max(2, Math.round(length * scale));
    const width = pixels(this.canvas.clientWidth), height = pixels(this.canvas.clientHeight);
    this.speed.pixelRatio = scale;
    if (this.backTarget.width === width && this.backTarget.height === height && this.canvas.width === width) return;
    renderer.setSize(width, height, false);
    for (const t of [this.backTarget, this.handTarget]) t.setSize(width, height);
    const coarse = this.software && !this.unhurried ? 3 : 2;
    this.smokeTarget.setSize(Math.ceil(width / coarse), Math.ceil(height / coarse));
    this.paths.setViewport(width, height, scale);
  }

  /// Reduces pixels and ray steps if pictures take too long, and raises them if there is time.
  private keepPace(dt: number): void {
    if (dt <= 0 || this.unhurried) return;
    const { speed, pace } = this;
    speed.framesPerSecond = speed.framesPerSecond === 0 ? 1 / dt : 0.9 * speed.framesPerSecond + 0.1 / dt;
    const { least, most, slow, fast } = kQuality[this.software ? "processor" : "graphics"];
    if (pace.measured && pace.cost > slow && this.quality > least) this.setQuality(Math.max(least, this.quality - 0.1));
    if (pace.measured && pace.cost < fast && this.quality < most) this.setQuality(Math.min(most, this.quality + 0.1));
  }
  private setQuality(quality: number): void {
    this.quality = quality;
    this.steps = Math.round(this.software && !this.unhurried ? 20 * quality + 6 : 56 * quality);
    this.pace.measureAnew();
  }
}
