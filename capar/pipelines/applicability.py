"""Whether an action is applicable: what agents and kinds of objects are declared able to do."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from capar.model.par import ComplexPar, Step
from capar.regeneration.errors import PlanError
from kb.findings import Ability

Abilities = Callable[[str], tuple[Ability, ...]]
"""What is declared or observed of an agent or a kind, those of more general kinds included."""


@dataclass(frozen=True)
class Applied:
    """An action that is to be performed: by whom, on what, in which steps."""

    action: str
    par: ComplexPar
    steps: tuple[Step, ...]
    general: Mapping[str, frozenset[str]]
    """The more general actions above each step's."""

    agent: tuple[str, ...]
    """Who performs: the name, and the kind if that is another."""

    kinds: Mapping[str, str]
    """What takes the part of each recorded thing, by its kind."""


def check_applicable(applied: Applied, abilities: Abilities) -> tuple[str, ...]:
    """Check that what is declared does not rule the action out (thesis 4.6.1.4).

    What an agent or a kind was declared able to do is all that it is able to do, beside what it
    was observed to do. Of whom nothing is declared, nothing is ruled out, which is returned as a
    note. An ability to do a more general action, or the whole one, holds for its steps.

    Raises:
        PlanError: Somebody or something is not able to; the message says what would declare it.
    """
    notes = []
    doing = [step.action for step in applied.steps]
    able = _declared(applied.agent, abilities)
    if able is None:
        notes.append(f"of {applied.agent[0]!r} no ability is declared, so none is ruled out")
    else:
        _check(applied, applied.agent[0], "agent", doing, able)
    for part, kind in applied.kinds.items():
        undergone = [step.action for step in applied.steps if part in step.objects]
        able = _declared((kind,), abilities)
        if undergone and able is not None:
            _check(applied, kind, "object", undergone, able)
    return tuple(notes)


def _declared(whose: tuple[str, ...], abilities: Abilities) -> frozenset[str] | None:
    """What they can do, if anything of it was declared."""
    known = [one for name in whose for one in abilities(name)]
    if not any(one.evidence == "declared" for one in known):
        return None
    return frozenset(one.action for one in known)


def _check(
    applied: Applied, who: str, command: str, actions: Iterable[str], able: frozenset[str]
) -> None:
    if able.intersection({applied.action, applied.par.name}):
        return
    lacking = [
        action
        for action in dict.fromkeys(actions)
        if not able.intersection({action, *applied.general.get(action, ())})
    ]
    if lacking:
        raise PlanError(
            f"capable({who}, {lacking[0]}) does not hold: {who!r} is declared able to do "
            f"{', '.join(sorted(able))}, and {applied.action!r} takes {', '.join(lacking)}; "
            f"`capar {command} can {who} {' '.join(lacking)}` would declare it"
        )
