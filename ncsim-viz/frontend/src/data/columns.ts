/** Growing typed columns: one array per field, never one object per event. */

type Typed = Float64Array | Int32Array | Uint8Array | Uint32Array;

/** A column that grows by doubling; read `data[i]` for `i < length`. */
export class Column<T extends Typed> {
  length = 0;

  constructor(public data: T) {}

  push(value: number): number {
    if (this.length === this.data.length) this.grow();
    this.data[this.length] = value;
    return this.length++;
  }

  /** The filled part, sharing memory. */
  view(): T {
    return this.data.subarray(0, this.length) as T;
  }

  private grow(): void {
    const Kind = this.data.constructor as new (length: number) => T;
    const larger = new Kind(Math.max(64, this.data.length * 2));
    larger.set(this.data as never);
    this.data = larger;
  }
}

export type F64 = Column<Float64Array>;
export type I32 = Column<Int32Array>;
export type U8 = Column<Uint8Array>;

export const f64 = (): F64 => new Column(new Float64Array(64));
export const i32 = (): I32 => new Column(new Int32Array(64));
export const u8 = (): U8 => new Column(new Uint8Array(64));

/** First index with `data[index] > value` in `[0, length)`; `length` if there is none. */
export function upperBound(data: ArrayLike<number>, length: number, value: number, from = 0): number {
  let low = from;
  let high = length;
  while (low < high) {
    const middle = (low + high) >>> 1;
    if (data[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** First index with `data[index] >= value` in `[from, length)`. */
export function lowerBound(data: ArrayLike<number>, length: number, value: number, from = 0): number {
  let low = from;
  let high = length;
  while (low < high) {
    const middle = (low + high) >>> 1;
    if (data[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}
