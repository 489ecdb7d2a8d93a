/** Networks and workflows from the registered generators. */

import { useState } from "preact/hooks";
import { wordsOf, type Catalogue, type Choice, type Document, type Generator, type Schema } from "../server/api";
import type { Service } from "../server/service";
import { Fields } from "./form";
import { propertiesOf, valueAt, withValue } from "./schema";
import type { Path } from "./table";

interface Props {
  service: Service; generators: Catalogue["generators"]; schema: Schema; document: Document | null; put: (document: Document) => void;
}

export function Presets({ service, generators, document, put }: Props) {
  const [network, setNetwork] = useState<Choice>({ type: generators.networks[0]?.type ?? "" });
  const [dags, setDags] = useState<Choice>({ type: generators.dags[0]?.type ?? "" });
  const [error, setError] = useState("");
  const seed = Number(valueAt(document, ["scenario", "config", "seed"]) ?? 42);
  const make = async (): Promise<void> => {
    try {
      const made = await service.api.preset(network, dags, Number.isFinite(seed) ? seed : 42);
      const config = valueAt(document, ["scenario", "config"]);
      setError("");
      put(config === undefined ? made.document : (withValue(made.document, ["scenario", "config"], config) as Document));
    } catch (failure) {
      setError(wordsOf(failure));
    }
  };
  if (!generators.networks.length || !generators.dags.length) return null;
  return (
    <details class="group">
      <summary>Presets: make a network and a workflow</summary>
      <Pick title="network" generators={generators.networks} choice={network} set={setNetwork} />
      <Pick title="workflow" generators={generators.dags} choice={dags} set={setDags} />
      <button onClick={() => void make()}>Replace network and workflows by these</button>
      {error && <p role="alert" class="fault">{error}</p>}
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
        <select id={`preset-${title}`} value={choice.type} onChange={(event) => set({ type: event.currentTarget.value })}>
          {generators.map((each) => <option key={each.type} value={each.type}>{each.type}</option>)}
        </select>
        {found && <p class="muted">{found.summary}{found.is_random ? " Drawn from the seed." : ""}</p>}
      </div>
      {schema && <Fields schema={schema} root={found.parameters} value={choice} path={[]} faults={[]} change={change} />}
    </fieldset>
  );
}
