"""``csma_spatial`` keeps what the contract promises."""

from ncsim_core.testing import InterferenceModelSuite


class TestCsmaSpatial(InterferenceModelSuite):
    component = "csma_spatial"
