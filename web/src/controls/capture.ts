/// Screenshots (PNG) and films (WebM) of the page.

import { find } from "../dom";
import { offer, stamp } from "./download";
import { compose, type PictureSource } from "./picture";
import { tip } from "./tips";

export class Capture {
  private recorder: MediaRecorder | null = null;
  private readonly film = find<HTMLButtonElement>("film");

  constructor(source: PictureSource, private readonly say: (sentence: string) => void) {
    find("screenshot").addEventListener("click", () => {
      compose(source).toBlob((data) => {
        if (data === null) say("This browser could not make a picture.");
        else offer(data, `prostm-${stamp()}.png`);
      }, "image/png");
    });
    const types = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"];
    const type = typeof MediaRecorder === "undefined" ? undefined : types.find((t) => MediaRecorder.isTypeSupported(t));
    if (type === undefined || !("captureStream" in source.canvas)) {
      this.film.disabled = true;
      this.film.after(tip("Record", "This browser cannot record films of the picture (it lacks MediaRecorder with WebM)."));
      return;
    }
    this.film.addEventListener("click", () => {
      if (this.recorder === null) this.begin(source.canvas, type);
      else this.recorder.stop();
    });
  }

  private begin(canvas: HTMLCanvasElement, type: string): void {
    const recorder = new MediaRecorder(canvas.captureStream(30), { mimeType: type, videoBitsPerSecond: 12e6 });
    const parts: Blob[] = [];
    recorder.ondataavailable = (event) => parts.push(event.data);
    recorder.onstop = () => {
      this.recorder = null;
      this.show(false);
      offer(new Blob(parts, { type }), `prostm-${stamp()}.webm`);
    };
    recorder.onerror = () => this.say("The film could not be recorded.");
    recorder.start(1000);
    this.recorder = recorder;
    this.show(true);
  }
  private show(recording: boolean): void {
    this.film.setAttribute("aria-pressed", String(recording));
    this.film.lastChild!.textContent = recording ? "Stop" : "Record";
  }
}
