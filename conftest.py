"""Settings of all tests: no time limits on examples, since machines differ."""

from hypothesis import settings

settings.register_profile("ncsim", deadline=None)
settings.load_profile("ncsim")
