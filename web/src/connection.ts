/// The WebSocket to the program: keeps the newest messages, and reconnects when the connection is lost.

import { parseMessage, type Hello, type PageMessage, type State } from "./messages";
import type { Study } from "./study/messages";
import { Decoder, WireError, type Frame } from "./wire";

export type Link = "connecting" | "open" | "lost";

export interface Listeners {
  frame(frame: Frame): void;
  hello(hello: Hello): void;
  state(state: State): void;
  study?(study: Study): void; // only in a study
  error(sentence: string, control?: string): void;
  /// `sentence`: shown on the page; "" when all is well
  link(link: Link, sentence: string): void;
}

const kFirstWait = 250, kLongestWait = 4000; // [ms]

export class Connection {
  frame: Frame | null = null;
  hello: Hello | null = null;
  state: State | null = null;
  frames = 0; // decoded since the page was opened
  refused = 0; // frames that could not be decoded
  opened = 0; // connections since the page was opened
  private socket: WebSocket | null = null;
  private wait = kFirstWait;
  private rate = 30;

  constructor(private readonly address: string, private readonly listeners: Listeners) {}

  open(): void {
    const decoder = new Decoder();
    const socket = new WebSocket(this.address);
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    if (this.opened === 0) this.listeners.link("connecting", "Connecting to the program…");
    socket.onopen = () => {
      ++this.opened;
      this.wait = kFirstWait;
      this.listeners.link("open", "");
      this.sendRate();
    };
    socket.onmessage = (event: MessageEvent<ArrayBuffer | string>) => {
      if (typeof event.data === "string") this.readText(event.data);
      else this.readFrame(decoder, event.data);
    };
    socket.onclose = () => {
      if (this.socket !== socket) return;
      this.socket = null;
      const seconds = this.wait / 1000;
      const again = seconds < 1 ? "at once" : `in ${seconds} s`;
      this.listeners.link("lost", `The program does not answer; what you see has stopped. Trying again ${again}…`);
      window.setTimeout(() => this.open(), this.wait);
      this.wait = Math.min(kLongestWait, 2 * this.wait);
    };
  }

  get isOpen(): boolean { return this.socket?.readyState === WebSocket.OPEN; }

  /// @return whether the message was sent.
  send(message: PageMessage): boolean {
    if (!this.isOpen) return false;
    this.socket?.send(JSON.stringify(message));
    return true;
  }

  /// Frame rate that this page requests while it is visible [Hz].
  setRate(hz: number): void {
    if (hz === this.rate) return;
    this.rate = hz;
    this.sendRate();
  }
  /// A hidden page requests one frame a second.
  sendRate(): void { this.send({ type: "rate", hz: document.hidden ? 1 : this.rate }); }

  private readFrame(decoder: Decoder, data: ArrayBuffer): void {
    try {
      this.frame = decoder.decode(data);
    } catch (error) {
      if (!(error instanceof WireError)) throw error;
      ++this.refused;
      this.listeners.link("open", `A frame was not read: ${error.message}.`);
      return;
    }
    ++this.frames;
    this.listeners.frame(this.frame);
  }

  private readText(text: string): void {
    const message = parseMessage(text);
    if (message?.type === "hello") {
      this.hello = message;
      this.listeners.hello(message);
    } else if (message?.type === "state") {
      this.state = message;
      this.listeners.state(message);
    } else if (message?.type === "study") {
      this.listeners.study?.(message);
    } else if (message?.type === "error") {
      this.listeners.error(message.sentence, message.id);
    }
  }
}
