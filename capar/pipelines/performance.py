"""A recorded action performed once more: by which body, where, and in which manner."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from capar.body.human import Human
from capar.pipelines.preparation import asserted
from capar.pipelines.recordings import Performed
from capar.pipelines.round_trips import by_hand, observed_source
from capar.regeneration.efforts import Effort, regenerate_in_manner
from capar.regeneration.forces import ForceKind
from capar.regeneration.quality import Quality, contact_gate
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source
from capar.regeneration.stepping import Approach, approached
from capar.regeneration.styles import Kind, borrowed_style, own_style


@dataclass(frozen=True)
class Manner:
    """How a recorded action is performed; by default just as it was recorded."""

    kind: Kind = Kind.PATH
    style_of: str = ""
    """A capture whose style is taken; empty for its own."""

    duration_s: float | None = None
    hand: str = ""
    """Which hand does it; empty for the recorded one."""

    effort: Effort | None = None
    force: ForceKind = ForceKind.SIMILAR
    step: bool = False
    """Whether steps may be taken to what is out of reach."""


def perform_recorded(
    source: Source,
    human: Human,
    where: Scene,
    manner: Manner,
    names: Mapping[str, str] | None = None,
) -> tuple[Approach | None, Performed]:
    """Perform an action from the given place, or, if steps may be taken, from where they lead.

    Args:
        source: What was recorded.
        human: The body that performs it.
        where: The scene in which it does.
        manner: How.
        names: What the scene calls the objects; with them contacts are checked as the action
            asserts them, and the source is by the right hand already.

    Raises:
        PlanError: It is out of reach, and no step helps.
    """
    hand = manner.hand
    assertions = asserted(source) if names is not None else None
    source = by_hand(source, hand) if hand and names is None else source
    style = own_style(source, manner.kind)
    if manner.style_of:
        other = observed_source(manner.style_of)
        style = borrowed_style(source, by_hand(other, hand) if hand else other, manner.kind)
    style = replace(style, force=manner.force)

    def act(there: Scene) -> tuple[Performed, Quality]:
        motion, quality, report = regenerate_in_manner(
            source, human, there, style, effort=manner.effort, duration_s=manner.duration_s
        )
        if assertions is not None:
            gate = contact_gate(motion, assertions)
            quality = Quality((*quality.gates, gate), quality.told)
        return Performed(motion, quality, names or {}, report), quality

    if not manner.step:
        return None, act(where)[0]
    stepped, done, _ = approached(source, human, where, style, act)
    return stepped, done
