/** Text of a trace, piece by piece, into a run. */

import { Run } from "./run";

export class TraceParser {
  readonly run = new Run();
  private rest = "";

  /** Take in a piece of text that may begin and end within a line. */
  push(text: string): void {
    let from = 0;
    let at = text.indexOf("\n");
    if (at < 0) {
      this.rest += text;
      return;
    }
    this.line(this.rest + text.slice(0, at));
    for (;;) {
      from = at + 1;
      at = text.indexOf("\n", from);
      if (at < 0) break;
      this.line(text.slice(from, at));
    }
    this.rest = text.slice(from);
  }

  /** The text has ended; a torn last line is dropped, a whole one without line end is not. */
  finish(): Run {
    if (this.rest.trim()) {
      try {
        this.run.add(JSON.parse(this.rest));
      } catch (error) {
        if (!(error instanceof SyntaxError)) throw error;
      }
    }
    this.rest = "";
    if (this.run.header === null) throw new Error("the trace is empty or its header is torn off");
    return this.run;
  }

  private line(text: string): void {
    let record: unknown;
    try {
      record = JSON.parse(text);
    } catch {
      throw new Error(`line ${this.run.lines + 1} of the trace is no JSON: ${text.slice(0, 60)}`);
    }
    this.run.add(record as never);
  }
}

/** Read a stream of bytes, compressed or not. */
export async function parseBytes(bytes: Blob): Promise<Run> {
  const magic = new Uint8Array(await bytes.slice(0, 2).arrayBuffer());
  const isGzip = magic[0] === 0x1f && magic[1] === 0x8b;
  const stream = isGzip ? bytes.stream().pipeThrough(new DecompressionStream("gzip")) : bytes.stream();
  const parser = new TraceParser();
  const reader = stream.getReader();
  const decoder = new TextDecoder();
  for (;;) {
    let piece: ReadableStreamReadResult<Uint8Array>;
    try {
      piece = await reader.read();
    } catch (error) {
      if (parser.run.lines > 0) break; // compressed data that stops early: a truncated trace
      throw error;
    }
    if (piece.done) break;
    parser.push(decoder.decode(piece.value, { stream: true }));
  }
  return parser.finish();
}

export function bytesOfBase64(text: string): Uint8Array<ArrayBuffer> {
  const modern = Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array<ArrayBuffer> };
  if (modern.fromBase64) return modern.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}
