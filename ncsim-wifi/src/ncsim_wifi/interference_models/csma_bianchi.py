"""The interference model ``csma_bianchi``: which rule it follows is an option."""

from typing import Literal, NamedTuple, TypeAlias

from ncsim_core.context import BuildContext
from ncsim_core.contracts.interference_model import InterferenceModel

from ncsim_wifi.conflict import Relations, relations
from ncsim_wifi.interference_models.effective_rate import EffectiveRateModel
from ncsim_wifi.interference_models.fixed_capture import FixedCaptureModel
from ncsim_wifi.levels import levels_of
from ncsim_wifi.mac.timing import AxTiming
from ncsim_wifi.propagation import is_on_air, propagation, require_positions
from ncsim_wifi.radio import Radio
from ncsim_wifi.shares import Shares

HiddenModel: TypeAlias = Literal["effective_rate", "fixed_capture"]
Components: TypeAlias = Literal["combined", "contention_only", "hidden_only"]


def csma_bianchi(
    context: BuildContext,
    *,
    hidden_model: HiddenModel = "effective_rate",
    components: Components = "combined",
    outage_floor_factor: float = 0.0,
) -> InterferenceModel:
    """Return the model of carrier sensing, contention and hidden terminals.

    Models are pure, so the runs of a process share one per network and options.

    Args:
        context: Network and config section ``rf``.
        hidden_model: What hidden interferers do: lower the rate, or destroy frames.
        components: Leave out hidden interference or contention to see what the other does.
        outage_floor_factor: The least factor that an active link is given; 0 is none.

    Raises:
        ScenarioError: Wireless links lack positions; all of them are named.
    """
    radio = Radio.from_section(context.section("rf"))
    options = Options(hidden_model, components, outage_floor_factor)
    return context.cached(
        ("ncsim_wifi.csma_bianchi", radio, radio.draws_from(context.seed), options),
        lambda: _build(context, radio, options),
    )


class Options(NamedTuple):
    """The options of ``csma_bianchi``, described there."""

    hidden_model: HiddenModel
    components: Components
    outage_floor_factor: float


def _build(context: BuildContext, radio: Radio, options: Options) -> InterferenceModel:
    network = context.network
    on_air = [index for index, link in enumerate(network.links) if is_on_air(link)]
    require_positions(network, on_air, "interference csma_bianchi")
    related = _ablated(relations(context, radio), options.components)
    signals = propagation(context, radio)
    shares = Shares(AxTiming(radio.rts_cts), options.outage_floor_factor)
    if options.hidden_model == "fixed_capture":
        return FixedCaptureModel(network.links, related, signals, radio, shares)
    return EffectiveRateModel(related, levels_of(signals, radio), shares)


def _ablated(related: Relations, components: Components) -> Relations:
    match components:
        case "combined":
            return related
        case "contention_only":
            return related.where(related.is_conflict)
        case "hidden_only":
            return related.where(~related.is_conflict)
