/// Noise that masks the sound of the array: the same all the time that a stimulus may come, so that it tells nothing.

const kSeconds = 8, kHighest = 8000, kLevel = 0.25, kFade = 0.1; // of the loop [s]; cut-off [Hz]; of 1; [s]

export class Noise {
  private context: AudioContext | null = null;
  private gain: GainNode | null = null;

  /// Whether it can be heard when it is wanted: a browser lets a page sound only once somebody has pressed something.
  get ready(): boolean { return this.context?.state === "running"; }

  /// Called by a press.
  async begin(): Promise<void> {
    if (this.context !== null) return this.context.resume();
    const context = this.context = new AudioContext();
    const buffer = context.createBuffer(1, kSeconds * context.sampleRate, context.sampleRate);
    const samples = buffer.getChannelData(0);
    for (let i = 0; i < samples.length; ++i) samples[i] = 2 * Math.random() - 1;
    const source = new AudioBufferSourceNode(context, { buffer, loop: true });
    this.gain = new GainNode(context, { gain: 0 });
    source.connect(new BiquadFilterNode(context, { type: "lowpass", frequency: kHighest })).connect(this.gain).connect(context.destination);
    source.start();
    await context.resume();
  }

  play(on: boolean): void {
    if (this.context === null || this.gain === null) return;
    this.gain.gain.setTargetAtTime(on ? kLevel : 0, this.context.currentTime, kFade / 3);
  }
}
