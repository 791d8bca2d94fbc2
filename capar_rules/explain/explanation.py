"""Why a segment has its name: its conditions, the nearest other name, and the derivation."""

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path

from capar.model.errors import RuleError
from capar.model.facts import Fact
from capar.model.observation import Segment
from capar.model.par import UNKNOWN
from capar_rules.borders.numbering import number_borders
from capar_rules.engine.profiles import Profile
from capar_rules.engine.syntax import Statement, parse_text, stated
from capar_rules.explain.conditions import DOUBTED, Condition, Conditions, leading
from capar_rules.explain.conditions import Reason as Reason
from capar_rules.explain.derivations import Derivations, Grounds, Recorder
from capar_rules.explain.nearest import (
    FEATURE,
    MOST_ASKED,
    NearRule,
    conditions_of,
    nearest_rules,
    neighbours,
    overruling,
)
from capar_rules.explain.sentences import RuleBase as RuleBase
from capar_rules.explain.sentences import Scene, listed
from capar_rules.explain.sentences import rule_base as rule_base
from capar_rules.explain.windows import Windows

ALWAYS = (("segment", 3), ("also", 2))
TOGETHER = 16
"""Greatest number of segments whose windows are grounded together."""

KEPT = 32
"""Greatest number of recorders that are kept: one for each set of names explained together."""


@dataclass(frozen=True)
class Explanation:
    """A segment's name and why it has it."""

    ee: str
    index: int
    name: str
    start_s: float
    end_s: float
    summary: str
    conditions: tuple[Condition, ...]
    """The conditions of the rules that named it, each with what was measured and its limit."""

    nearest: NearRule | None
    """The rule for another name that lacks least; None if none is near."""

    notes: tuple[str, ...]
    """What the conditions rest on that was corrected as flicker."""

    reason: Reason
    """The derivation from facts."""

    general: tuple[str, ...] = ()
    """What the name specialises directly, of what fits."""


@lru_cache(maxsize=KEPT)
def recorder(base: RuleBase, names: frozenset[str], asked: str = "") -> Recorder:
    """The recorder of why segments have names, or, for ``Unknown`` alone, why they have none.

    What is recorded of a segment of one of the names is the same whatever the others are.
    """
    compared = base.sentences.compared
    wanted = {asked} if asked else {other for name in names for other in neighbours(base, name)}
    read = conditions_of(base, tuple(sorted(wanted)))
    if names == {UNKNOWN}:
        targets = {("parted_at", 2), ("nearest", 2), FEATURE, *ALWAYS, *read}
        return Recorder(base.statements, targets=targets, compared=compared)
    others = [each for each in base.statements if not _is_of(each, "named", "overruled")]
    naming = [rule for name in sorted(names) for rule in _naming(base.statements, name)]
    targets = {("named", 2), *ALWAYS, *read}
    return Recorder([*others, *naming], targets=targets, compared=compared)


def _is_of(statement: Statement, *predicates: str) -> bool:
    return any(head.signature in {(one, 2) for one in predicates} for head in statement.heads)


@lru_cache(maxsize=4 * KEPT)
def _naming(statements: tuple[Statement, ...], name: str) -> tuple[Statement, ...]:
    """The rules that name segments, for one name: what specialises or precedes it overrules."""
    rule = f'named(Segment,"{name}") :- fits(Segment,"{name}"); not overruled(Segment,"{name}").'
    found = [
        replace(parse_text(rule)[0], place=each.place)
        for each in statements
        if _is_of(each, "named")
    ]
    for other in overruling(statements, name):
        fit = f'fits(Segment,"{other}"); fits(Segment,"{name}")'
        found += parse_text(f'overruled(Segment,"{name}") :- {fit}.')
    return tuple(found)


@dataclass
class Explainer:
    """Explains the segments of a capture, each at a cost independent of the capture's length."""

    facts: Sequence[Fact]
    """What the extractors measured."""

    profile: Profile
    """The rules to explain by."""

    names: Mapping[str, str] = field(default_factory=dict)
    """What bodies are called where that is not their name."""

    def __post_init__(self) -> None:
        """Index the facts by when they hold."""
        numbered = number_borders(self.facts, crossings_only=self.profile.crossings_only)
        self.base = rule_base(self.profile)
        self.windows = Windows(self.facts, numbered)

    def explain(self, segment: Segment) -> Explanation:
        """Why a segment has its name, or why it has none.

        Raises:
            RuleError: The segment does not follow from these facts and rules.
        """
        return self.explain_all([segment])[0]

    def explain_all(self, segments: Sequence[Segment]) -> tuple[Explanation, ...]:
        """The same of each of several segments, in a fraction of the time.

        Raises:
            RuleError: A segment does not follow from these facts and rules.
        """
        return tuple(
            self._explanation(segment, about, roots)
            for segment, (about, roots) in zip(segments, self._answers(segments), strict=True)
        )

    def nearest_rules(self, segment: Segment, name: str) -> list[NearRule]:
        """The rule that could give a segment another name, with the conditions that fail.

        Raises:
            RuleError: The segment does not follow from these facts and rules.
        """
        ((conditions, _),) = self._answers([segment], asked=name)
        return nearest_rules(self.base, [name], conditions, most=MOST_ASKED)

    def _answers(
        self, segments: Sequence[Segment], asked: str = ""
    ) -> list[tuple[Conditions, Sequence[str]]]:
        """What follows from windows around segments, and the atoms that say what each is called."""
        found: dict[tuple[str, int], tuple[Conditions, Sequence[str]]] = {}
        windows = {each: self.windows_of(each.ee, self.ticks(each)) for each in segments}
        while waiting := [each for each in windows if (each.ee, each.index) not in found]:
            for group in _groups(waiting):
                given = [next(windows[one], None) for one in group]
                if None in given:
                    segment = group[given.index(None)]
                    raise RuleError(
                        f"segment {segment.index} of {segment.ee!r} is no {segment.name} by these "
                        "rules; observe the capture again"
                    )
                names = frozenset(each.name for each in group)
                known = [facts for facts in given if facts is not None]
                solved = recorder(self.base, names, asked).solve(known)
                for segment, derived in zip(group, solved, strict=True):
                    roots = list(_roots(derived, self.term(segment), self.ticks(segment), segment))
                    if roots:
                        scene = self._scene(derived, self.term(segment))
                        about = Conditions(self.base, derived, scene)
                        found[segment.ee, segment.index] = about, roots
        return [found[each.ee, each.index] for each in segments]

    def ticks(self, segment: Segment) -> tuple[int, int]:
        """The numbers of the frames between which a segment lies.

        Raises:
            RuleError: It lies between others than these rules know.
        """
        frames = self.windows.frames.get(segment.ee, [])
        found = [bisect_left(frames, each) for each in (segment.first, segment.last)]
        if [frames[each] for each in found if each < len(frames)] != [segment.first, segment.last]:
            raise RuleError(
                f"segment {segment.index} of {segment.ee!r} does not lie between frames at which "
                "these facts change; observe the capture again"
            )
        return found[0], found[1]

    def term(self, segment: Segment) -> str:
        """The term by which rules name a segment."""
        return f"seg({segment.ee},{self.ticks(segment)[0]})"

    def windows_of(self, ee: str, ticks: tuple[int, int]) -> Iterator[tuple[Fact, ...]]:
        """Windows of facts of growing width; the first nearly always suffices."""
        for widen in (0, 3):
            yield self.windows.around(ee, *ticks, widen=widen)
        yield self.windows.whole()

    def _scene(self, derived: Derivations, own: str) -> Scene:
        """When the ticks and segments of an answer are."""
        ends = {}
        for term, first, last in derived.holding("segment"):
            ends[term[4:].split(",")[0], int(first)] = int(last)
        objects: dict[str, list[str]] = defaultdict(list)
        for term, name in derived.holding("dominant"):
            objects[term].append(name)
        for term, _, name in sorted(derived.holding("object_at"), key=lambda row: int(row[1])):
            if name not in objects[term]:
                objects[term].append(name)
        return Scene(self.windows.rate, self.windows.frames, ends, self.names, objects, own)

    def _explanation(
        self, segment: Segment, about: Conditions, roots: Sequence[str]
    ) -> Explanation:
        derived, own, done = about.derived, about.scene.own, dict[str, Reason]()
        reasons = [self._reason(derived.why(one), about.scene, done) for one in roots]
        nodes = [node for reason in reasons for node in leading(reason)]
        top = replace(reasons[0], because=(*reasons[0].because, *reasons[1:]))
        conditions = tuple(map(about.of, nodes))
        fitting = {name for term, name in derived.holding("fits") if term == own}
        pairs = stated(self.base.statements, ("specialises", 2))
        general = sorted(
            {above for one, above in pairs if one == segment.name and above in fitting}
        )
        others = neighbours(self.base, segment.name)
        if not segment.known:
            others = [name for term, name in derived.holding("nearest") if term == own]
        near_rules = nearest_rules(self.base, others, about)
        near = next((one for one in near_rules if not one.vague), None)
        kind = f", a kind of {listed(general)}," if general else ""
        sentences = dict.fromkeys(one.sentence for one in conditions if one.sentence)
        doubted = (
            one.sentence for node in nodes for one in node.walk() if one.atom.startswith(DOUBTED)
        )
        told = f"{segment.name}{kind} because {'; '.join(sentences)}."
        if near is not None:
            told += f" Nearest other name: {near.sentence}."
        return Explanation(
            segment.ee,
            segment.index,
            segment.name,
            segment.start_s,
            segment.end_s,
            told,
            conditions,
            near,
            tuple(dict.fromkeys(doubted)),
            top,
            tuple(general),
        )

    def _reason(self, grounds: Grounds, scene: Scene, done: dict[str, Reason]) -> Reason:
        if grounds.atom in done:
            return done[grounds.atom]
        told, absent = (grounds.predicate, grounds.arguments), grounds.absent
        template = self.base.sentences.template(*told, absent=absent)
        done[grounds.atom] = found = Reason(
            self.base.sentences.say(*told, scene, absent=absent)[0] if template else "",
            grounds.atom,
            "" if grounds.rule is None else f"{Path(grounds.rule.file).name}:{grounds.rule.line}",
            None if absent else scene.frames_of(*told),
            template is not None and template.leading,
            tuple(self._reason(each, scene, done) for each in grounds.because),
        )
        return found


def _groups(segments: Sequence[Segment]) -> Iterator[Sequence[Segment]]:
    """Segments to derive together, those without a name apart from the others."""
    for known in (True, False):
        alike = [each for each in segments if each.known == known]
        for start in range(0, len(alike), TOGETHER):
            yield alike[start : start + TOGETHER]


def _roots(
    derived: Derivations, term: str, ticks: tuple[int, int], segment: Segment
) -> Iterator[str]:
    """The atoms that say what a segment is called, or that it is unknown."""
    if (term, *map(str, ticks)) not in derived.holding("segment"):
        return
    if segment.known:
        if (term, segment.name) in derived.holding("named"):
            yield f'named({term},"{segment.name}")'
        return
    for place, level in derived.holding("parted_at"):
        if place == term:
            yield f"parted_at({term},{level})"
    for place, name in derived.holding("nearest"):
        if place == term:
            yield f'nearest({term},"{name}")'
