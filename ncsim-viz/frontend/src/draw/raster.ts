/** Lanes as pixels: the cost depends on pixels, not on intervals. */

import type { Lane, Lanes, Level } from "./lanes";
import { BINS } from "./lanes";
import { pixelOf, type Palette } from "./palette";

export interface Row { lane: Lane; index: number; top: number; height: number }

/** What is shown: the window of time, the first pixel row, and the end of the run. */
export interface Part { from: number; to: number; top: number; whole: number }

let scratch: { canvas: HTMLCanvasElement; pen: CanvasRenderingContext2D; image: ImageData } | null = null;

/** Lanes of a window as an image; the canvas is the same from call to call as long as the size is. */
export function rasterImage(width: number, height: number, lanes: Lanes, rows: Row[], part: Part, colours: Palette): HTMLCanvasElement {
  const [w, h] = [Math.max(1, width), Math.max(1, height)];
  if (scratch?.canvas.width !== w || scratch.canvas.height !== h) {
    const canvas = document.createElement("canvas");
    canvas.width = w;
    canvas.height = h;
    const pen = canvas.getContext("2d") as CanvasRenderingContext2D;
    scratch = { canvas, pen, image: pen.createImageData(w, h) };
  }
  rasterize(new Uint32Array(scratch.image.data.buffer), w, lanes, rows, part, colours);
  scratch.pen.putImageData(scratch.image, 0, 0);
  return scratch.canvas;
}

/** Fill `pixels` (one per cell, `width` a row) with the lanes of a window. */
export function rasterize(pixels: Uint32Array, width: number, lanes: Lanes, rows: Row[], part: Part, colours: Palette): void {
  const palette = colours.categories.map(pixelOf);
  const line = new Uint32Array(width);
  const height = pixels.length / width;
  pixels.fill(0);
  const binsInWindow = ((part.to - part.from) / Math.max(1, part.whole)) * BINS;
  for (const row of rows) {
    line.fill(0);
    const level = binsInWindow >= width ? lanes.level(Math.ceil((width * part.whole) / (part.to - part.from))) : null;
    if (level) fromPyramid(line, width, level, row, part, palette);
    else fromIntervals(line, width, lanes, row, part, palette);
    const [first, last] = [Math.round(row.top - part.top), Math.round(row.top + row.height - part.top)];
    for (let y = Math.max(0, first); y < Math.min(height, last); y++) pixels.set(line, y * width);
  }
}

export function fromPyramid(line: Uint32Array, width: number, level: Level, row: Row, { from, to, whole }: Part, palette: number[]): void {
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

export function fromIntervals(line: Uint32Array, width: number, lanes: Lanes, row: Row, { from, to }: Part, palette: number[]): void {
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
