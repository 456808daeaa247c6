/// The array with all transducers, the box of the smoke, the marks for calibration, and the point below the page's hand.

import {
  BoxGeometry, BufferGeometry, CircleGeometry, Color, CylinderGeometry, EdgesGeometry, Float32BufferAttribute, Group, InstancedMesh, Line, LineBasicMaterial, LineSegments,
  Matrix4, Mesh, MeshBasicMaterial, MeshStandardMaterial, RingGeometry, Vector3,
} from "three";
import type { Calibration, Hello } from "../messages";

export class ArrayModel {
  readonly group = new Group();
  private readonly board = new MeshStandardMaterial({ roughness: 0.85, metalness: 0.1 });
  private readonly can = new MeshStandardMaterial({ roughness: 0.45, metalness: 0.55 });
  private readonly face = new MeshStandardMaterial({ roughness: 0.9, metalness: 0.2 });
  private readonly edges = new LineBasicMaterial({ transparent: true, opacity: 0.35, depthWrite: false });
  private readonly box = new LineSegments(new BufferGeometry(), this.edges);
  private readonly parts = new Group();
  private readonly marks = new Group();
  private readonly plumb = new Group();
  private readonly plumbLine = new BufferGeometry();
  private readonly accent = new MeshBasicMaterial({ color: "#e69f00", transparent: true });
  private readonly done = new MeshBasicMaterial({ color: "#009e73" });
  private readonly waiting = new MeshBasicMaterial({ color: "#8a93a0" });

  constructor() {
    const ring = new Mesh(new RingGeometry(0.008, 0.0105, 40), this.accent);
    ring.position.z = 0.001;
    this.plumbLine.setAttribute("position", new Float32BufferAttribute([0, 0, 0, 0, 0, 1], 3));
    this.plumb.add(ring, new Line(this.plumbLine, new LineBasicMaterial({ color: "#e69f00" })));
    this.plumb.visible = false;
    this.group.add(this.box, this.parts, this.marks, this.plumb);
  }

  set(hello: Hello): void {
    this.parts.clear();
    const at = hello.array.transducers_mm.map(([x, y, z]) => new Vector3(x, y, z).divideScalar(1000));
    if (at.length > 0) this.addTransducers(at);
    const { origin, edge } = hello.box_mm;
    this.box.geometry.dispose();
    this.box.geometry = new EdgesGeometry(new BoxGeometry(edge / 1000, edge / 1000, edge / 1000));
    this.placeBox(new Vector3(...origin).divideScalar(1000), edge / 1000);
  }

  /// Moves the box, which may follow a hand. @param corner its smallest coordinates [m].  @param edge its edge [m].
  placeBox(corner: Vector3, edge: number): void { this.box.position.copy(corner).addScalar(edge / 2); }

  private addTransducers(at: Vector3[]): void {
    // as wide as their spacing allows, at most their true 10 mm
    let spacing = 0.0106;
    for (const p of at.slice(1)) spacing = Math.min(spacing, p.distanceTo(at[0]!));
    const radius = 0.465 * spacing, tall = 0.005;
    const cans = new InstancedMesh(new CylinderGeometry(radius, radius, tall, 28, 1, true).rotateX(Math.PI / 2), this.can, at.length);
    const rims = new InstancedMesh(new RingGeometry(0.8 * radius, radius, 28), this.can, at.length);
    const faces = new InstancedMesh(new CircleGeometry(0.82 * radius, 28), this.face, at.length);
    const place = new Matrix4();
    const low = new Vector3(Infinity, Infinity, Infinity), high = new Vector3(-Infinity, -Infinity, -Infinity);
    at.forEach((p, i) => {
      cans.setMatrixAt(i, place.makeTranslation(p.x, p.y, p.z - tall / 2));
      rims.setMatrixAt(i, place.makeTranslation(p.x, p.y, p.z));
      faces.setMatrixAt(i, place.makeTranslation(p.x, p.y, p.z - 0.0006));
      low.min(p);
      high.max(p);
    });
    const margin = 0.009;
    const board = new Mesh(new BoxGeometry(high.x - low.x + 2 * margin, high.y - low.y + 2 * margin, 0.008), this.board);
    board.position.set((low.x + high.x) / 2, (low.y + high.y) / 2, low.z - tall - 0.003);
    this.parts.add(cans, rims, faces, board);
  }

  setCalibration(calibration: Calibration | null): void {
    this.marks.clear();
    if (calibration === null) return;
    const current = calibration.marks.findIndex((m) => !m.taken);
    calibration.marks.forEach((mark, i) => {
      const material = mark.taken ? this.done : i === current ? this.accent : this.waiting;
      const disc = new Mesh(new CircleGeometry(0.003, 24), material);
      const ring = new Mesh(new RingGeometry(i === current ? 0.0085 : 0.006, i === current ? 0.011 : 0.0072, 40), material);
      for (const part of [disc, ring]) {
        part.position.set(...mark.p_mm).divideScalar(1000);
        part.position.z += 0.002;
        this.marks.add(part);
      }
      if (i !== current) return;
      const pin = new Mesh(new CylinderGeometry(0.0006, 0.0006, 0.06, 8).rotateX(Math.PI / 2), material);
      pin.position.copy(disc.position).add(new Vector3(0, 0, 0.03));
      this.marks.add(pin);
    });
  }

  /// Marks the point straight below the palm of the page's hand, or none.
  setPlumb(palm: Vector3 | null): void {
    this.plumb.visible = palm !== null;
    if (palm === null) return;
    this.plumb.position.set(palm.x, palm.y, 0);
    this.plumbLine.attributes.position!.setZ(1, palm.z);
    this.plumbLine.attributes.position!.needsUpdate = true;
  }

  setDark(dark: boolean): void {
    this.board.color = new Color(dark ? "#1c2430" : "#3a4250");
    this.can.color = new Color(dark ? "#7f8ba0" : "#c3cad4");
    this.face.color = new Color(dark ? "#2c3645" : "#59626f");
    this.edges.color = new Color(dark ? "#6f86a8" : "#8592a6");
  }
}
