"""What can go wrong, sorted by who can mend it.

How a run ends is not an error: see ``ncsim_core.engine.outcome.RunStatus``.
"""


class NcsimError(Exception):
    """Root of all errors that ncsim raises on purpose."""


class ScenarioError(NcsimError):
    """The user's input is wrong; the message says where and what to do."""


class PluginError(NcsimError):
    """A plug-in did not load, or answered with something it must not answer."""


class UnknownComponentError(PluginError, LookupError):
    """No installed plug-in offers a component of that kind and name."""


class PlacementError(PluginError):
    """A scheduler's plan lacks a task or names a node that does not exist."""


class ModelScopeError(NcsimError):
    """A model was asked for something it does not cover, such as a third interferer.

    A run in which this happens ends ``failed`` with this message; there is no silent
    switch to another model.
    """


class ConvergenceError(NcsimError):
    """A numerical solver did not reach its stated residual."""


class EngineError(NcsimError):
    """ncsim broke one of its own invariants: a bug, please report it."""
