"""Which facts decided a segment's name: each is taken away, and the segment is named again.

A fact that an explanation rests on decided, so without it name or explanation are others; whatever
gives the segment another name, if it is taken away, decided too, and the explanation rests on it.

Both are asked of the rules alone: facts as they were reasoned with, less one, the borders numbered
anew. What holds of the whole recording (its frames, its rate, its links) is no fact of a segment.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

from case_batches import solve_batch

from capar.model.errors import RuleError
from capar.model.facts import MEASURED, Fact, FactIntervals, Frames, Link, RateMhz
from capar.model.observation import Segment
from capar_rules.borders.border_numbers import Tick, number_borders
from capar_rules.engine.profiles import Profile
from capar_rules.engine.syntax import split_arguments
from capar_rules.explain.explanation import Explainer

WHOLE = (Frames, RateMhz, Link)
"""Kinds of facts without which there is no segment to ask about."""

BATCH = 250
"""How many worlds are grounded at once; what the rules cost to read is shared by them."""

Step = tuple[int, int, tuple[str, ...], tuple[str, ...]]
"""First and last frame of a segment, its names, and its objects in order."""


class Loss(Enum):
    """What becomes of a segment without a fact."""

    NOTHING = "nothing"
    """Name, objects and borders are as they were."""

    TOLD = "told"
    """... but the explanation is another."""

    BORDER = "border"
    """A border of it is elsewhere; what has most of its time has its name and objects."""

    OBJECTS = "objects"
    """What has most of its time has its name and other objects."""

    NAME = "name"
    """What has most of its time has another name."""


@dataclass(frozen=True)
class Removal:
    """A fact about a segment, whether its explanation rests on it, and what its loss changes."""

    fact: Fact
    cited: bool
    loss: Loss

    @property
    def untold(self) -> bool:
        """Whether it decided the name, and the explanation leaves it out."""
        return not self.cited and self.loss is Loss.NAME

    @property
    def idle(self) -> bool:
        """Whether the explanation rests on it, and without it everything is the same."""
        return self.cited and self.loss is Loss.NOTHING


@dataclass(frozen=True, eq=False)
class Asked:
    """A segment, and the facts that are taken away from what it was named by, one by one."""

    segment: Segment
    told: Mapping[str, str]
    """The atoms on which its explanation rests, with their sentences; some have none."""

    facts: tuple[Fact, ...]
    """Measured facts about it and what is around it, which give it its name."""

    removed: tuple[Fact, ...]
    """Those that share time with it, or always hold."""


def asked(explainer: Explainer, segment: Segment, rules: Profile) -> Asked:
    """Make ready to ask what decided a segment.

    Raises:
        RuleError: The measured facts alone do not give the segment its name.
    """
    told = explanation(explainer, segment)
    for window in explainer.windows_of(segment.ee, explainer.ticks(segment)):
        facts = tuple(each for each in window if isinstance(each, MEASURED))
        (steps,) = _steps([(segment.ee, facts)], rules)
        if _step(segment) in steps:
            return Asked(segment, told, facts, tuple(_meanwhile(facts, segment)))
    raise RuleError(f"{segment.ee}/{segment.index} does not follow from what was measured")


def removals(wanted: Sequence[Asked], rules: Profile) -> list[list[Removal]]:
    """For each of some segments, what the loss of each fact about it changes."""
    worlds = [(number, fact) for number, each in enumerate(wanted) for fact in each.removed]
    found: list[list[Removal]] = [[] for _ in wanted]
    for begin in range(0, len(worlds), BATCH):
        batch = worlds[begin : begin + BATCH]
        cases = [(wanted[number].segment.ee, _less(wanted[number], fact)) for number, fact in batch]
        for (number, fact), steps in zip(batch, _steps(cases, rules), strict=True):
            one = wanted[number]
            cited = str(fact) in one.told
            loss = _loss(one.segment, steps)
            if cited and loss is Loss.NOTHING:
                loss = _told(one, fact, rules)
            found[number].append(Removal(fact, cited, loss))
    return found


def _less(one: Asked, fact: Fact) -> tuple[Fact, ...]:
    return tuple(each for each in one.facts if each != fact)


def _meanwhile(facts: Sequence[Fact], segment: Segment) -> Iterator[Fact]:
    """The facts that always hold or share time with a segment."""
    intervals = FactIntervals(facts)
    for fact in facts:
        span = intervals.of(fact)
        if not isinstance(fact, WHOLE) and (
            span is None or (span[0] <= segment.last and segment.first <= span[1])
        ):
            yield fact


def _told(one: Asked, fact: Fact, rules: Profile) -> Loss:
    """Whether a segment that keeps its name without a fact is explained in other words."""
    told = explanation(Explainer(_less(one, fact), rules), one.segment)
    same = set(filter(None, told.values())) == set(filter(None, one.told.values()))
    return Loss.NOTHING if same else Loss.TOLD


def explanation(explainer: Explainer, segment: Segment) -> dict[str, str]:
    """The atoms on which a segment's explanation rests, each once, with their sentences."""
    told: dict[str, str] = {}
    waiting = [explainer.explain(segment).reason]
    while waiting:
        each = waiting.pop()
        if each.atom not in told:
            told[each.atom] = each.sentence
            waiting += each.because
    return told


def _loss(segment: Segment, steps: Sequence[Step]) -> Loss:
    mine = _step(segment)
    if mine in steps:
        return Loss.NOTHING
    most = max(steps, key=lambda each: min(each[1], mine[1]) - max(each[0], mine[0]))
    if most[2] != mine[2]:
        return Loss.NAME
    return Loss.OBJECTS if most[3] != mine[3] else Loss.BORDER


def _step(segment: Segment) -> Step:
    names = (segment.name, *segment.candidates) if segment.known else ()
    return segment.first, segment.last, names, segment.objects


def _steps(cases: Sequence[tuple[str, Sequence[Fact]]], rules: Profile) -> list[list[Step]]:
    """The segments of an end-effector by each of several sets of measured facts."""
    numbered = [number_borders(facts, crossings_only=rules.crossings_only) for _, facts in cases]
    worlds = [(*facts, *more) for (_, facts), more in zip(cases, numbered, strict=True)]
    answers = solve_batch(rules.files, worlds)
    return [
        list(_read(answer, ee, _frames(more, ee)))
        for (ee, _), more, answer in zip(cases, numbered, answers, strict=True)
    ]


def _frames(numbered: Iterable[Fact], ee: str) -> dict[str, int]:
    ticks = (each for each in numbered if isinstance(each, Tick) and each.ee == ee)
    return {str(each.tick): each.frame for each in ticks}


def _read(atoms: Iterable[str], ee: str, frames: Mapping[str, int]) -> Iterator[Step]:
    """The segments of an end-effector that an answer tells."""
    table: dict[str, dict[str, list[list[str]]]] = {}
    for name in ("segment", "named", "object_at"):
        rows: dict[str, list[list[str]]] = defaultdict(list)
        for atom in sorted(atoms):
            if atom.startswith(f"{name}(seg({ee},"):
                term, *rest = split_arguments(atom)
                rows[term].append(rest)
        table[name] = rows
    for term, ((first, last),) in table["segment"].items():
        names = tuple(each.strip('"') for (each,) in table["named"][term])
        objects = tuple(each for _, each in sorted(table["object_at"][term]))
        yield frames[first], frames[last], names, objects
