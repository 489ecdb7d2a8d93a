"""Reports, a live viewer and figures of ncsim runs; ``show`` is for notebooks."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ncsim_viz.notebook import RunView, show

__all__ = ["RunView", "show"]


def __getattr__(name: str) -> Any:  # noqa: ANN401 - imported when first asked for, see PEP 562
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from ncsim_viz import notebook

    return getattr(notebook, name)
