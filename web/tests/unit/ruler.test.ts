import { Frustum, Matrix4, PerspectiveCamera, Vector3, type LineSegments } from "three";
import { describe, expect, it } from "vitest";
import type { Hello } from "../../src/messages";
import { readable } from "../../src/scene/label";
import { Ruler } from "../../src/scene/ruler";

const ruler = new Ruler();
const upright = ruler.group.children[0] as LineSegments;
// like a picture drawn before the program has sent anything
upright.geometry.computeBoundingSphere();
ruler.set({ box_mm: { origin: [-180, -180, 0], edge: 360 } } as unknown as Hello);

/// A camera at this distance from the middle of the scene [m] and this elevation [degrees], as in the page's views.
function eye(aspect: number, azimuth = -32, elevation = 38, distance = 0.7): PerspectiveCamera {
  const camera = new PerspectiveCamera(34, aspect, 0.02, 6);
  const far = distance * Math.max(1, 0.95 / aspect), [a, e] = [(azimuth * Math.PI) / 180, (elevation * Math.PI) / 180];
  camera.up.set(0, 0, 1);
  const middle = elevation > 0 ? 0.125 : 0.2;
  camera.position.set(far * Math.cos(e) * Math.sin(a), -far * Math.cos(e) * Math.cos(a), middle + far * Math.sin(e));
  camera.lookAt(0, 0, middle);
  camera.updateMatrixWorld();
  return camera;
}
const at = (camera: PerspectiveCamera, width: number, text: string): Vector3 =>
  ruler.update(camera, width).find((label) => label.text === text)!.at.clone();

describe("the ruler", () => {
  // as in windows 390, 1024, 1440 and 1920 pixels wide
  it.each([[0.86, 375], [1.74, 772], [1.09, 684], [1.18, 1010]])("stands at the left of a picture %f times as wide as high", (aspect, width) => {
    const camera = eye(aspect);
    for (const text of ["0", "100", "200"]) {
      const { x, y } = at(camera, width, text).project(camera);
      expect(x).toBeLessThan(-0.5);
      expect(((x + 1) * width) / 2).toBeGreaterThan(44);
      expect(Math.abs(y)).toBeLessThan(0.87);
    }
  });
  it("is on an edge of the box if that is in the picture", () => {
    const place = at(eye(2.5), 1500, "0");
    expect([place.x, place.y, place.z]).toEqual([expect.closeTo(-0.18), expect.closeTo(0.18), 0]);
  });
  it("follows a box that follows a hand", () => {
    const moved = new Ruler();
    moved.set({ box_mm: { origin: [-80, -80, 0], edge: 160 } } as unknown as Hello);
    moved.placeBox(new Vector3(0.02, 0.04, 0.09), 0.16);
    const labels = moved.update(eye(2.5), 1500);
    expect(labels.map((label) => label.text)).toEqual(["0", "100", "200 mm", "x · 160 mm", "y · 160 mm"]);
    expect(labels[3]!.at.z).toBeCloseTo(0.09);
    expect(labels[3]!.at.x).toBeCloseTo(0.10);
  });
  it("is to the left of a palm that is seen from below, too", () => {
    const camera = eye(0.86, -18, -34, 0.46);
    expect(at(camera, 375, "200").project(camera).x).toBeLessThan(-0.5);
  });
  it("is drawn", () => {
    const camera = eye(1.2);
    ruler.update(camera, 800);
    ruler.group.updateMatrixWorld(true);
    const seen = new Frustum().setFromProjectionMatrix(new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    expect(seen.intersectsObject(upright)).toBe(true);
  });
  it("is upright from any direction", () => {
    for (let azimuth = 0; azimuth < 360; azimuth += 30) {
      const camera = eye(1.2, azimuth), [low, high] = ["0", "100"].map((text) => at(camera, 800, text));
      expect(high!.clone().sub(low!).distanceTo(new Vector3(0, 0, 0.1))).toBeLessThan(1e-9);
      expect(low!.project(camera).x).toBeLessThan(-0.4);
    }
  });
});

describe("a text in the picture", () => {
  const box = (left: number, top: number) => ({ left, right: left + 40, top, bottom: top + 12 });
  const picture = { left: 10, right: 400, top: 10, bottom: 300 }, button = { left: 100, right: 160, top: 20, bottom: 50 };
  it.each([[10, 10, true], [200, 200, true], [60, 30, true], [5, 30, false], [370, 30, false], [200, 290, false], [70, 30, false], [110, 45, false]])(
    "at %i, %i can be read: %s", (left, top, seen) => expect(readable(box(left, top), picture, [button])).toBe(seen));
});
