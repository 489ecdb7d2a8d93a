/** Keys and mouse, explained. */

import { useEffect, useRef } from "preact/hooks";
import { KEYS } from "./keys";

export function Help({ close }: { close: () => void }) {
  const button = useRef<HTMLButtonElement>(null);
  useEffect(() => button.current?.focus(), []);
  return (
    <dialog open aria-label="Help">
      <h2>Keys</h2>
      <dl class="keys">{KEYS.map(([keys, words]) => <div key={keys}><dt><kbd>{keys}</kbd></dt><dd>{words}</dd></div>)}</dl>
      <h2>Mouse</h2>
      <p>Click selects, here and in every view. Drag moves the window of time, shift and drag sets it, the wheel (with ctrl in long
        drawings) zooms; in Topology drag and wheel move and enlarge the map. The strip at the bottom is the whole run: drag in it to set the window, click to move the playhead.</p>
      <button ref={button} onClick={close}>Close (Esc)</button>
    </dialog>
  );
}
