"""A pytest plug-in that runs tests on broken functions, to see which tests would notice.

Loaded with ``-p breaking`` by ``test_equations.py``. ``BREAK`` holds ``[[function, test], ...]``
as JSON, functions as ``module:qualified.name``. Every collected test is run once per function
named with it, while that function raises; the pairs that failed, as they should, are written
to the file ``NOTICED``.
"""

import functools
import gc
import importlib
import inspect
import json
import os
from pathlib import Path

import pytest
from hypothesis import Phase, settings

BROKEN = "broken on purpose"
NOTICED = []

settings.register_profile("breaking", deadline=None, phases=[Phase.explicit, Phase.generate])


def function_of(name):
    """Return the plain function behind ``module:qualified.name``."""
    module, _, path = name.partition(":")
    found = importlib.import_module(module)
    for step in path.split("."):
        found = getattr(found, step)
    return inspect.unwrap(found)


def _raise(*_, **__):
    raise AssertionError(BROKEN)


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem):
    names = pyfuncitem.nodeid, pyfuncitem.nodeid.partition("[")[0]
    arguments = {name: pyfuncitem.funcargs[name] for name in pyfuncitem._fixtureinfo.argnames}
    for function, named in json.loads(os.environ["BREAK"]):
        if named in names and _is_noticed(function_of(function), pyfuncitem.obj, arguments):
            NOTICED.append([function, named])
    return True


def _is_noticed(function, test, arguments):
    """Return whether a test fails while a function, however it was imported, only raises."""
    for each in gc.get_objects():
        if isinstance(each, functools._lru_cache_wrapper):
            each.cache_clear()
    whole = function.__code__
    function.__code__ = _raise.__code__
    try:
        test(**arguments)
    except Exception:
        return True
    finally:
        function.__code__ = whole
    return False


def pytest_sessionfinish():
    Path(os.environ["NOTICED"]).write_text(json.dumps(NOTICED), "utf-8")
