/// The decoder of the binary frames, docs/reference/wire.md. It trusts no input: every length is checked before it is
/// used.

export const kVersion = 2;
export const kJoints = 26;

/// The order of section 2. New entries are only appended.
export const kNumbers = [
  "track_ms", "hand_ms", "world_ms", "contact_ms", "plan_ms", "lift_ms", "step_ms",
  "world_hz", "plan_hz",
  "latency_ms", "latency_p50_ms", "latency_p99_ms", "latency_max_ms",
  "blocks", "late_blocks", "missed_blocks", "queue_blocks",
  "rmse", "correlation", "coverage", "skill_0", "skill_8", "overlap", "spill",
  "max_target_pa", "full_scale_pa",
  "laps_completed", "tracker_age_ms", "intensity", "saturated", "sigma_mm",
  "setting_sigma_mm", "setting_rmse", "setting_correlation", "felt_skill",
  "force_mn", "smoke_mn", "movement_mn", "sensation_level",
] as const;
export type NumberName = (typeof kNumbers)[number];

export interface Run {
  time: number; // [s]
  recordingTime: number; // [s], NaN without a recording
  worldSteps: number;
  planUpdates: number;
  paused: boolean;
  pageHand: boolean;
  handInSight: boolean;
  fading: boolean;
  muted: boolean; // by a page or in the terminal
  calibrating: boolean; // in a calibration, which also mutes it
  hot: boolean; // the device is too hot, which also mutes it
  deviceLost: boolean; // the link to the device is lost
}

export interface Hand {
  id: number;
  side: "left" | "right";
  confidence: number;
  /// 26 × 8: position in D [m], quaternion x, y, z, w, radius [m]
  joints: Float32Array;
}

export interface Smoke {
  n: number;
  corner: [number, number, number]; // smallest coordinates, in D [m]
  edge: number; // edge of the box [m]
  density: Uint8Array; // n³, x fastest
}

/// A target plane P with the target and the rendered field.
export interface Patch {
  rows: number;
  cols: number;
  cell: number; // [m]
  centre: [number, number]; // centre of cell (0, 0) in P [m]
  pose: Float32Array; // X_DP, rows of its upper 3 × 4 matrix
  scale: number; // pressure of 65535 [Pa]
  heightScale: number; // height of 1 [m]
  target: Uint16Array;
  rendered: Uint16Array;
  height: Int16Array;
  skin: Uint8Array;
}

export interface Path {
  kind: "path" | "focus";
  patch: number;
  length: number; // in the plane [m]
  speed: number; // [m/s]
  period: number; // [s]
  loop: number; // common period of all paths [s]; 0: each has its own
  phase: number; // delay of a focus' modulation, as a fraction of its period
  count: number;
  /// count × 6: x, y in P [m], rendered pressure [Pa], position on the skin in D [m]
  points: Float32Array;
}

/// The verdict of a study's gate on the target shown.
export interface Gate {
  passed: boolean;
  share: number; // fraction of the last second's frames without a problem
  maxima: number;
  balance: number;
  saddle: number;
  area: number; // [m²]
  force: number; // [N]
  problem: string; // its name
  sentence: string;
}

export interface Frame {
  sequence: number;
  bytes: number;
  run: Run;
  numbers: Float32Array;
  hands: Hand[];
  /// the newest smoke and field, and the sequence numbers of the frames that brought them
  smoke: Smoke | null;
  smokeSequence: number;
  field: Patch[];
  fieldSequence: number;
  plan: Path[];
  gate: Gate | null; // null if the run has no gate
}

export function numberOf(frame: Frame, name: NumberName): number {
  return frame.numbers[kNumbers.indexOf(name)] ?? NaN;
}

/// Why a message could not be decoded, as a sentence for the user.
export class WireError extends Error {}

const kLargestMessage = 16 << 20;
const kLargestSide = 1024; // cells along a side of a patch, at most

function require(holds: boolean, sentence: string): asserts holds {
  if (!holds) throw new WireError(sentence);
}

/// A part of a message that is read from front to back, never beyond its end.
class Reader {
  private readonly view: DataView;
  private at: number;

  constructor(private readonly buffer: ArrayBuffer, begin: number, private readonly end: number, private readonly what: string) {
    this.view = new DataView(buffer);
    this.at = begin;
  }

  take(bytes: number): number {
    require(bytes >= 0 && this.at + bytes <= this.end, `the ${this.what} of the frame ends too early`);
    const begin = this.at;
    this.at += bytes;
    return begin;
  }
  u32(): number { return this.view.getUint32(this.take(4), true); }
  f32(): number { return this.view.getFloat32(this.take(4), true); }
  f64(): number { return this.view.getFloat64(this.take(8), true); }
  /// Reads a finite number; others would spoil a drawing.
  finite(): number {
    const value = this.f32();
    require(Number.isFinite(value), `the ${this.what} of the frame holds a number that is not finite`);
    return value;
  }
  floats(count: number): Float32Array {
    const begin = this.take(4 * count);
    return new Float32Array(this.buffer.slice(begin, begin + 4 * count));
  }
  finiteFloats(count: number): Float32Array {
    const values = this.floats(count);
    require(values.every(Number.isFinite), `the ${this.what} of the frame holds a number that is not finite`);
    return values;
  }
  bytes(count: number): ArrayBuffer {
    const begin = this.take(count);
    return this.buffer.slice(begin, begin + count);
  }
  text(): string {
    return new TextDecoder().decode(this.bytes(this.u32()));
  }
  align(begin: number): void {
    this.take((8 - ((this.at - begin) % 8)) % 8);
  }
  get position(): number { return this.at; }
}

function readRun(reader: Reader): Run {
  const run = {
    time: reader.f64(),
    recordingTime: reader.f64(),
    worldSteps: reader.u32(),
    planUpdates: reader.u32(),
  };
  const flags = reader.u32();
  const flag = (bit: number) => (flags & bit) !== 0;
  return {
    ...run, paused: flag(1), pageHand: flag(2), handInSight: flag(4), fading: flag(8), muted: flag(16),
    calibrating: flag(32), hot: flag(64), deviceLost: flag(128),
  };
}

function readHand(reader: Reader): Hand {
  const id = reader.u32();
  const side = reader.u32() === 0 ? "left" : "right";
  const confidence = reader.f32();
  reader.u32();
  const joints = reader.finiteFloats(8 * kJoints);
  reader.take(16);
  return { id, side, confidence, joints };
}

function readSmoke(reader: Reader): Smoke {
  const n = reader.u32();
  require(n >= 1 && n <= 256, `the smoke of the frame claims ${n} cells along an edge`);
  const corner: Smoke["corner"] = [reader.finite(), reader.finite(), reader.finite()];
  const edge = reader.finite();
  require(edge > 0, "the smoke of the frame has a box without size");
  reader.u32();
  return { n, corner, edge, density: new Uint8Array(reader.bytes(n * n * n)) };
}

function readPatch(reader: Reader): Patch {
  const begin = reader.position;
  const rows = reader.u32();
  const cols = reader.u32();
  require(rows >= 1 && cols >= 1 && rows <= kLargestSide && cols <= kLargestSide, `the field of the frame claims ${rows} × ${cols} cells`);
  const cell = reader.finite();
  require(cell > 0, "the field of the frame has cells without size");
  const centre: Patch["centre"] = [reader.finite(), reader.finite()];
  const pose = reader.finiteFloats(12);
  const scale = reader.finite();
  const heightScale = reader.finite();
  reader.u32();
  const cells = rows * cols;
  const patch: Patch = {
    rows, cols, cell, centre, pose, scale, heightScale,
    target: new Uint16Array(reader.bytes(2 * cells)),
    rendered: new Uint16Array(reader.bytes(2 * cells)),
    height: new Int16Array(reader.bytes(2 * cells)),
    skin: new Uint8Array(reader.bytes(cells)),
  };
  reader.align(begin);
  return patch;
}

function readPath(reader: Reader): Path {
  const kind = reader.u32() === 0 ? "path" : "focus";
  const patch = reader.u32();
  const count = reader.u32();
  const length = reader.f32();
  const speed = reader.f32();
  const period = reader.f32();
  const loop = reader.finite();
  const phase = reader.finite();
  return { kind, patch, count, length, speed, period, loop, phase, points: reader.finiteFloats(6 * count) };
}

function readGate(reader: Reader): Gate {
  return {
    passed: reader.u32() !== 0, share: reader.finite(), maxima: reader.u32(), balance: reader.finite(),
    saddle: reader.finite(), area: reader.finite(), force: reader.finite(), problem: reader.text(), sentence: reader.text(),
  };
}

function readEach<T>(count: number, read: () => T): T[] {
  const all: T[] = [];
  for (let i = 0; i < count; ++i) all.push(read());
  return all;
}

/// Decodes the messages of one connection, in order: the large sections are sent only when they change.
export class Decoder {
  private smoke: Smoke | null = null;
  private smokeSequence = -1;
  private field: Patch[] = [];
  private fieldSequence = -1;

  /// Throws a WireError, and keeps the present state, if the message is not one whole frame of this version.
  decode(message: ArrayBuffer): Frame {
    require(message.byteLength >= 16, "a frame is shorter than its header");
    require(message.byteLength <= kLargestMessage, "a frame is longer than allowed");
    const view = new DataView(message);
    require(view.getUint32(0, true) === 0x4d545350, "a message is not a frame");
    const version = view.getUint16(4, true);
    require(version === kVersion, `the program speaks version ${version} of the wire and this page version ${kVersion}; reload the page`);
    require(view.getUint32(12, true) === message.byteLength, "a frame is not as long as its header states");

    const sequence = view.getUint32(8, true);
    let run: Run | null = null;
    let numbers: Float32Array = new Float32Array(0);
    let hands: Hand[] = [];
    let plan: Path[] = [];
    let gate: Gate | null = null;
    let smoke: Smoke | null = null;
    let field: Patch[] | null = null;

    let at = 16;
    for (let section = view.getUint16(6, true); section > 0; --section) {
      require(at + 8 <= message.byteLength, "a frame holds fewer sections than its header states");
      const id = view.getUint16(at, true);
      const count = view.getUint16(at + 2, true);
      const end = at + 8 + view.getUint32(at + 4, true);
      require(end <= message.byteLength, "a section is longer than its frame");
      const reader = (what: string) => new Reader(message, at + 8, end, what);
      if (id === 1) {
        run = readRun(reader("run"));
      } else if (id === 2) {
        numbers = reader("numbers").floats(count);
      } else if (id === 3) {
        const from = reader("hands");
        hands = readEach(count, () => readHand(from));
      } else if (id === 4) {
        smoke = readSmoke(reader("smoke"));
      } else if (id === 5) {
        const from = reader("field");
        field = readEach(count, () => readPatch(from));
      } else if (id === 6) {
        const from = reader("plan");
        plan = readEach(count, () => readPath(from));
      } else if (id === 7 && count > 0) {
        gate = readGate(reader("gate"));
      }
      at = end + ((8 - (end % 8)) % 8);
    }
    require(run !== null, "a frame has no section about the run");

    // only a whole frame changes the state
    if (smoke !== null) [this.smoke, this.smokeSequence] = [smoke, sequence];
    if (field !== null) [this.field, this.fieldSequence] = [field, sequence];
    return {
      sequence, bytes: message.byteLength, run, numbers, hands, plan, gate,
      smoke: this.smoke, smokeSequence: this.smokeSequence,
      field: this.field, fieldSequence: this.fieldSequence,
    };
  }
}
