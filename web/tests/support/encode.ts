/// Frames as the program encodes them, made here from plain values.
import type { Gate, Hand, Patch, Path, Run, Smoke } from "../../src/wire";

export interface Contents {
  sequence?: number;
  version?: number;
  run?: Partial<Run>;
  numbers?: number[];
  hands?: Hand[];
  smoke?: Smoke;
  field?: Patch[];
  plan?: Path[];
  gate?: Gate;
  unknown?: number; // size of a section that no page knows
}

class Writer {
  private readonly parts: Uint8Array[] = [];
  length = 0;
  bytes(part: Uint8Array): this {
    this.parts.push(part);
    this.length += part.byteLength;
    return this;
  }
  array(values: ArrayBufferView): this { return this.bytes(new Uint8Array(values.buffer.slice(values.byteOffset, values.byteOffset + values.byteLength) as ArrayBuffer)); }
  u16(...v: number[]): this { return this.array(Uint16Array.from(v)); }
  u32(...v: number[]): this { return this.array(Uint32Array.from(v)); }
  f32(...v: number[]): this { return this.array(Float32Array.from(v)); }
  f64(...v: number[]): this { return this.array(Float64Array.from(v)); }
  pad(): this { return this.bytes(new Uint8Array((8 - (this.length % 8)) % 8)); }
  done(): Uint8Array {
    const all = new Uint8Array(this.length);
    let at = 0;
    for (const part of this.parts) {
      all.set(part, at);
      at += part.byteLength;
    }
    return all;
  }
}

export function encode(contents: Contents): ArrayBuffer {
  const sections: Uint8Array[] = [];
  const section = (id: number, count: number, fill: (w: Writer) => void) => {
    const body = new Writer();
    fill(body);
    const bytes = body.done();
    sections.push(new Writer().u16(id, count).u32(bytes.byteLength).bytes(bytes).pad().done());
  };

  const run = contents.run ?? {};
  const flags = (run.paused ? 1 : 0) | (run.pageHand ? 2 : 0) | (run.handInSight ? 4 : 0) | (run.fading ? 8 : 0) |
    (run.muted ? 16 : 0) | (run.calibrating ? 32 : 0) | (run.hot ? 64 : 0) | (run.deviceLost ? 128 : 0);
  section(1, 1, (w) => w.f64(run.time ?? 0, run.recordingTime ?? NaN).u32(run.worldSteps ?? 0, run.planUpdates ?? 0, flags, 0));
  if (contents.unknown !== undefined) section(99, 3, (w) => w.bytes(new Uint8Array(contents.unknown ?? 0)));
  if (contents.numbers) section(2, contents.numbers.length, (w) => w.f32(...(contents.numbers ?? [])));
  const { hands, smoke, field, plan, gate } = contents;
  if (hands) {
    section(3, hands.length, (w) => {
      for (const h of hands) w.u32(h.id, h.side === "left" ? 0 : 1).f32(h.confidence).u32(0).array(h.joints).u32(0, 0, 0, 0);
    });
  }
  if (smoke) section(4, 1, (w) => w.u32(smoke.n).f32(...smoke.corner, smoke.edge).u32(0).array(smoke.density));
  if (field) {
    section(5, field.length, (w) => {
      for (const p of field) {
        w.u32(p.rows, p.cols).f32(p.cell, ...p.centre).array(p.pose).f32(p.scale, p.heightScale).u32(0);
        w.array(p.target).array(p.rendered).array(p.height).array(p.skin).pad();
      }
    });
  }
  if (plan) {
    section(6, plan.length, (w) => {
      for (const p of plan) w.u32(p.kind === "path" ? 0 : 1, p.patch, p.count).f32(p.length, p.speed, p.period, p.loop, p.phase).array(p.points);
    });
  }
  if (gate) {
    section(7, 1, (w) => {
      w.u32(gate.passed ? 1 : 0).f32(gate.share).u32(gate.maxima).f32(gate.balance, gate.saddle, gate.area, gate.force);
      for (const text of [gate.problem, gate.sentence]) {
        const bytes = new TextEncoder().encode(text);
        w.u32(bytes.length).bytes(bytes);
      }
    });
  }

  const length = 16 + sections.reduce((sum, s) => sum + s.byteLength, 0);
  const message = new Writer().bytes(new TextEncoder().encode("PSTM")).u16(contents.version ?? 2, sections.length).u32(contents.sequence ?? 0, length);
  for (const s of sections) message.bytes(s);
  return message.done().buffer as ArrayBuffer;
}
