"""What the documentation says about both radio models against packets."""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
LINE = re.compile(r"(\w+) +([\d.]+)% +([\d.]+)% +([\d.]+)% +([\d.]+)%")


def test_the_table_of_both_radio_models_is_what_the_script_prints():
    command = [sys.executable, ROOT / "examples" / "spatial" / "packets.py"]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    rows = {found[1]: [f"{float(number):.1f} %" for number in found.groups()[1:]]
            for found in LINE.finditer(printed)}  # fmt: skip

    text = (ROOT / "docs" / "wifi-model.md").read_text().split("`csma_spatial` in short")[1]
    documented = dict(re.findall(r"^\| (\w+) \|.*?\| ([\d.]+ %.*) \|$", text, re.MULTILINE))
    assert {name: row.split(" | ") for name, row in documented.items()} == rows
