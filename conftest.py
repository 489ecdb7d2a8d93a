"""Settings of all tests: no time limits on examples, since machines differ.

``--hypothesis-profile=nightly`` or ``HYPOTHESIS_PROFILE=nightly`` lets the tests that compare whole
engines look at many more scenarios.
"""

import os

from hypothesis import settings

settings.register_profile("ncsim", deadline=None)
settings.register_profile("nightly", deadline=None)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ncsim"))
