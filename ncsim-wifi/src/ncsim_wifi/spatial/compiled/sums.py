"""Sums in a stated order, to be compiled; ``spatial/sums.py`` has them for arrays."""

from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import FloatArray


@inlined
def halving_sum(terms: FloatArray) -> float:
    """Return the sum of a power of two of terms, which are overwritten: first plus second half."""
    half = len(terms) // 2
    while half:
        for place in range(half):
            terms[place] += terms[half + place]
        half //= 2
    return float(terms[0])
