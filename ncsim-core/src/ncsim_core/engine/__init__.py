"""The discrete-event engine, and the only mutable state of ncsim.

``Setup`` is what is fixed in a run, ``State`` what changes. A description never carries
progress: ``Task`` is frozen, ``TaskRun`` points to it.
"""
