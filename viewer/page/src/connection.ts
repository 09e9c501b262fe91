import { ProtocolError } from "./byte_reader";
import { decode, encodeHello, type Scene, type ServerMessage } from "./protocol";

export type LinkState = "connecting" | "live" | "lost" | "refused";

export interface LinkListener {
  message(message: ServerMessage, bytes: number): void;
  /** @param detail for a person; empty: the state says it all */
  state(state: LinkState, detail: string): void;
}

const FIRST_PAUSE_MS = 250;
const LONGEST_PAUSE_MS = 3000;
const POLICY = 1008;

/** The WebSocket to the server, opened anew whenever it is lost. */
export class Connection {
  private socket: WebSocket | null = null;
  private scene: Scene | null = null;
  private pauseMs = FIRST_PAUSE_MS;

  /**
   * @param token what the server asks for off the loopback address; stands behind # in the page's address
   * @param onlyLooksOn nothing that this viewer asks for shall be done
   */
  constructor(
    private readonly url: string,
    private readonly token: string,
    private readonly onlyLooksOn: boolean,
    private readonly listener: LinkListener,
  ) {}

  open(): void {
    this.listener.state("connecting", "");
    this.scene = null;
    const socket = new WebSocket(this.url);
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => socket.send(encodeHello(this.token, this.onlyLooksOn));
    socket.onmessage = (event: MessageEvent<ArrayBuffer>) => this.take(event.data);
    socket.onclose = (event) => this.closed(event.code);
  }

  /** Nothing is kept for later: without a connection it is lost. */
  send(message: ArrayBuffer): void {
    if (this.scene !== null) this.socket?.send(message);
  }

  private take(bytes: ArrayBuffer): void {
    try {
      const message = decode(bytes, this.scene);
      if (message.kind === "scene") {
        this.scene = message;
        this.pauseMs = FIRST_PAUSE_MS;
        this.listener.state("live", "");
      }
      this.listener.message(message, bytes.byteLength);
    } catch (error) {
      if (!(error instanceof ProtocolError)) throw error;
      this.listener.state("refused", error.message);
      this.drop();
    }
  }

  /** For good. */
  private drop(): void {
    if (this.socket === null) return;
    this.socket.onclose = null;
    this.socket.close();
    this.socket = null;
  }

  private closed(code: number): void {
    this.scene = null;
    if (code === POLICY) {
      this.socket = null;
      this.listener.state("refused", "the server asks for a token: open the link that ends in #token=…");
      return;
    }
    this.listener.state("lost", "");
    setTimeout(() => this.open(), this.pauseMs);
    this.pauseMs = Math.min(2 * this.pauseMs, LONGEST_PAUSE_MS);
  }
}

/** Sums over the last second. */
export class RateMeter {
  private readonly events: { at: number; amount: number }[] = [];
  private sum = 0;

  add(amount: number, now: number): void {
    this.events.push({ at: now, amount });
    this.sum += amount;
  }
  perSecond(now: number): number {
    while (this.events.length > 0 && this.events[0]!.at < now - 1000) this.sum -= this.events.shift()!.amount;
    return this.sum;
  }
}
