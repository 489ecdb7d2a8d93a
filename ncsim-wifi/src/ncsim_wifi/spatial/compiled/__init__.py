"""The costliest functions of the model as loops over numbers, for numba.

Each has a twin of the same name that works on whole arrays, and gives the same bits: the same
operations in the same order, no transcendental functions, no fused multiply-add. Only to be
imported when they are wanted: starting numba takes more than a second.
"""
