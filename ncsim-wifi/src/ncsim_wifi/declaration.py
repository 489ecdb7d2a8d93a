"""What ncsim-wifi brings."""

from collections.abc import Iterable

from ncsim_core.plugins import Component, Section, hookimpl

NCSIM_PLUGIN_API = "1.0"

PAPER = "arXiv:2605.01094, Section IV-F"


@hookimpl
def ncsim_components() -> Iterable[Component]:
    """Return the components of this package."""
    return [
        Component(
            kind="link_model",
            name="wifi",
            factory="ncsim_wifi.link_models.wifi:WifiLinkModel",
            summary="802.11 goodput from positions: path loss, rate table, overhead of access.",
            options="ncsim_wifi:schemas/wifi.json",
            capabilities=frozenset({"radio"}),
            source=PAPER,
        ),
        Component(
            kind="interference_model",
            name="csma_bianchi",
            factory="ncsim_wifi.interference_models.csma_bianchi:csma_bianchi",
            summary="Carrier sensing, Bianchi contention and hidden terminals by SINR.",
            options="ncsim_wifi:schemas/csma_bianchi.json",
            capabilities=frozenset({"needs_radio", "monotone"}),
            source=PAPER,
        ),
        Component(
            kind="interference_model",
            name="csma_spatial",
            factory="ncsim_wifi.interference_models.csma_spatial:csma_spatial",
            summary="Goodput as packets get it: occupancy, capture, hidden stations, back-off.",
            options="ncsim_wifi:schemas/csma_spatial.json",
            capabilities=frozenset({"needs_radio", "decides_routes"}),
            source="docs/csma-spatial.md",
        ),
        Component(
            kind="interference_model",
            name="proximity",
            factory="ncsim_wifi.interference_models.proximity:ProximityModel",
            summary="1/k for k active links with midpoints within a radius; no radio needed.",
            options="ncsim_wifi:schemas/proximity.json",
            capabilities=frozenset({"monotone"}),
            source="published ncsim",
        ),
        Component(
            kind="interference_model",
            name="csma_clique",
            factory="ncsim_wifi.interference_models.csma_clique:CsmaCliqueModel",
            summary="Static share by the largest clique of the conflict graph around a link.",
            capabilities=frozenset({"needs_radio", "monotone"}),
            source="published ncsim",
            expected_failures={
                "alone_a_link_keeps_its_bandwidth": (
                    "the share is static: it counts every link of the clique, active or not"
                ),
            },
        ),
        *(
            Component(
                kind="scheduler",
                name=name,
                factory="ncsim_wifi.schedulers.discounted_heft:DiscountedHeftScheduler",
                summary=summary,
                params={"discount": discount},
                capabilities=frozenset({"scale_invariant"}),
                source="ncsim",
            )
            for name, discount, summary in (
                (
                    "conflict_aware_heft",
                    "conflict_aware",
                    "HEFT on link rates discounted by the airtime of their conflict neighbourhood.",
                ),
                (
                    "uniform_discount_heft",
                    "uniform",
                    "HEFT on link rates all discounted by the mean of that discount.",
                ),
            )
        ),
    ]


@hookimpl
def ncsim_sections() -> Iterable[Section]:
    """Return the config sections of this package."""
    from ncsim_wifi.schemas import rf_schema

    return [
        Section(
            name="rf",
            summary="Parameters that all radios of the network share.",
            schema=rf_schema(),
            implies=frozenset({"radio"}),
        )
    ]
