/** A layered drawing of a DAG: longest-path layers, then barycentre sweeps. */

export interface Layout { layer: Int32Array; order: Float64Array; layers: number[][] }

export function layered(count: number, sources: ArrayLike<number>, targets: ArrayLike<number>, sweeps = 8): Layout {
  const out: number[][] = Array.from({ length: count }, () => []);
  const into: number[][] = Array.from({ length: count }, () => []);
  for (let i = 0; i < sources.length; i++) {
    out[sources[i]].push(targets[i]);
    into[targets[i]].push(sources[i]);
  }
  const layer = new Int32Array(count);
  const missing = Int32Array.from(into, (each) => each.length);
  const free: number[] = [];
  for (let i = 0; i < count; i++) if (missing[i] === 0) free.push(i);
  for (let at = 0; at < free.length; at++) {
    for (const next of out[free[at]]) {
      layer[next] = Math.max(layer[next], layer[free[at]] + 1);
      if (--missing[next] === 0) free.push(next);
    }
  }
  const layers: number[][] = [];
  for (let i = 0; i < count; i++) (layers[layer[i]] ??= []).push(i);
  const order = new Float64Array(count);
  const number = (row: number[]): void => row.forEach((task, i) => { order[task] = i - (row.length - 1) / 2; });
  layers.forEach(number);
  for (let sweep = 0; sweep < sweeps; sweep++) {
    const isDown = sweep % 2 === 0;
    const near = isDown ? into : out;
    for (const row of isDown ? layers : [...layers].reverse()) {
      const wish = new Map(row.map((task) => [task, near[task].length ? near[task].reduce((sum, each) => sum + order[each], 0) / near[task].length : order[task]]));
      row.sort((a, b) => (wish.get(a) as number) - (wish.get(b) as number) || a - b);
      number(row);
    }
  }
  return { layer, order, layers };
}
