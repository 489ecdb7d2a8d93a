"""Names in figures."""


def plain(name: str) -> str:
    r"""Return a name that matplotlib does not take for a formula.

    >>> plain("a$b")
    'a\\$b'
    """
    return name.replace("$", r"\$")
