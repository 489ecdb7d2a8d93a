"""JSON Schemas (draft-07) of this package's options and of the config section ``rf``."""

import json
from collections.abc import Mapping
from pathlib import Path

_HERE = Path(__file__).parent
_TABLES = _HERE.parent / "tables"


def rf_schema() -> Mapping[str, object]:
    """Return the schema of ``rf``, its standards being the rate tables that are there."""
    schema: dict[str, dict[str, dict[str, object]]] = json.loads(
        (_HERE / "rf.json").read_text("utf-8")
    )
    standards = sorted(path.stem for path in _TABLES.glob("*.csv"))
    schema["properties"]["wifi_standard"]["enum"] = standards
    return schema
