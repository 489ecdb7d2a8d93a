"""The viewer's script, compressed inside a report: half the size of a small one."""

import base64
import gzip
from typing import Final

OPENING: Final = '<script type="module">'
CLOSING: Final = "</script>"
VIEWER_TYPE: Final = "application/x-ncsim-viewer"
LOADER: Final = f"""
const packed = document.querySelector('script[type="{VIEWER_TYPE}"]').textContent;
const bytes = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
const script = document.createElement("script");
script.type = "module";
script.textContent = await new Response(stream).text();
document.head.append(script);
"""


def packed(page: str) -> str:
    """Return a page whose last script is compressed and unpacks itself; works from a disk, too."""
    before, _, rest = page.rpartition(OPENING)
    script, _, after = rest.partition(CLOSING)
    payload = base64.b64encode(gzip.compress(script.encode(), mtime=0)).decode()
    carrier = f'<script type="{VIEWER_TYPE}">{payload}{CLOSING}'
    return f"{before}{carrier}\n{OPENING}{LOADER}{CLOSING}{after}"
