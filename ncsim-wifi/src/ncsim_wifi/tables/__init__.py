"""Rate tables, one CSV file each: a new file is a new ``wifi_standard``, and nothing else to do.

Kept apart from ``phy.mcs`` so that the schema of ``rf`` can name them without numpy.
"""

from pathlib import Path

FOLDER = Path(__file__).parent


def table_names() -> list[str]:
    """Return the names of all rate tables."""
    return sorted(path.stem for path in FOLDER.glob("*.csv"))


def table_file(name: str) -> Path:
    """Return where a rate table is."""
    return FOLDER / f"{name}.csv"
