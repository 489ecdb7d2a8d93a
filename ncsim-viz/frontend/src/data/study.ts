/** A study's tables, as docs/viewer-api.md has them; every number in them is Python's. */

export type StudyCell = string | number | boolean | null;
export interface StudyTable { title: string; columns: string[]; rows: StudyCell[][] }
export interface StudyGroup { by: string[]; measure: string; table: StudyTable }
export interface Study {
  name: string;
  planned: number;
  counts: Record<string, number>;
  factors: { name: string; values: StudyCell[] }[];
  roles: { policy: string; mode: string; solo: StudyCell; full: StudyCell } | null;
  note: string;
  runs: StudyTable;
  winners: StudyTable | null;
  totals: StudyTable | null;
  groups: StudyGroup[];
}

/** Cells of a row by column. */
export const rowOf = (table: StudyTable, row: number): Map<string, StudyCell> =>
  new Map(table.columns.map((name, i) => [name, table.rows[row][i]]));

/** First run whose columns have some values; -1 if there is none. */
export function runWhere(study: Study, wanted: Map<string, StudyCell>): number {
  const columns = [...wanted].map(([name, value]) => [study.runs.columns.indexOf(name), String(value)] as const).filter(([at]) => at >= 0);
  return study.runs.rows.findIndex((row) => columns.every(([at, value]) => String(row[at]) === value));
}

/** Values of a column in the order in which they first come. */
export function distinct(table: StudyTable, column: string): StudyCell[] {
  const at = table.columns.indexOf(column);
  const found = new Map(table.rows.map((row) => [String(row[at]), row[at]]));
  return [...found.values()];
}

/** The group of two factors and a measure, whichever way round it is stored. */
export const groupOf = (study: Study, a: string, b: string, measure: string): StudyGroup | undefined =>
  study.groups.find((each) => each.measure === measure && each.by.length === 2 && each.by.includes(a) && each.by.includes(b));

export interface Parts { labels: string[]; policies: string[] }

/** Columns of the winners' table: what tells its rows apart, and the policies. */
export function winnerParts(study: Study): Parts {
  const columns = study.winners?.columns ?? [];
  const known = new Set(study.factors.map((factor) => factor.name).concat("seed"));
  const end = columns.indexOf("solo_winners");
  const all = columns.slice(0, end).filter((name) => known.has(name));
  const labels = all.filter((name) => distinct(study.winners as StudyTable, name).length > 1);
  return { labels: labels.length ? labels : all, policies: columns.slice(all.length, end) };
}
