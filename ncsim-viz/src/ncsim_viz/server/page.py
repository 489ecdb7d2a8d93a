"""The page that the server gives out: the viewer, told where it is."""

import json
from importlib.metadata import version
from typing import Final

from ncsim_core.trace.embedding import data_element

from ncsim_viz.document import with_data

API: Final = 1
SERVER_TYPE: Final = "application/x-ncsim-server"


def served_page(title: str, token: str, *, can_run: bool) -> str:
    """Return the viewer in serve mode.

    Args:
        title: Name of the folder.
        token: What the page has to show with every request.
        can_run: Whether runs may be started.
    """
    about = {
        "api": API,
        "token": token,
        "title": title,
        "software": f"ncsim-viz {version('ncsim-viz')}",
        "can_run": can_run,
    }
    return with_data([data_element(SERVER_TYPE, json.dumps(about).encode())], title)
