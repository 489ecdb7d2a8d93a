/** Networks and workflows from the registered generators. */

import { useState } from "preact/hooks";
import { Refusal, wordsOf, type Catalogue, type Choice, type Document, type Generator, type Schema } from "../server/api";
import type { Service } from "../server/service";
import { Fields } from "./form";
import { isRequired, propertiesOf, sampleOf, valueAt, withValue } from "./schema";
import type { Path } from "./table";

interface Props {
  service: Service; generators: Catalogue["generators"]; schema: Schema; document: Document | null; put: (document: Document) => void;
}

/** A generator with something in every parameter that it cannot do without. */
export function begun(generator: Generator | undefined): Choice {
  const choice: Choice = { type: generator?.type ?? "" };
  if (!generator) return choice;
  for (const [name, schema] of propertiesOf(generator.parameters, generator.parameters)) {
    if (name !== "type" && isRequired(generator.parameters, name)) choice[name] = sampleOf(schema);
  }
  return choice;
}

export function Presets({ service, generators, document, put }: Props) {
  const [network, setNetwork] = useState<Choice>(begun(generators.networks[0]));
  const [dags, setDags] = useState<Choice>(begun(generators.dags[0]));
  const [errors, setErrors] = useState<string[]>([]);
  const seed = Number(valueAt(document, ["scenario", "config", "seed"]) ?? 42);
  const make = async (): Promise<void> => {
    try {
      const made = await service.api.preset(network, dags, Number.isFinite(seed) ? seed : 42);
      const config = valueAt(document, ["scenario", "config"]);
      setErrors([]);
      put(config === undefined ? made.document : (withValue(made.document, ["scenario", "config"], config) as Document));
    } catch (failure) {
      const faults = failure instanceof Refusal ? failure.faults.map((fault) => `${fault.path}: ${fault.message}`) : [];
      setErrors(faults.length ? faults : [wordsOf(failure)]);
    }
  };
  if (!generators.networks.length || !generators.dags.length) return null;
  return (
    <details class="group">
      <summary>Presets: make a network and a workflow</summary>
      <Pick title="network" generators={generators.networks} choice={network} set={setNetwork} />
      <Pick title="workflow" generators={generators.dags} choice={dags} set={setDags} />
      <button onClick={() => void make()}>Replace network and workflows by these</button>
      {errors.map((error) => <p role="alert" class="fault" key={error}>{error}</p>)}
    </details>
  );
}

function Pick({ title, generators, choice, set }: { title: string; generators: Generator[]; choice: Choice; set: (choice: Choice) => void }) {
  const found = generators.find((each) => each.type === choice.type);
  const change = (path: Path, value: unknown): void => set(withValue(choice, path, value) as Choice);
  const isType = (name: string): boolean => name === "type";
  const schema = found && { ...found.parameters, properties: Object.fromEntries(propertiesOf(found.parameters, found.parameters).filter(([name]) => !isType(name))) };
  return (
    <fieldset>
      <legend>{title}</legend>
      <div class="field">
        <label for={`preset-${title}`}>kind</label>
        <select id={`preset-${title}`} value={choice.type} onChange={(event) => set(begun(generators.find((each) => each.type === event.currentTarget.value)))}>
          {generators.map((each) => <option key={each.type} value={each.type}>{each.type}</option>)}
        </select>
        {found && <p class="muted">{found.summary}{found.is_random ? " Drawn from the seed." : ""}</p>}
      </div>
      {schema && <Fields schema={schema} root={found.parameters} value={choice} path={[]} faults={[]} change={change} />}
    </fieldset>
  );
}
