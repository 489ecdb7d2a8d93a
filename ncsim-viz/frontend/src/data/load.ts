/** Where a run comes from: this page, a file of the user's, or the server. */

import type { Extras } from "./extras";
import { bytesOfBase64, parseBytes } from "./parse";
import { Run, type Packed } from "./run";
import TraceWorker from "./worker?worker&inline";

/** Parse in a Worker; on the page itself where Workers are forbidden. */
export async function loadRun(bytes: Blob): Promise<Run> {
  let worker: Worker;
  try {
    worker = new TraceWorker();
  } catch {
    return parseBytes(bytes);
  }
  try {
    return await new Promise<Run>((resolve, reject) => {
      worker.onmessage = (message: MessageEvent<{ packed?: Packed; error?: string }>) => {
        const { packed, error } = message.data;
        if (packed) resolve(Run.unpack(packed));
        else reject(new Error(error));
      };
      worker.onerror = () => parseBytes(bytes).then(resolve, reject);
      worker.postMessage(bytes);
    });
  } finally {
    worker.terminate();
  }
}

/** The n-th embedded trace of this page. */
export function embeddedTrace(index: number): Blob | null {
  const element = document.querySelectorAll('script[type="application/x-ncsim-trace"]')[index];
  return element ? new Blob([bytesOfBase64((element.textContent ?? "").trim())]) : null;
}

/** The JSON that Python computed for this page; see ncsim_viz.extras. */
export async function embeddedExtras(): Promise<Extras> {
  const element = document.querySelector('script[type="application/x-ncsim-extras"]');
  if (!element) return {};
  const bytes = new Blob([bytesOfBase64((element.textContent ?? "").trim())]);
  const stream = bytes.stream().pipeThrough(new DecompressionStream("gzip"));
  return JSON.parse(await new Response(stream).text()) as Extras;
}
