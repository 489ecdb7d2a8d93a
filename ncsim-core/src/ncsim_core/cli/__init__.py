"""The command line: one file per verb.

Verbs import late. ``ncsim --help`` must load neither numpy, networkx, jsonschema nor SAGA, so
that the answer comes at once; a test on ``sys.modules`` holds it.
"""
