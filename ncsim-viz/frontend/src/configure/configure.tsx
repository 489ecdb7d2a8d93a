/** Configure and run: a form from the schema and the YAML it stands for, each following the other. */

import { useEffect, useRef, useState } from "preact/hooks";
import { save } from "../app/save";
import { wordsOf, type Catalogue, type Document, type Fault, type Schema, type Validation } from "../server/api";
import { JobList } from "../server/runs";
import type { Service } from "../server/service";
import { Field } from "./form";
import { Presets } from "./presets";
import { pointerOf, propertiesOf, resolved, shapeOf, withValue } from "./schema";
import type { Path } from "./table";

const PAUSE_ms = 350;

interface Offer { schema: Schema; catalogue: Catalogue }

export function Configure({ service }: { service: Service }) {
  const [offer, setOffer] = useState<Offer | null>(null);
  const [error, setError] = useState("");
  useEffect(() => {
    Promise.all([service.api.schema(), service.api.catalogue()]).then(
      ([schema, catalogue]) => setOffer({ schema, catalogue }), (failure: unknown) => setError(wordsOf(failure)));
  }, []);
  if (error) return <p role="alert" class="fault">{error}</p>;
  return offer ? <Editor service={service} offer={offer} /> : <p role="status">loading …</p>;
}

/** What outlives a look at another view. */
const kept = { yaml: "", name: "run-1" };

/** The document, its text, and what is wrong with them. */
function useScenario(service: Service, starter: string) {
  const [yaml, setYaml] = useState(kept.yaml || starter);
  const [document, setDocument] = useState<Document | null>(null);
  const [check, setCheck] = useState<Validation | null>(null);
  const [error, setError] = useState("");
  const turn = useRef(0);
  const timer = useRef(0);
  kept.yaml = yaml;
  const fail = (failure: unknown): void => setError(wordsOf(failure));
  const validate = async (text: string, mine: number, takesDocument: boolean): Promise<void> => {
    const found = await service.api.validate(text);
    if (mine !== turn.current) return;
    setCheck(found);
    setError("");
    if (takesDocument && found.document) setDocument(found.document);
  };
  const fromText = (text: string): void => {
    setYaml(text);
    const mine = ++turn.current;
    clearTimeout(timer.current);
    timer.current = window.setTimeout(() => void validate(text, mine, true).catch(fail), PAUSE_ms);
  };
  const fromDocument = (changed: Document): void => {
    setDocument(changed);
    const mine = ++turn.current;
    clearTimeout(timer.current);
    void service.api.yaml(changed).then(async (answer) => {
      if (mine !== turn.current) return;
      setYaml(answer.yaml);
      await validate(answer.yaml, mine, false);
    }).catch(fail);
  };
  useEffect(() => void validate(yaml, ++turn.current, true).catch(fail), []);
  return { yaml, document, check, error, setError, fromText, fromDocument };
}

function Editor({ service, offer }: { service: Service; offer: Offer }) {
  const scenario = useScenario(service, offer.catalogue.starter);
  const latest = useRef(scenario);
  latest.current = scenario;
  const change = useRef((path: Path, value: unknown): void => {
    const { document, fromDocument } = latest.current;
    fromDocument(withValue(document ?? {}, path, value) as Document);
  }).current;
  const faults = scenario.check?.faults ?? [];
  return (
    <div class="configure">
      <section class="form" aria-label="Form" tabIndex={0}>
        <Jumps schema={offer.schema} />
        {offer.catalogue.broken.map((each) => <p class="fault" key={each.distribution}>{each.distribution} could not be loaded: {each.detail}</p>)}
        <Presets service={service} generators={offer.catalogue.generators} schema={offer.schema} document={scenario.document} put={scenario.fromDocument} />
        {scenario.document === null && <p role="status">{scenario.check ? "The text is no mapping: mend the YAML first." : "loading …"}</p>}
        {scenario.document !== null && propertiesOf(offer.schema, offer.schema).filter(([name]) => !name.startsWith("$")).map(([name, each]) => (
          <Field key={name} name={name} schema={resolved(each, offer.schema)} root={offer.schema} value={scenario.document?.[name]} path={[name]} faults={faults} required change={change} />
        ))}
      </section>
      <section class="side" aria-label="YAML and run">
        <RunBox service={service} yaml={scenario.yaml} check={scenario.check} fail={scenario.setError} />
        {scenario.error && <p role="alert" class="fault">{scenario.error}</p>}
        <FaultList faults={faults} notes={scenario.check?.notes ?? []} />
        <Files yaml={scenario.yaml} put={scenario.fromText} />
        <label for="yaml">Scenario as YAML (comments are kept until the form changes something)</label>
        <textarea id="yaml" spellcheck={false} value={scenario.yaml} onInput={(event) => scenario.fromText(event.currentTarget.value)} />
        <JobList service={service} />
      </section>
    </div>
  );
}

/** The way to every part of the form, as the schema has them. */
function Jumps({ schema }: { schema: Schema }) {
  const parts = propertiesOf(schema, schema).flatMap(([name, each]) => propertiesOf(each, schema)
    .filter(([, part]) => ["object", "table", "list"].includes(shapeOf(part, schema))).map(([part]) => [name, part]));
  return (
    <nav aria-label="Parts of the form" class="jumps">Go to {parts.map(([name, part]) => (
      <button key={part} onClick={() => focusOn(pointerOf([name, part]))}>{part}</button>
    ))}</nav>
  );
}

/** The text from a file and into one. */
function Files({ yaml, put }: { yaml: string; put: (text: string) => void }) {
  return (
    <div class="run-box">
      <label>Open a file <input type="file" accept=".yaml,.yml,.json" onChange={(event) => void event.currentTarget.files?.[0]?.text().then(put)} /></label>
      <button onClick={() => save("scenario.yaml", "application/yaml", yaml)}>Save YAML</button>
    </div>
  );
}

function RunBox({ service, yaml, check, fail }: { service: Service; yaml: string; check: Validation | null; fail: (words: string) => void }) {
  const [name, setName] = useState(kept.name);
  kept.name = name;
  const sum = check?.summary;
  const start = async (): Promise<void> => {
    try {
      const { job } = await service.api.start(yaml, name);
      fail("");
      setName(next(job.name));
    } catch (failure) {
      fail(wordsOf(failure));
    }
  };
  return (
    <div class="run-box">
      <label>Run name <input value={name} onInput={(event) => setName(event.currentTarget.value)} /></label>
      <button class="strong" disabled={!check?.valid} onClick={() => void start()}>Run</button>
      <span role="status">{check === null ? "checking …" : check.valid ? "valid" : `${check.faults.length} ${check.faults.length === 1 ? "fault" : "faults"}`}
        {sum && `: ${Object.entries(sum).map(([what, many]) => `${what} ${many}`).join(", ")}`}</span>
    </div>
  );
}

/** The next name in a row: run-1, run-2. */
export const next = (name: string): string => (/\d+$/.test(name) ? name.replace(/\d+$/, (digits) => String(Number(digits) + 1)) : `${name}-2`);

function FaultList({ faults, notes }: { faults: Fault[]; notes: string[] }) {
  return (
    <>
      {notes.map((note) => <p class="muted" key={note}>{note}</p>)}
      {faults.length > 0 && (
        <ul class="faults" aria-label="Faults">{faults.map((fault, i) => (
          <li key={i}>
            {fault.line !== null && <span class="muted">line {fault.line}: </span>}
            <button class="link" onClick={() => focusOn(fault.pointer)}>{fault.path || "the file"}</button>: {fault.message}
            {fault.suggestion && ` Did you mean ${fault.suggestion}?`}
          </li>
        ))}</ul>
      )}
    </>
  );
}

/** Put the focus into the field of a fault, or the nearest above it. */
function focusOn(pointer: string): void {
  const fields = [...document.querySelectorAll<HTMLElement>("[data-pointer]")];
  for (let at = pointer; at; at = at.slice(0, at.lastIndexOf("/"))) {
    const found = fields.find((each) => each.dataset.pointer === at) ?? fields.find((each) => each.dataset.pointer?.startsWith(`${at}/`));
    if (!found) continue;
    for (let up = found.closest("details"); up; up = up.parentElement?.closest("details") ?? null) up.open = true;
    found.focus();
    found.scrollIntoView({ block: "center" });
    return;
  }
}
