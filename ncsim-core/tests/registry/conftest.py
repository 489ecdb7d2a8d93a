"""Fixtures of the registry's tests."""

from ncsim_core.testing.fixtures import fake_dist

__all__ = ["fake_dist"]
