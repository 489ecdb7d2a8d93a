from dataclasses import replace

from ncsim_core.context import BuildContext, ModelCache
from ncsim_core.testing.builders import line


def kept(cache, keys):
    """Return which of ``keys`` a cache still holds; asking for the others changes nothing."""
    return [key for key in keys if key in cache._entries]


def test_a_value_is_built_once_and_the_least_recently_used_goes_first():
    cache, built = ModelCache(max_entries=2), []
    for key in ("a", "b", "a", "c", "a"):
        cache.get_or_build(key, lambda key=key: built.append(key))

    assert built == ["a", "b", "c"]
    assert kept(cache, "abc") == ["a", "c"]


def test_heavy_values_make_room_for_each_other_and_the_latest_always_stays():
    cache = ModelCache(max_weight=10)
    for key, weight in (("light", 1), ("heavy", 6), ("other", 5)):
        cache.get_or_build(key, object, weight)

    assert kept(cache, ["light", "heavy", "other"]) == ["other"]

    cache.get_or_build("enormous", object, 99)

    assert kept(cache, ["other", "enormous"]) == ["enormous"]


def test_a_value_of_none_is_kept_like_any_other():
    cache, built = ModelCache(), []

    assert cache.get_or_build("nothing", lambda: built.append(1)) is None
    assert cache.get_or_build("nothing", lambda: built.append(2)) is None
    assert built == [1]


def test_networks_of_many_links_leave_the_cache_sooner():
    cache = ModelCache(max_weight=20)
    small, large = line(2), line(3)
    for network in (small, large, replace(small, links=small.links[:1])):
        BuildContext(network, cache=cache).cached("model", object)

    assert [len(topology.links) for topology, _ in cache._entries] == [4, 1]
