/// Noise that masks the array's sound. It is the same whenever a stimulus may come, so that it reveals nothing.

const kSeconds = 8, kHighest = 8000, kLevel = 0.25, kFade = 0.1; // loop [s]; cut-off [Hz]; amplitude; fade [s]

const kMeasured = 0.02; // output rms above which the noise counts as playing; at kLevel it is 0.08
const kStands = 200; // time without progress after which the audio clock has stopped [ms]

export class Noise {
  private context: AudioContext | null = null;
  private gain: GainNode | null = null;
  private analyser: AnalyserNode | null = null;
  private wanted = false; // as set by play(), possibly before there is audio
  private readonly samples = new Float32Array(2048);
  private moved = { audio: 0, at: -Infinity }; // audio clock [s], and when it last advanced [ms]

  /// @param changed called when the browser starts or stops the audio.
  constructor(private readonly changed: () => void) {}

  /// "off": browsers allow sound only after the user has pressed something. "playing" is measured in the page's output;
  /// the volume of the computer is unknown.
  get state(): "off" | "silent" | "playing" {
    const { context, analyser, moved, samples } = this;
    if (context?.state !== "running" || analyser === null) return "off";
    const now = performance.now();
    if (context.currentTime > moved.audio) this.moved = { audio: context.currentTime, at: now };
    else if (now - moved.at > kStands) return "silent";
    analyser.getFloatTimeDomainData(samples);
    let squares = 0;
    for (const sample of samples) squares += sample * sample;
    return Math.sqrt(squares / samples.length) > kMeasured ? "playing" : "silent";
  }

  /// Starts the audio; to be called from a click.
  async begin(): Promise<void> {
    if (this.context !== null) return this.context.resume();
    const context = this.context = new AudioContext();
    const buffer = context.createBuffer(1, kSeconds * context.sampleRate, context.sampleRate);
    const samples = buffer.getChannelData(0);
    for (let i = 0; i < samples.length; ++i) samples[i] = 2 * Math.random() - 1;
    const source = new AudioBufferSourceNode(context, { buffer, loop: true });
    this.gain = new GainNode(context, { gain: 0 });
    this.analyser = new AnalyserNode(context, { fftSize: this.samples.length });
    source.connect(new BiquadFilterNode(context, { type: "lowpass", frequency: kHighest })).connect(this.gain).connect(this.analyser);
    this.analyser.connect(context.destination);
    context.addEventListener("statechange", this.changed);
    source.start();
    this.play(this.wanted);
    await context.resume();
  }

  play(on: boolean): void {
    this.wanted = on;
    if (this.context === null || this.gain === null) return;
    this.gain.gain.setTargetAtTime(on ? kLevel : 0, this.context.currentTime, kFade / 3);
  }
}
