"""What happened, for observers who are told later."""

from ncsim_core.compiling import inlined
from ncsim_core.engine.compiled.layout import assigned_at, happened_at, link_at, load_at, move_at
from ncsim_core.engine.compiled.radio import level_of
from ncsim_core.engine.compiled.records import Record


@inlined
def log_event(state: Record) -> None:
    """Note the event that is about to be handled."""
    entry = happened_at(state.happened_count, state)
    entry.at_us, entry.kind, entry.number = state.due_us, state.due_kind, state.due_number
    entry.moves = 0
    state.happened_count += 1


@inlined
def has_room(state: Record) -> bool:
    """Return whether one more event fits, whatever rates it moves."""
    most_moves = state.flows + 1 if state.shows_rates else 0
    fits: bool = state.assigned_count + most_moves <= state.assigned_most
    return fits and state.happened_count < state.happened_most


@inlined
def log_rates(state: Record) -> None:
    """Note the new rates and what explains them."""
    for k in range(state.moves_count):
        move, entry = move_at(k, state), assigned_at(state.assigned_count, state)
        entry.transfer, entry.rate_MBps = move.transfer, move.rate_MBps
        entry.bottleneck, entry.flows = move.bottleneck, link_at(move.bottleneck, state).flows
        if state.has_radio:
            link = move.bottleneck
            entry.contenders = load_at(link, state).number >> state.count_shift
            entry.hidden = link_at(link, state).heard - entry.contenders
            entry.level = level_of(link, state)
        state.assigned_count += 1
    happened_at(state.happened_count - 1, state).moves = state.moves_count
