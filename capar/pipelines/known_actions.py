"""The recording by which an action of the Actionary is performed."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from capar.model.errors import UnknownNameError
from capar.pipelines.recordings import Recording


@dataclass(frozen=True)
class KnownAction:
    """An action, the recording that holds it, and the others that do."""

    name: str
    recording: Recording
    others: tuple[str, ...]
    whole: bool
    """Whether it is the recording as a whole, and no step of it."""


def find_action(
    name: str, recordings: Sequence[Recording], roles: Iterable[str] = ()
) -> KnownAction:
    """The recording that holds an action: as a whole, else as a step or a more special one.

    Of several, those with things of the stated names count first, then the one with the fewest
    steps of all hands, then the first by name.

    Args:
        name: Of the action, a recorded one or a primitive.
        recordings: What can be performed.
        roles: Names of recorded things that it has to have.

    Raises:
        UnknownNameError: No recording holds it.
    """
    wanted = set(roles)
    whole = [one for one in recordings if name.lower() in {one.name.lower(), one.par.name.lower()}]
    found = whole or [one for one in recordings if any(one.fits(s, name) for s in one.steps)]
    if not found:
        raise UnknownNameError("recorded action", name, _names(recordings))
    found.sort(key=lambda one: (len(wanted - set(one.par.objects)), len(one.steps), one.name))
    others = tuple(one.name for one in found[1:])
    return KnownAction(name, found[0], others, bool(whole))


def _names(recordings: Sequence[Recording]) -> set[str]:
    """Every action that can be performed: recordings, their steps, and what these are cases of."""
    steps = {step.action for one in recordings for step in one.steps}
    general = {name for one in recordings for step in steps for name in one.general.get(step, ())}
    return steps | general | {one.par.name for one in recordings}
