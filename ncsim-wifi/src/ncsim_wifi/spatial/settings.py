"""What the model is told besides the links: physics, approximations, terms to leave out."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Terms:
    """Which effects count. Physical ones are on, artefacts of packet simulators are off.

    Args:
        same_slot_collisions: Stations that sense each other may start in the same slot.
        hidden_loss: Stations that do not sense each other destroy frames.
        joint_interference: Several weak interferers act together.
        joint_chains: Back-off stages of two stations that hurt each other are correlated.
        helpers_by_stage: So is how active those are that harm a third together.
        ack_loss: Acknowledgements of hidden links destroy frames.
        silence: Who does not understand a frame waits another time after it (EIFS).
        energy_sensing: Stations too weak to be sensed alone are sensed together.
        far_noise: Interferers beyond the nearest raise the noise.
        dead_below_threshold: Simulator artefact: links below the preamble threshold get nothing.
        lost_signal_field: Simulator artefact: who loses a signalling field finds the channel idle.
    """

    same_slot_collisions: bool = True
    hidden_loss: bool = True
    joint_interference: bool = True
    joint_chains: bool = True
    helpers_by_stage: bool = True
    ack_loss: bool = True
    silence: bool = True
    energy_sensing: bool = True
    far_noise: bool = True
    dead_below_threshold: bool = False
    lost_signal_field: bool = False


@dataclass(frozen=True)
class Approximations:
    """Where the model stops counting, and its calibrated constants.

    Source: MODEL 4.

    Args:
        near_count: Interferers of a link that are looked at one by one.
        helper_count: Stronger interferers that may act together with one of them.
        energy_count: Stations whose powers may add up to a busy channel.
        min_kill: An interferer that destroys fewer frames than this is left out.
        max_sets: Independent sets up to which the occupancy is exact.
        iterations: Steps of the fixed point. Part of the model: see docs/csma-spatial.md.
        stage_gain: How far stages move towards their new value in a step.
        gain: The same for everything else.
        energy_tail_us: Calibrated: how long summed power keeps a station silent after a frame.
        ack_weight: Calibrated: harm of acknowledgements under RTS/CTS.
        overlap_scale: Calibrated: length of the overlap in which a helper counts.
        ack_extension_kill: Calibrated: harm from which an acknowledgement prolongs its frame.
        helper_cycle_us: Calibrated: how long summed power protects a frame.
    """

    near_count: int = 8
    helper_count: int = 4
    energy_count: int = 6
    min_kill: float = 0.06
    max_sets: int = 1500
    iterations: int = 8
    stage_gain: float = 0.8
    gain: float = 0.5
    energy_tail_us: float = 43.0
    ack_weight: float = 1.5
    overlap_scale: float = 0.8
    ack_extension_kill: float = 0.6
    helper_cycle_us: float = 390.0


@dataclass(frozen=True)
class Settings:
    """Everything that is the same for all links.

    Args:
        noise_dBm: Noise floor.
        sensing_dBm: Power at which a station finds the channel busy.
        preamble_dBm: Weakest frame that a receiver can lock on.
        preamble_ratio_dB: Ratio needed to lock on a frame.
        rts_cts: Whether RTS and CTS precede data.
        terms: Which effects count.
        approximations: Where the model stops counting.
    """

    noise_dBm: float = -95.0
    sensing_dBm: float = -82.0
    preamble_dBm: float = -82.0
    preamble_ratio_dB: float = 4.0
    rts_cts: bool = False
    terms: Terms = field(default_factory=Terms)
    approximations: Approximations = field(default_factory=Approximations)
