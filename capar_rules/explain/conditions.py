"""The conditions by which a segment has its name, each with what was measured and its limit."""

import operator
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from capar_rules.engine.syntax import split_arguments
from capar_rules.explain.derivations import Compared, Derivations
from capar_rules.explain.quantities import QUANTITIES
from capar_rules.explain.sentences import Comparison, RuleBase, Scene, bodies_of, parsed


@dataclass(frozen=True)
class Reason:
    """One node of an explanation."""

    sentence: str
    """Empty if no template describes this atom; then the nodes below it do."""

    atom: str
    rule: str
    """File and line of the rule; empty for a measurement and for a negated atom."""

    frames: tuple[int, int] | None
    """First and last frame of a measurement."""

    leading: bool
    """Whether the sentence belongs in the summary."""

    because: tuple["Reason", ...]

    repeated: bool = False
    """Whether some of what it was derived from is left out, as it stands above."""

    def sentences_once(self) -> "Reason":
        """The tree of the nodes that have a sentence, each sentence only where it is met first."""
        known = set[str]()

        def kept(reason: Reason) -> Reason:
            known.add(reason.sentence)
            every = _nearest(reason)
            below = [kept(each) for each in every if each.sentence not in known]
            return replace(reason, because=tuple(below), repeated=len(below) < len(every))

        return kept(self)

    def expanded_once(self) -> "Reason":
        """The tree in which what an atom was derived from stands only where it is met first.

        A derivation shares its parts, so written out in full it may have 10,000 times as many
        nodes as it has atoms.
        """
        known = set[str]()

        def kept(reason: Reason) -> Reason:
            if reason.because and reason.atom in known:
                return replace(reason, because=(), repeated=True)
            known.add(reason.atom)
            return replace(reason, because=tuple(map(kept, reason.because)))

        return kept(self)

    def walk(self) -> Iterator["Reason"]:
        """This node and all below it, from the top, each once."""
        passed, waiting = set[int](), [self]
        while waiting:
            each = waiting.pop()
            if id(each) not in passed:
                passed.add(id(each))
                yield each
                waiting += reversed(each.because)


def _nearest(reason: Reason) -> list[Reason]:
    """The nearest nodes with a sentence, in order, each sentence once."""
    found: dict[str, Reason] = {}
    waiting, passed = list(reversed(reason.because)), set()
    while waiting:
        each = waiting.pop()
        if each.sentence:
            found.setdefault(each.sentence, each)
        elif each.atom not in passed:
            passed.add(each.atom)
            waiting += reversed(each.because)
    return list(found.values())


DEEPEST = 3
"""So many rules below a condition its inequalities are looked for."""

COMPARED: Mapping[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
WORDS = {">=": "at least", "<=": "at most", ">": "more than", "<": "less than"}
OPPOSITE = {">=": "<", "<": ">=", "<=": ">", ">": "<="}

BESIDE = ("joins_in(", "looks(")
"""Prefixes of atoms that accompany a name and are no reason for it."""

NO_REASON = (
    *("segment(", "border(", "member(", "no_contact(", "uncounted(", "met_", "newly_met("),
    *("moved_before(", "lets_go(", "takes("),
)
"""Prefixes of atoms whose own derivation says where a border is, or what was measured."""

FEATURES, DOUBTED, OWN = "features(", "doubted(", 3


@dataclass(frozen=True, slots=True)
class Measured:
    """A quantity that a condition compares with a limit."""

    quantity: str
    """Its name in ``quantities.py``."""

    bodies: tuple[str, ...]
    label: str
    first: int
    last: int
    """The frames between which, or at which, it is measured."""

    value: float | None
    """In its unit; None where it is not known."""

    relation: str
    """How the value is to the limit where the condition holds; empty without a limit."""

    limit: float | None
    unit: str
    against: str = ""
    """The quantity that the limit is, if it is no constant."""

    @property
    def holds(self) -> bool:
        """Whether the value is on its side of the limit."""
        if self.value is None or self.limit is None:
            return True
        return COMPARED[self.relation](self.value, self.limit)

    @property
    def nearness(self) -> float:
        """How near the value is to its side of the limit: a share, one where it is there."""
        if self.holds or self.value is None or self.limit is None:
            return 1.0
        low, high = sorted((max(self.value, 0.0), max(self.limit, 0.0)))
        return low / high if high else 0.0

    @property
    def value_text(self) -> str:
        """The value with its unit."""
        return "" if self.value is None else self._text(self.value)

    @property
    def limit_text(self) -> str:
        """The limit with its unit, and on which side of it the value has to be."""
        if self.limit is None:
            return ""
        of = f" ({self.against})" * bool(self.against)
        return f"{WORDS[self.relation]} {self._text(self.limit)}{of}"

    def _text(self, value: float) -> str:
        gap = " " * (self.unit not in ("", "°"))
        return f"{value:.{QUANTITIES[self.quantity].digits}f}{gap}{self.unit}"


@dataclass(frozen=True, slots=True)
class Condition:
    """A condition of a rule: that an atom holds, or that it does not."""

    sentence: str
    atom: str
    frames: tuple[int, ...]
    """The frames that the sentence names, else the first and last of the segment."""

    measures: tuple[Measured, ...]


@dataclass(frozen=True)
class Conditions:
    """States conditions over one answer of the rules."""

    base: RuleBase
    derived: Derivations
    scene: Scene

    def of(self, reason: Reason) -> Condition:
        """The condition of a node of a derivation."""
        below = [reason.atom, *_below(reason, DEEPEST)]
        return self.state(reason.atom, dict.fromkeys(below))

    def needed(self, atom: str) -> Condition:
        """A condition that does not hold, with the inequalities that fail.

        Without a sentence, if none of the inequalities in its rules fails: then they do not decide.
        """
        found = self.state(atom, dict.fromkeys(self._read(atom, DEEPEST)))
        failing = tuple(one for one in found.measures if one.value is None or not one.holds)
        decides = bool(failing or not found.measures)
        return replace(found, measures=failing, sentence=found.sentence * decides)

    def state(self, atom: str, below: Iterable[str]) -> Condition:
        """A condition with the inequalities of atoms."""
        absent = atom.startswith("not ")
        predicate, arguments = parsed(atom.removeprefix("not "))
        text, times = self.base.sentences.say(predicate, arguments, self.scene, absent=absent)
        if not text:  # of a rule whose author described none of it
            about = ", ".join(one for one in arguments if not one.startswith("seg(")) or "it"
            holds = "does not hold" if absent else "holds"
            text = f"{predicate.replace('_', ' ')} {holds} of {about}"
        span = self.scene.span(self.scene.own) or (0, 0)
        frames = times or self.scene.frames_of(predicate, arguments) or span
        measures = [one for each in below for one in self._measured(each, frames)]
        return Condition(text, atom, frames, tuple(dict.fromkeys(measures)))

    def _measured(self, atom: str, frames: Sequence[int]) -> Iterator[Measured]:
        """What the rules for an atom compare, or what is to be measured for it."""
        absent = atom.startswith("not ")
        atom = atom.removeprefix("not ")
        predicate, arguments = parsed(atom)
        if (predicate, len(arguments)) not in self.base.sentences.compared:
            return
        values = self.derived.compared.get(atom, {})
        for number, comparison in enumerate(self.base.sentences.quantities(predicate, arguments)):
            if comparison is not None and comparison.relation:
                yield self._compared(comparison, arguments, None, frames, absent=absent)
            elif comparison is not None and number in values:
                yield self._compared(comparison, arguments, values[number], frames, absent=absent)

    def _compared(
        self,
        comparison: Comparison,
        arguments: Sequence[str],
        values: Compared | None,
        frames: Sequence[int],
        *,
        absent: bool,
    ) -> Measured:
        asked, other = comparison.asked, comparison.against
        quantity = QUANTITIES[asked[0]]
        bodies = bodies_of(asked, arguments, self.scene)
        called = [self.scene.called(each) for each in bodies]
        against = ""
        if other is not None:
            names = [self.scene.called(one) for one in bodies_of(other, arguments, self.scene)]
            against = QUANTITIES[other[0]].label.format(*names)
        value, relation, limit = values or (None, comparison.relation, None)
        scale = quantity.scale or 1.0 / self.scene.rate_hz
        return Measured(
            asked[0],
            bodies,
            quantity.label.format(*called),
            min(frames),
            max(frames),
            None if value is None else value * scale,
            OPPOSITE[relation] if absent else relation,
            None if limit is None else limit * scale,
            quantity.unit,
            against,
        )

    def _read(self, atom: str, depth: int) -> Iterator[str]:
        """An atom, and those that rules for it read of the same arguments."""
        yield atom
        absent = atom.startswith("not ")
        own = atom.removeprefix("not ")
        predicate, arguments = own.partition("(")[0], split_arguments(own) if "(" in own else []
        for rule in self.base.rules.get((predicate, len(arguments)), ()) if depth else ():
            known = dict(zip(split_arguments(rule.heads[0].text), arguments, strict=False))
            for one in rule.body:
                terms = split_arguments(one.text) if one.kind == "atom" and "(" in one.text else []
                if terms and all(term in known for term in terms):
                    name, values = one.atoms[0].signature[0], [known[term] for term in terms]
                    negated = bool(one.sign) != absent
                    yield from self._read(
                        f"{'not ' * negated}{name}({','.join(values)})", depth - 1
                    )


def _below(reason: Reason, depth: int) -> Iterator[str]:
    """Atoms below a node that no condition of their own states."""
    for each in reason.because if depth else ():
        if not each.leading:
            yield each.atom
            yield from _below(each, depth - 1)


def leading(reason: Reason) -> list[Reason]:
    """The nodes from which a name follows: first its own conditions, then its features."""
    passed = set[int]()
    own = list(_nodes([reason], passed))
    shared = [each for each in own if each.atom.startswith(FEATURES)]
    features = [each for top in shared for each in _nodes(top.because, passed)]
    features += [each for each in own if _rank(each) == 0]
    every = [*(each for each in own if _rank(each)), *sorted(features, key=_rank)]
    return [each for each in every if each.leading]


def _nodes(tops: Iterable[Reason], passed: set[int]) -> Iterator[Reason]:
    """Nodes from the top, each once, as far down as the features."""
    waiting = list(reversed(list(tops)))
    while waiting:
        each = waiting.pop()
        if each.atom.startswith(BESIDE) or id(each) in passed:
            continue
        passed.add(id(each))
        yield each
        if not each.atom.startswith((FEATURES, *NO_REASON)):
            waiting += reversed(each.because)


def _rank(reason: Reason) -> int:
    """Sort key of features: contacts of the end-effector come first."""
    predicate, arguments = parsed(reason.atom)
    if predicate == "contact_at":
        return 0 if arguments[0] == arguments[1] else 2
    if predicate in ("no_contact", "uncounted"):
        return 0 if arguments[0].startswith(f"seg({arguments[2]},") else 2
    return {"moved": 1, "stays": 1}.get(predicate, OWN)
