/** Fields that keep what is being typed, whatever answers of the server draw anew meanwhile. */

import { useState } from "preact/hooks";

interface Props {
  value: string;
  placeholder: string;
  marks: Record<string, string | undefined>;
  commit: (text: string) => void;
  size?: number;
  isNumber?: boolean;
  paste?: (event: ClipboardEvent) => void;
}

/** What is typed is shown until it is committed, by leaving the field or by Enter. */
function useDraft(value: string, commit: (text: string) => void) {
  const [draft, setDraft] = useState<string | null>(null);
  return {
    value: draft ?? value,
    onInput: (event: { currentTarget: { value: string } }) => setDraft(event.currentTarget.value),
    onChange: (event: { currentTarget: { value: string } }) => commit(event.currentTarget.value),
    onBlur: () => setDraft(null),
  };
}

export function DraftInput({ value, placeholder, marks, commit, size, isNumber, paste }: Props) {
  return <input {...marks} {...useDraft(value, commit)} placeholder={placeholder} size={size} inputMode={isNumber ? "decimal" : undefined} onPaste={paste} />;
}

export function DraftArea({ value, placeholder, marks, commit }: Props) {
  return <textarea {...marks} {...useDraft(value, commit)} placeholder={placeholder} rows={2} />;
}
