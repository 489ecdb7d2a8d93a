"""What holds for declarations: the schema of the options, and the factory behind it."""

import inspect
from collections.abc import Callable, Mapping, Sequence
from typing import cast

from ncsim_core.plugins import KINDS
from ncsim_core.registry.building import imported
from ncsim_core.registry.option_schemas import properties_of, schema_fault
from ncsim_core.testing.builders import line, make_context
from ncsim_core.testing.checking import check
from ncsim_core.testing.subject import Subject


class DeclarationChecks:
    """Checks that what is declared is what is there."""

    @check(is_drawn=False, asks=False)
    def check_schema_is_portable(self, subject: Subject) -> None:
        """The options schema is valid draft-07 in the portable subset, all of it described."""
        from jsonschema import Draft7Validator

        schema = subject.registered.schema
        fault = schema_fault(schema)
        assert fault is None, fault
        Draft7Validator.check_schema(schema)
        bare = _undescribed(schema)
        assert not bare, f"options without a description: {bare}"

    @check(is_drawn=False, asks=False)
    def check_capabilities_are_known(self, subject: Subject) -> None:
        """Every capability is one that components of this kind can have."""
        known = KINDS[subject.component.kind].capabilities
        claimed = {each.partition("=")[0] for each in subject.component.capabilities}
        assert claimed <= known, (
            f"capabilities that mean nothing: {', '.join(sorted(claimed - known))}; "
            f"a {subject.component.kind} can have: {', '.join(sorted(known)) or 'none'}"
        )

    @check(is_drawn=False, asks=False)
    def check_defaults_are_the_factorys(self, subject: Subject) -> None:
        """Every option that may be left out has a valid default, equal to the factory's."""
        from jsonschema import Draft7Validator

        schema = subject.registered.schema
        parameters = inspect.signature(_factory(subject)).parameters
        for name, child in properties_of(schema).items():
            if name in cast("Sequence[str]", schema.get("required", ())):
                continue
            assert "default" in child, f"option {name!r} may be left out and has no default"
            Draft7Validator(child).validate(child["default"])
            parameter = parameters.get(name)
            if parameter is not None and parameter.default is not inspect.Parameter.empty:
                assert parameter.default == child["default"], (
                    f"option {name!r}: the schema says {child['default']!r}, "
                    f"the factory {parameter.default!r}"
                )

    @check(is_drawn=False, asks=False)
    def check_factory_takes_every_option(self, subject: Subject) -> None:
        """The factory accepts the context, its params and every option by name."""
        options = dict.fromkeys(properties_of(subject.registered.schema))
        params = subject.component.params
        both = sorted(options.keys() & params.keys())
        assert not both, f"options that are params as well: {both}"
        context = make_context(line(2))
        try:
            inspect.signature(_factory(subject)).bind(context, **params, **options)
        except TypeError as error:
            raise AssertionError(
                f"{subject.component.factory} must take a context and, by name, the declared "
                f"options ({', '.join(options) or 'none'}) and params "
                f"({', '.join(params) or 'none'}): {error}"
            ) from None


def _factory(subject: Subject) -> Callable[..., object]:
    return imported(subject.registered, subject.identity)


def _undescribed(schema: Mapping[str, object], where: str = "") -> list[str]:
    """Return the properties without a description, those of objects inside included."""
    bare: list[str] = []
    for name, child in properties_of(schema).items():
        here = f"{where}{name}"
        if not child.get("description"):
            bare.append(here)
        bare += _undescribed(child, f"{here}.")
    return bare
