"""Declares one planted component per check, under the name of the check that must catch it."""

from collections.abc import Iterable

from ncsim_core.plugins import KINDS, Component, hookimpl

NCSIM_PLUGIN_API = "1.0"

LEVEL = {"type": "integer", "default": 2, "description": "Levels."}

OPTIONS_OF_FLAW = {
    "schema_is_portable": {"level": {"type": "integer", "default": 2}},
    "capabilities_are_known": {"level": LEVEL},
    "defaults_are_the_factorys": {"level": {**LEVEL, "default": 3}},
    "factory_takes_every_option": {"level": LEVEL, "depth": {**LEVEL, "default": 1}},
    "same_question_same_answer": {},
    "global_generators_stay_untouched": {},
    "arguments_stay_unchanged": {},
    "pickled_copy_gives_same_answer": {},
    "hash_seed_changes_nothing": {},
    "runs_obey_the_rules": {},
    "equal_runs_leave_equal_traces": {},
}

CLASSES = {
    "scheduler": {
        "plan_is_total": (),
        "planned_nodes_exist": (),
        "extremes_are_planned": (),
        "scaling_changes_nothing": ("scale_invariant",),
    },
    "routing_model": {
        "routes_are_chains": (),
        "route_to_itself_is_empty": (),
        "there_is_a_route_if_there_can_be": (),
        "listing_order_changes_nothing": (),
        "routes_from_equals_route": (),
        "routes_are_optimal": ("objective=latency",),
        "pure_routes_follow_from_the_network": ("pure",),
    },
    "link_model": {
        "every_link_is_rated": (),
        "rates_are_ordinary_numbers": (),
        "listing_order_changes_nothing": (),
    },
    "interference_model": {
        "factors_are_shares": (),
        "alone_a_link_keeps_its_bandwidth": (),
        "order_of_links_changes_nothing": (),
        "asking_for_fewer_changes_nothing": (),
        "reach_holds_what_changed": (),
        "out_of_reach_nothing_changes": (),
        "session_equals_global_refresh": (),
        "tables_equal_plain_form": (),
        "local_refresh_equals_global": (),
        "sessions_do_not_meet": (),
        "competition_can_be_explained": (),
        "one_more_link_never_helps": ("monotone",),
        "deciding_routes_is_declared": (),
        "route_rates_fit_their_links": ("decides_routes",),
        "alone_a_route_keeps_its_bandwidth": ("decides_routes",),
        "order_of_routes_changes_nothing": ("decides_routes",),
        "route_rates_have_no_memory": ("decides_routes",),
        "moving_few_routes_equals_moving_all": ("decides_routes",),
    },
    "queue_model": {
        "nothing_is_lost_or_invented": (),
        "declared_order_is_kept": ("order=fifo",),
        "pop_of_nothing_is_an_index_error": (),
        "queues_do_not_meet": (),
        "equal_runs_leave_equal_traces": (),
    },
    "dag_source": {
        "injections_end": (),
        "times_never_decrease": (),
        "dag_ids_are_unique": (),
    },
}


@hookimpl
def ncsim_components() -> Iterable[Component]:
    """Return all planted components."""
    for kind in KINDS:
        flaws = [flaw for flaw in OPTIONS_OF_FLAW if flaw not in CLASSES[kind]]
        yield from (_with_flaw(kind, flaw) for flaw in flaws)
        for name, capabilities in CLASSES[kind].items():
            yield Component(
                kind=kind,
                name=name,
                factory=f"ncsim_planted.{kind}s:{_class_name(name)}",
                summary="Planted.",
                capabilities=frozenset(capabilities),
            )


def _with_flaw(kind: str, flaw: str) -> Component:
    properties = OPTIONS_OF_FLAW[flaw]
    return Component(
        kind=kind,
        name=flaw,
        factory="ncsim_planted.flaws:make" if properties else "ncsim_planted.flaws:make_flawed",
        summary="Planted.",
        options={"type": "object", "properties": properties, "additionalProperties": False},
        params={"kind": kind} if properties else {"kind": kind, "flaw": flaw},
        capabilities=frozenset({"monoton"} if flaw == "capabilities_are_known" else ()),
    )


def _class_name(name: str) -> str:
    return "".join(word.capitalize() for word in name.split("_"))
