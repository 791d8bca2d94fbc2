"""What is told to go into a container, held against where it lies in the end, as counts."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from capar.evaluation.containers import Landing, halved, landings
from capar.evaluation.evaluations import Evaluation, Scored, summed
from capar.evaluation.kinds import Kind
from capar.evaluation.metrics import rounded
from capar.evaluation.plan import Pair, Plan, Progress
from capar_rules.engine.profiles import Profile
from extractors.readers.bundle.capture_toml import read_capture


@dataclass(frozen=True)
class LandingCounts:
    """How many objects went into a container, and of how many that is told."""

    told_in: int = 0
    """It is told, and true."""

    told_wrongly: int = 0
    """It is told, and not true."""

    untold: int = 0
    """It is true, and not told."""

    out: int = 0
    """It is neither."""

    def __add__(self, other: "LandingCounts") -> "LandingCounts":
        """Both together."""
        return LandingCounts(
            self.told_in + other.told_in,
            self.told_wrongly + other.told_wrongly,
            self.untold + other.untold,
            self.out + other.out,
        )

    def scores(self) -> dict[str, Any]:
        """Counts, and the share that is right [%]."""
        total = self.told_in + self.told_wrongly + self.untold + self.out
        right = self.told_in + self.out
        return {
            "objects": total,
            "right": right,
            "went_in": self.told_in + self.untold,
            "told": self.told_in + self.told_wrongly,
            "told_wrongly": self.told_wrongly,
            "untold": self.untold,
            "accuracy": rounded(100.0 * right / total) if total else None,
        }


def score_containers(plan: Plan, base: Profile, progress: Progress) -> Evaluation:
    """Observe captures and compare the preposition *into* with the objects' first and last poses.

    Raises:
        CaparError: A capture has a fault, or no such container.
    """
    return Evaluation(
        Kind.CONTAINERS,
        tuple(_scored(pair, plan, base) for pair in progress(plan.pairs)),
        plan.groups,
    )


def count_landings(found: Iterable[Landing]) -> LandingCounts:
    """The counts of landings."""
    return sum((LandingCounts(**{_field(each): 1}) for each in found), LandingCounts())


def _field(landing: Landing) -> str:
    if landing.reported:
        return "told_in" if landing.true else "told_wrongly"
    return "untold" if landing.true else "out"


def _scored(pair: Pair, plan: Plan, base: Profile) -> Scored:
    assert plan.containers is not None, "a plan of containers names them"
    capture = read_capture(pair.capture)
    parts, notices = {}, []
    for name in plan.containers.names:
        whole, names = halved(capture, name) if plan.containers.halves else (capture, (name,))
        found = landings(whole, names, rules=base)
        parts[name] = count_landings(found)
        notices += [_shown(pair, each) for each in found if each.reported != each.true]
    notices += [each.message for each in capture.notices if each.code == "objects-left-out"]
    return Scored(pair.name, capture.times, (), parts, summed(parts.values()), (), tuple(notices))


def _shown(pair: Pair, landing: Landing) -> str:
    true = "went" if landing.true else "did not go"
    told = "is told to" if landing.reported else "is not told to"
    return f"{pair.name}: {landing.object} {true} into {landing.container} and {told}"
