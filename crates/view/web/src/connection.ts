// The connection to the world: comes back by itself when it was lost.

import { decode, SUBPROTOCOL } from "./protocol";
import type { Binary, Document, Wish } from "./protocol";

export type Message = Document | Binary;
export type Link = "connecting" | "open" | "lost";

const RETRY_MS = 1000;

export class Connection {
  private socket: WebSocket | null = null;

  constructor(
    private readonly receive: (message: Message) => void,
    private readonly changed: (link: Link) => void,
  ) {
    this.open();
  }

  send(wish: Wish): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(wish));
  }

  private open(): void {
    this.changed("connecting");
    const url = new URL("socket", location.href);
    url.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    // the token, where there is one
    url.search = location.search;
    const socket = new WebSocket(url, SUBPROTOCOL);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.changed("open");
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => {
      const { data } = event;
      const message = typeof data === "string" ? (JSON.parse(data) as Document) : decode(data);
      if (message) this.receive(message);
    };
    socket.onclose = () => {
      this.socket = null;
      this.changed("lost");
      setTimeout(() => this.open(), RETRY_MS);
    };
    this.socket = socket;
  }
}
