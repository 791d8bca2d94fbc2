"""An evaluation as a value: what was counted, by capture, by part and pooled; and as JSON."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce
from operator import add
from typing import Any, Protocol, Self

import numpy as np
from jaxtyping import Float

from capar.evaluation.comparisons import Channel, Difference, differences, worst
from capar.evaluation.labels import Kind
from capar.evaluation.metrics import MATCH_AT

PARTS = {
    Kind.ACTIONS: "links",
    Kind.CONTACTS: "bodies",
    Kind.CARRIES: "objects",
    Kind.EVENTS: "events",
    Kind.CONTAINERS: "containers",
}
"""What is scored on its own beside the whole."""

WORST = 20
"""So many differences are listed."""


class Counts(Protocol):
    """What is counted of one part of a capture; counts of several add up before they are scored."""

    def __add__(self, other: Self) -> Self:
        """Both together."""
        ...

    def scores(self) -> dict[str, Any]:
        """The scores that follow, as plain values."""
        ...


@dataclass(frozen=True)
class Scored:
    """One capture held against its labels."""

    name: str
    times: Float[np.ndarray, "frames"]
    """Time of each frame [s]."""

    channels: tuple[Channel, ...]
    parts: Mapping[str, Any]
    """Counts of each part."""

    whole: Any
    """Counts of the capture."""

    unlabelled: tuple[str, ...] = ()
    """Parts that were observed and have no labels."""

    notices: tuple[str, ...] = ()


@dataclass(frozen=True)
class Evaluation:
    """Captures held against their labels."""

    kind: Kind
    captures: tuple[Scored, ...]
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Names of captures that are also scored on their own."""

    notices: tuple[str, ...] = ()
    """What is odd about labels and mapping."""

    @property
    def cases(self) -> tuple[str, ...]:
        """Names of the captures."""
        return tuple(each.name for each in self.captures)

    @property
    def links(self) -> Mapping[str, Any]:
        """Counts of each part, pooled over captures."""
        return _parts(self.captures)

    @property
    def whole(self) -> Any:
        """Counts of everything together."""
        return _whole(self.captures)

    @property
    def unlabelled(self) -> tuple[str, ...]:
        """Parts that were observed and bear no labels in any of the files: not counted."""
        found = {name for each in self.captures for name in each.unlabelled}
        return tuple(sorted(found - set(self.links)))

    def differences(self) -> tuple[Difference, ...]:
        """Every stretch in which something else was found than is labelled."""
        return tuple(
            found
            for each in self.captures
            for found in differences(each.name, each.channels, each.times)
        )


def report(evaluation: Evaluation) -> dict[str, Any]:
    """An evaluation as plain values, for JSON."""
    part = PARTS[evaluation.kind]
    return {
        "kind": str(evaluation.kind),
        "captures": list(evaluation.cases),
        "matched_at_percent": MATCH_AT,
        **_scores(part, evaluation.captures),
        "groups": {
            name: {
                "captures": list(members),
                **_scores(part, [each for each in evaluation.captures if each.name in members]),
            }
            for name, members in evaluation.groups.items()
        },
        "by_capture": {each.name: _scores(part, [each]) for each in evaluation.captures},
        "worst": [
            {
                "capture": each.capture,
                "channel": each.channel,
                "start_s": round(each.start_s, 3),
                "end_s": round(each.end_s, 3),
                "true": each.true,
                "found": each.found,
                "segments": each.said,
            }
            for each in worst(evaluation.differences(), most=WORST)
        ],
        f"unlabelled_{part}": list(evaluation.unlabelled),
        "notices": [*evaluation.notices, *(n for c in evaluation.captures for n in c.notices)],
    }


def summed(counts: Iterable[Any]) -> Any:
    """Counts of several together."""
    return reduce(add, counts)


def _scores(part: str, captures: Sequence[Scored]) -> dict[str, Any]:
    return {
        part: {name: counts.scores() for name, counts in _parts(captures).items()},
        "all": _whole(captures).scores(),
    }


def _parts(captures: Sequence[Scored]) -> dict[str, Any]:
    names = sorted({name for each in captures for name in each.parts})
    return {
        name: summed(each.parts[name] for each in captures if name in each.parts) for name in names
    }


def _whole(captures: Sequence[Scored]) -> Any:
    return summed(each.whole for each in captures)
