/** Parses a trace away from the page: bytes in, packed columns out. */

import { parseBytes } from "./parse";

self.onmessage = (message: MessageEvent<Blob>) => {
  parseBytes(message.data).then(
    (run) => {
      const packed = run.pack();
      const buffers = Object.values(packed.columns).map((each) => (each as Int32Array).buffer);
      (self as unknown as Worker).postMessage({ packed }, buffers as Transferable[]);
    },
    (error: unknown) => self.postMessage({ error: String(error instanceof Error ? error.message : error) }),
  );
};
