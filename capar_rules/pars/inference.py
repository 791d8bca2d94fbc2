"""Segments inferred from facts by the rules, and the actions that several links do jointly."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

from capar.model.facts import Fact, Frames, Link, OfAgent, RateMhz
from capar.model.observation import (
    SEGMENT_RELATIONS,
    Border,
    JointAction,
    ObservedLink,
    Segment,
    SegmentRelation,
)
from capar.model.par import UNKNOWN, FeatureSet
from capar_rules.borders.numbering import Tick, number_borders
from capar_rules.engine.profiles import Profile
from capar_rules.engine.solver import Answer, Term, asking, solve


def joint_actions(
    answer: Answer, segments: Mapping[tuple[str, int], Segment], *, rate_hz: float
) -> tuple[JointAction, ...]:
    """The joint actions of an answer, in order of time.

    ``answer``: what the rules derived.
    """
    parts: dict[Any, list[Segment]] = defaultdict(list)
    for joint, term in answer.of("takes_part"):
        assert isinstance(term, tuple)
        parts[joint].append(segments[str(term[1]), int(str(term[2]))])
    found = []
    for joint, name in answer.of("acts_jointly"):
        own = sorted(parts[joint], key=lambda each: each.ee)
        _, shared, first, last = cast("tuple[str, str, int, int]", joint)
        others = [
            each
            for each in own[0].objects
            if each != shared and all(each in part.objects for part in own)
        ]
        found.append(
            JointAction(
                name=str(name),
                objects=(shared, *others),
                ees=tuple(each.ee for each in own),
                segments=tuple(each.index for each in own),
                first=first,
                last=last,
                start_s=first / rate_hz,
                end_s=last / rate_hz,
            )
        )
    return tuple(sorted(found, key=lambda each: (each.first, each.last, each.objects)))


LEVELS = ("", "rel_start", "rel_end", "change_loc", "force")
"""Features by their level in the decision tree, from 1 (thesis Fig 4.14)."""

Key = tuple[str, int]
"""A segment: its end-effector, and its index in the link."""

Pair = tuple[int, int]
"""A relation: positions of objects, -1 the end-effector."""


@dataclass(frozen=True)
class Conditions:
    """What the rules derive of a segment for its PAR, over positions of objects."""

    needs: tuple[tuple[Pair | None, str, tuple[int, ...]], ...]
    """A relation, or None for the posture; the action that makes it hold; its objects."""

    ends_when: tuple[tuple[Pair | None, bool], ...]
    """A relation and whether it holds, or None for the duration."""

    afterwards: tuple[tuple[Pair, bool], ...]
    colliding: Pair


@dataclass(frozen=True)
class Inference:
    """What the rules say of a capture."""

    links: tuple[ObservedLink, ...]
    conditions: dict[Key, Conditions]
    common: frozenset[Key]
    """Segments that make up the one step common to all links."""

    no_steps: frozenset[Key]
    """Segments that are no step of the action, such as rest."""

    violations: tuple[str, ...]
    joint: tuple[JointAction, ...] = ()
    """What several end-effectors do as one action, in order of time."""

    relations: tuple[SegmentRelation, ...] = ()
    """Which segments are one action, or serve another one; sorted."""


@asking
def infer(facts: Sequence[Fact], *, profile: Profile) -> Inference:
    """Segments, their names, and their conditions.

    Raises:
        RuleError: The rules have a fault, or not exactly one answer.
    """
    numbered = number_borders(facts, crossings_only=profile.crossings_only)
    answer = solve(profile.files, (*facts, *numbered))
    return _Reading(facts, numbered, answer).inference()


class _Reading:
    """The tables of an answer, by segment."""

    def __init__(self, facts: Sequence[Fact], numbered: Sequence[Fact], answer: Answer) -> None:
        self.answer = answer
        self.linked = [each for each in facts if isinstance(each, Link)]
        self.agents = {each.body: each.agent for each in facts if isinstance(each, OfAgent)}
        self.rate = next(each.rate for each in facts if isinstance(each, RateMhz)) / 1000.0
        self.end = next(each.last for each in facts if isinstance(each, Frames))
        self.frame = {
            (each.ee, each.tick): each.frame for each in numbered if isinstance(each, Tick)
        }
        spans = sorted(
            (str(term[1]), int(term[2]), int(last)) for term, _, last in self._rows("segment")
        )
        self.spans: dict[str, list[tuple[int, int]]] = defaultdict(list)
        for ee, first, last in spans:
            self.spans[ee].append((first, last))
        self.tables = {name: self._table(name) for name in _OF_SEGMENT}
        self.general: dict[str, list[tuple[int, str]]] = defaultdict(list)
        for name, general, steps in self._rows("general"):
            self.general[str(name)].append((int(steps), str(general)))
        self.why: dict[Key, list[Border]] = defaultdict(list)
        for ee, tick, kind, body, other in self._rows("why"):
            self.why[str(ee), int(tick)].append(Border(str(kind), str(body), str(other)))

    def _rows(self, predicate: str) -> Sequence[tuple[Any, ...]]:
        return self.answer.of(predicate)

    def _table(self, predicate: str) -> dict[Key, list[tuple[Term, ...]]]:
        table: dict[Key, list[tuple[Term, ...]]] = defaultdict(list)
        for term, *rest in self._rows(predicate):
            table[str(term[1]), int(term[2])].append(tuple(rest))
        return table

    def inference(self) -> Inference:
        links, conditions, common, no_steps = [], {}, set(), set()
        for link in self.linked:
            segments = []
            for index, (first, last) in enumerate(self.spans[link.ee]):
                tick = (link.ee, first)
                segments.append(self._segment(link, index, first, last))
                conditions[link.ee, index] = self._conditions(tick)
                if tick in self.tables["common"]:
                    common.add((link.ee, index))
                if tick in self.tables["no_step"]:
                    no_steps.add((link.ee, index))
            agent = self.agents.get(link.ee, "")
            links.append(ObservedLink(link.ee, link.kind, link.side, tuple(segments), agent))
        violations = tuple(str(each) for each in self._rows("violation"))
        return Inference(
            tuple(links),
            conditions,
            frozenset(common),
            frozenset(no_steps),
            violations,
            joint_actions(
                self.answer,
                {
                    (link.ee, first): segment
                    for link in links
                    for (first, _), segment in zip(self.spans[link.ee], link.segments, strict=True)
                },
                rate_hz=self.rate,
            ),
            self._relations(),
        )

    def _relations(self) -> tuple[SegmentRelation, ...]:
        """How segments stand to each other, by their numbers in their links."""
        index = {
            ("seg", ee, first): (ee, number)
            for ee, spans in self.spans.items()
            for number, (first, _) in enumerate(spans)
        }
        found = (
            SegmentRelation(kind, index[one], index[other])
            for kind in SEGMENT_RELATIONS
            for one, other in self._rows(kind)
        )
        return tuple(sorted(found))

    def _segment(self, link: Link, index: int, first: int, last: int) -> Segment:
        tick, after = (link.ee, first), (link.ee, last)
        frames = self.frame[tick], self.frame[after]
        ((start, end, change, force),) = self.tables["features"][tick]
        names = [str(name) for (name,) in self.tables["named"][tick]]
        objects = tuple(str(name) for _, name in sorted(self.tables["object_at"][tick]))
        general = sorted({each for name in names[:1] for each in self.general[name]})
        level = next((int(str(level)) for (level,) in self.tables["parted_at"][tick]), 0)
        nearest = tuple(str(name) for (name,) in self.tables["nearest"][tick])
        purposes = [str(purpose) for (purpose,) in self.tables["purpose"][tick]]
        held = {str(name) for name, _ in self.tables["possessed"][tick]}
        return Segment(
            ee=link.ee,
            index=index,
            first=frames[0],
            last=frames[1],
            start_s=frames[0] / self.rate,
            end_s=frames[1] / self.rate,
            name=names[0] if names else UNKNOWN,
            general=tuple(dict.fromkeys(name for _, name in general)),
            candidates=tuple(names[1:]) if names else nearest,
            level=LEVELS[level] if not names else "",
            objects=objects,
            possessed=bool(objects) and objects[0] in held,
            features=FeatureSet(str(start), str(end), str(change), link.kind, str(force)),
            begins=(Border("first"),) if first == 0 else tuple(sorted(self.why[tick])),
            ends=(Border("last"),) if frames[1] == self.end else tuple(sorted(self.why[after])),
            purpose=purposes[0] if purposes else "",
            prepositions=tuple(
                (str(name), str(body), str(other))
                for name, body, other in sorted(self.tables["preposition"][tick])
            ),
            looks=tuple(
                (str(seen), str(when)) for seen, when in sorted(self.tables["looks"][tick])
            ),
        )

    def _conditions(self, tick: Key) -> Conditions:
        table = self.tables
        needs = (
            (_pair(what), str(action), _places(objects))
            for what, action, objects in table["needs"][tick]
        )
        ends = ((_pair(what), bit == 1) for what, bit in table["ends_when"][tick])
        after = ((_pair(what) or (-1, 0), bit == 1) for what, bit in table["afterwards"][tick])
        colliding = [(int(str(a)), int(str(b))) for a, b in table["colliding"][tick]]
        return Conditions(
            tuple(sorted(needs, key=str)),
            tuple(sorted(ends, key=str)),
            tuple(sorted(after)),
            colliding[0] if colliding else (-1, -1),
        )


_OF_SEGMENT = (
    "object_at",
    "features",
    "possessed",
    "named",
    "parted_at",
    "nearest",
    "purpose",
    "needs",
    "ends_when",
    "afterwards",
    "colliding",
    "common",
    "no_step",
    "preposition",
    "looks",
)


def _pair(term: Term) -> Pair | None:
    """A relation of the rules, pair(ee, 0) or contact(0, 1), over positions; else None."""
    if not isinstance(term, tuple):
        return None
    first, second = term[1:]
    return (-1 if first == "ee" else int(str(first)), int(str(second)))


def _places(term: Term) -> tuple[int, ...]:
    """Positions of objects, without what is none."""
    assert isinstance(term, tuple)
    return tuple(each for each in term[1:] if isinstance(each, int))
