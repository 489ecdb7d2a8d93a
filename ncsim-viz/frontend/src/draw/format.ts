/** Numbers and instants as people read them. */

/** Seconds of an instant in microseconds, with as many digits as a window needs. */
export function seconds(us: number, window = 0): string {
  if (!Number.isFinite(us)) return "–";
  const digits = window > 0 ? Math.max(0, Math.min(6, Math.ceil(2 - Math.log10(window / 1e6)) + 1)) : 6;
  const text = (us / 1e6).toFixed(digits);
  return window > 0 ? text : text.replace(/\.?0+$/, "");
}

export const time = (us: number, window = 0): string => `${seconds(us, window)} s`;

/** Seconds with the digits that ticks at a distance of so many microseconds need. */
export const tickSeconds = (us: number, step_us: number): string =>
  (us / 1e6).toFixed(Math.max(0, Math.min(6, Math.ceil(-Math.log10(step_us / 1e6) - 1e-9))));

/** A number with at most `digits` significant digits. */
export function number(value: number | null | undefined, digits = 4): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  if (Math.abs(value) >= 10 ** digits) return Math.round(value).toLocaleString("en-US").replaceAll(",", "\u202f");
  return String(Number(value.toPrecision(digits)));
}

export const percent = (share: number): string => `${(share * 100).toFixed(share < 0.1 ? 1 : 0)} %`;
export const count = (value: number, one: string, many = `${one}s`): string =>
  `${number(value, 6)} ${value === 1 ? one : many}`;

/** About `wanted` round instants in a window, in microseconds. */
export function ticks(from: number, to: number, wanted: number): number[] {
  const span = to - from;
  if (!(span > 0)) return [from];
  const raw = span / Math.max(1, wanted);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((each) => each >= raw) ?? raw;
  const found: number[] = [];
  for (let k = Math.ceil(from / step); k * step <= to; k++) found.push(k * step);
  return found;
}

export function csvOf(columns: string[], rows: (string | number | boolean | null)[][]): string {
  const cell = (value: string | number | boolean | null): string => {
    let text = value === null ? "" : String(value);
    if (typeof value === "string" && /^[=+\-@\t]/.test(text)) text = `'${text}`; // no formulas in spreadsheets
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return [columns, ...rows].map((row) => row.map(cell).join(",")).join("\r\n") + "\r\n";
}
