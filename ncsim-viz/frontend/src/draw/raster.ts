/** Lanes as pixels: the cost depends on pixels, not on intervals. */

import type { Lane, Lanes } from "./lanes";
import { BINS } from "./lanes";
import { pixelOf, type Palette } from "./palette";

export interface Row { lane: Lane; index: number; top: number; height: number }

/** Fill `pixels` (one per cell, `width` a row) with the lanes of a window. */
export function rasterize(
  pixels: Uint32Array, width: number, lanes: Lanes, rows: Row[], from: number, to: number, whole: number, colours: Palette,
): void {
  const palette = colours.categories.map(pixelOf);
  const line = new Uint32Array(width);
  pixels.fill(0);
  const binsInWindow = ((to - from) / Math.max(1, whole)) * BINS;
  for (const row of rows) {
    line.fill(0);
    if (binsInWindow >= width) fromPyramid(line, width, lanes, row, from, to, whole, palette);
    else fromIntervals(line, width, lanes, row, from, to, palette);
    for (let y = Math.max(0, row.top); y < row.top + row.height; y++) {
      const at = y * width;
      if (at + width <= pixels.length) pixels.set(line, at);
    }
  }
}

function fromPyramid(
  line: Uint32Array, width: number, lanes: Lanes, row: Row, from: number, to: number, whole: number, palette: number[],
): void {
  const level = lanes.level(Math.ceil((width * whole) / (to - from)));
  const perPixel = (((to - from) / whole) * level.bins) / width;
  const first = (from / whole) * level.bins;
  const base = row.index * level.bins;
  for (let x = 0; x < width; x++) {
    const low = Math.max(0, Math.floor(first + x * perPixel));
    const high = Math.min(level.bins, Math.max(low + 1, Math.floor(first + (x + 1) * perPixel)));
    let most = 0;
    let colour = 0;
    let sum = 0;
    for (let bin = low; bin < high; bin++) {
      const busy = level.busy[base + bin];
      sum += busy;
      if (busy > most) {
        most = busy;
        colour = level.colour[base + bin];
      }
    }
    if (sum > 0) line[x] = faded(palette[colour % palette.length], 0.25 + (0.75 * sum) / (255 * (high - low)));
  }
}

function fromIntervals(
  line: Uint32Array, width: number, lanes: Lanes, row: Row, from: number, to: number, palette: number[],
): void {
  const perUs = width / (to - from);
  const [first, last] = lanes.range(row.lane, from, to);
  for (let i = first; i < last; i++) {
    const low = Math.max(0, Math.floor((lanes.start.data[i] - from) * perUs));
    const high = Math.min(width, Math.max(low + 1, Math.floor((lanes.end.data[i] - from) * perUs)));
    if (high <= 0) continue;
    line.fill(palette[lanes.category.data[i] % palette.length], low, high);
  }
}

const faded = (pixel: number, share: number): number =>
  ((pixel & 0x00ffffff) | (Math.round(255 * Math.min(1, share)) << 24)) >>> 0;
