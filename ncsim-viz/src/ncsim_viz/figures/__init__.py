"""Figures of runs for papers, drawn with matplotlib (extra ``plots``): one file each.

``ncsim plot RUN --kind NAME`` finds them by the entry points ``ncsim.run_figures``; a package of
anybody's may offer more. Each is a function of a run and a path.
"""
