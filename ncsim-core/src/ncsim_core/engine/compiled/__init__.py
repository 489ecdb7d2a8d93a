"""The engine's loop once more, over arrays, so that numba can compile it.

The engine in Python defines what happens; here every rule stands a second time under the same name,
and gives the same results to the last bit. See docs/decisions/0006-compiled-loop.md.
"""
