"""A run as verbs take it: a trace, an output folder, or one run of a study."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ncsim_core.trace.run_trace import RunTrace


def run_of(text: str) -> "RunTrace":
    """Return the run that a path or ``STUDY@COLUMN=VALUE,...`` names.

    Raises:
        TraceError: The path holds no trace.
        ScenarioError: The study has no such run, or several.
    """
    if "@" in text:
        from ncsim_core.sweep.selecting import recalled, selection_of

        selection = selection_of(text)
        if selection is not None:
            return recalled(selection)
    from ncsim_core.trace.loading import load_run

    return load_run(text)
