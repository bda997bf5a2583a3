// The connection to the world: comes back by itself when it was lost.

import { decode, SUBPROTOCOL } from "./protocol";
import type { Binary, Document, Wish } from "./protocol";

export type Message = Document | Binary;
export type Link = "connecting" | "open" | "lost";

const RETRY_MS = 1000;
const LOST = "connection lost, trying again";
/** The history's entry keeps it over a reload: a page that is refused after one would load itself for ever. */
const RELOADED = "reloaded";

export class Connection {
  private socket: WebSocket | null = null;

  constructor(
    private readonly receive: (message: Message) => void,
    /** `why` says more of a link that is lost. */
    private readonly changed: (link: Link, why: string) => void,
  ) {
    this.open();
  }

  /** Whether it could be sent. */
  send(wish: Wish): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(wish));
    return true;
  }

  private open(): void {
    this.changed("connecting", "");
    const url = new URL("socket", location.href);
    url.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    // the token, where there is one
    url.search = location.search;
    const socket = new WebSocket(url, SUBPROTOCOL);
    socket.binaryType = "arraybuffer";
    let wasOpen = false;
    socket.onopen = () => {
      wasOpen = true;
      history.replaceState(null, "");
      this.changed("open", "");
    };
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => {
      const { data } = event;
      const message = typeof data === "string" ? (JSON.parse(data) as Document) : decode(data);
      if (message) this.receive(message);
    };
    socket.onclose = () => {
      this.socket = null;
      if (wasOpen) this.changed("lost", LOST);
      else void this.askWhy();
      setTimeout(() => this.open(), RETRY_MS);
    };
    this.socket = socket;
  }

  /** A browser does not tell why a socket was refused; the server does where it is asked in the plain way. */
  private async askWhy(): Promise<void> {
    const answer = await fetch(`health${location.search}`).catch(() => null);
    if (this.socket?.readyState === WebSocket.OPEN) return;
    if (!answer) {
      this.changed("lost", LOST);
    } else if (!answer.ok) {
      this.changed("lost", `the server refuses this page: ${(await answer.text()).trim()}`);
    } else if (history.state !== RELOADED) {
      // the server is there and takes no socket of this page: it is of another version
      reload();
    } else {
      this.changed("lost", "this page is of another version than the program: load it again without the browser's cache");
    }
  }
}

/** Loads the page anew. */
export function reload(): void {
  history.replaceState(RELOADED, "");
  location.reload();
}
