/** A run followed while it is written: records arrive in order, none twice, also across a dropped connection. */

import { TraceParser } from "../data/parse";
import type { Run } from "../data/run";

export interface Follower {
  /** There is a run to show: its header has come, or another run has taken its place. */
  opened(run: Run): void;
  /** The run has more records. */
  grew(run: Run): void;
  ended(run: Run, status: string): void;
  /** What came cannot be read; nothing more is asked for. */
  failed(words: string): void;
}

type Connect = (from: string) => EventSource;

const RETRY_ms = 1000;
const LEAST_PAUSE_ms = 50;
/** Drawing may take one part in so many of the time. */
const SHARE = 4;

export class Live {
  private parser = new TraceParser();
  private source: EventSource | null = null;
  private place = "";
  private isOpen = false;
  private timer = 0;
  private pause_ms = LEAST_PAUSE_ms;
  private isClosed = false;

  constructor(private readonly connect: Connect, private readonly follower: Follower) {
    this.parser.run.isLive = true;
    this.listen();
  }

  get run(): Run { return this.parser.run; }

  close(): void {
    this.isClosed = true;
    this.source?.close();
    clearTimeout(this.timer);
  }

  private listen(): void {
    const source = this.connect(this.place);
    this.source = source;
    source.onmessage = (message) => this.take(message);
    source.addEventListener("restart", (message) => this.restart(message as MessageEvent));
    source.addEventListener("end", (message) => this.end(message as MessageEvent));
    source.onerror = () => {
      // The browser reconnects by itself after a lost connection, not after a refusal.
      if (source.readyState === EventSource.CLOSED && !this.isClosed) setTimeout(() => this.isClosed || this.listen(), RETRY_ms);
    };
  }

  private take(message: MessageEvent<string>): void {
    try {
      this.parser.push(`${message.data}\n`);
    } catch (error) {
      this.close();
      return this.follower.failed(error instanceof Error ? error.message : String(error));
    }
    this.place = message.lastEventId;
    if (!this.timer) this.timer = window.setTimeout(() => this.show(), this.pause_ms);
  }

  private show(): void {
    this.timer = 0;
    if (this.run.header === null || this.isClosed) return;
    const started = performance.now();
    if (this.isOpen) this.follower.grew(this.run);
    else this.follower.opened(this.run);
    this.isOpen = true;
    requestAnimationFrame(() => {
      this.pause_ms = Math.max(LEAST_PAUSE_ms, SHARE * (performance.now() - started));
    });
  }

  private restart(message: MessageEvent<string>): void {
    this.parser = new TraceParser();
    this.parser.run.isLive = true;
    this.place = message.lastEventId;
    this.isOpen = false;
  }

  private end(message: MessageEvent<string>): void {
    this.close();
    this.isClosed = false;
    this.run.isLive = false;
    this.show();
    this.isClosed = true;
    this.follower.ended(this.run, (JSON.parse(message.data) as { status: string }).status);
  }
}
