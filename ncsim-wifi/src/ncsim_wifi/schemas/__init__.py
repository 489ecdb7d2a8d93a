"""JSON Schemas (draft-07) of this package's options and of the config section ``rf``."""

import json
from collections.abc import Mapping
from pathlib import Path

from ncsim_wifi.tables import table_names

_HERE = Path(__file__).parent


def rf_schema() -> Mapping[str, object]:
    """Return the schema of ``rf``, its standards being the rate tables that are there."""
    schema: dict[str, dict[str, dict[str, object]]] = json.loads(
        (_HERE / "rf.json").read_text("utf-8")
    )
    schema["properties"]["wifi_standard"]["enum"] = table_names()
    return schema
