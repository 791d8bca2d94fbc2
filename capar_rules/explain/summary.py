"""The summary of an explanation: the name's conditions, and what decided against neighbours."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from capar_rules.engine.syntax import split_arguments
from capar_rules.explain.arrangements import untracked
from capar_rules.explain.claims import (
    ANY,
    Claim,
    Stretches,
    claim,
    joined_claims,
    resting_on,
)
from capar_rules.explain.clock import Clock
from capar_rules.explain.contact_pairs import merged_contacts
from capar_rules.explain.contrasts import MOST_NAMES, MOST_TOLD, Contrast
from capar_rules.explain.formatting import UNBOUND
from capar_rules.explain.reaches import Between
from capar_rules.explain.reason import Reason
from capar_rules.explain.sentences import Sentences

BESIDE = ("joins_in(", "looks(", "kept_from(")
"""Prefixes of atoms that accompany a name and are no reason for it."""

FEATURES = "features("
"""Prefix of atoms that primitives share; a primitive's own conditions precede them."""

BORDERS = ("segment(", "border(", "member(")
"""Prefixes of atoms that say where a segment begins and ends, not what it is."""

APART = ("no_contact", "uncounted")
"""Predicates of no contact that counts at a border; where that border lies is no reason."""

BESIDE_BORDERS = ("met_gently(", "met_hard(", "newly_met(", "lets_go(", "takes(")
"""Prefixes of atoms that say themselves when a contact began or ended."""

DOUBTED = "doubted("
"""Prefix of atoms of what was not taken as it was measured."""

CLEAR = "not sliding("
"""Prefix of atoms that say that a body was clear of others; told of what goes aside."""

COURSES = ("rises", "comes_down", "travels", "stays_near")
"""Predicates that tell how a body moved, so that its motion need not be told again."""


NUMBERED = ("stays(", "met_gently(")
"""Prefixes of atoms of which a contrast tells the number that decided."""

MOST_GAPS = 3
"""So many gaps of a track are told one by one."""

OWN = 3
"""Rank of what is no feature, but a name's own condition."""


@dataclass(frozen=True)
class Summary:
    """Why a segment has a name, in a few sentences."""

    text: str
    claims: tuple[Claim, ...]
    """Its clauses, with what was measured for each."""


@dataclass(frozen=True)
class Briefs:
    """What a summary says of atoms."""

    sentences: Sentences
    clock: Clock
    claims: dict[str, Claim] = field(default_factory=dict)
    """Each clause so far, by its text."""

    def tell(
        self, predicate: str, arguments: Sequence[str], mood: str, reason: Reason | None = None
    ) -> str:
        """The clause for an atom, kept with what was measured for it; empty if nothing was.

        Of the atom of a node, what was measured below it counts too.
        """
        text = self.sentences.tell(predicate, arguments, self.clock, mood=mood)
        return self._kept(text, (predicate, arguments, mood), reason)

    def _kept(self, text: str, told: tuple[str, Sequence[str], str], reason: Reason | None) -> str:
        if not text or UNBOUND in text:
            return text
        if text not in self.claims:
            found = claim(self.sentences, self.clock, told, text)
            found = found if reason is None else resting_on(found, reason)
            if not found.shown:
                return ""
            self.claims[text] = found
        return text

    def of(self, reason: Reason) -> str:
        """The clause for a node; its sentence if there is no shorter one."""
        absent = reason.atom.startswith("not ")
        predicate, arguments = _parsed(reason.atom.removeprefix("not "))
        plain = self.sentences.tell(predicate, arguments, self.clock, mood="not" * absent)
        if plain != reason.sentence:  # part of it is doubted
            return self._kept(reason.sentence, (predicate, arguments, "mended"), reason)
        if predicate == "rests" and self.clock.side(arguments[0], int(arguments[1])) == "end":
            return self.tell("rests_afterwards", arguments, "brief", reason)
        mood = "brief not" if absent else "brief"
        if self.sentences.template(predicate, arguments, mood=mood):
            return self.tell(predicate, arguments, mood, reason)
        return self.tell(predicate, arguments, "not" * absent, reason)

    def first(self, reason: Reason, top: Reason) -> list[str]:
        """What the first node says, at or below one, that has something to say in a summary.

        What the segment's own reasons, below the top, tell of the same contact, is told alike.
        """
        pairs = merged_contacts(list(reason.walk()), self.clock)
        pairs |= merged_contacts(list(top.walk()), self.clock)
        for each in _resting_on([reason], set()):
            if each.atom.startswith((CLEAR, DOUBTED)):
                continue  # what decides against a name is what the thing did
            predicate, arguments = _parsed(each.atom)
            told = self.tell(predicate, arguments, "despite", each)
            if each.atom in pairs and _rank(each):
                told = self.tell(*pairs[each.atom], "brief")
            told = told or (self.of(each) if each.leading and _rank(each) else "")
            if told and UNBOUND not in told:
                return [told]
        return []

    def contrasted(self, nodes: Sequence[Reason], top: Reason) -> list[str]:
        """What is said of nodes that keep a segment from a name, with what numbers decided.

        A contact that is at one border alone is told as begun or ended in between.
        """
        pairs = merged_contacts(list(top.walk()), self.clock)
        for each in nodes:
            told = self.tell(*pairs.get(each.atom, ("", ())), "brief")
            if each.atom.startswith(NUMBERED):
                told = self.tell(*_parsed(each.atom), "despite")
            if told and UNBOUND not in told:
                return [told]
        return self.clauses(nodes)

    def lost(self, claims: Iterable[Claim]) -> list[Claim]:
        """That bodies of which claims tell were not tracked at times within the segment."""
        shown = [quantity.bodies for each in claims for quantity in each.quantities]
        shown += [stretches.bodies for each in claims for stretches in each.stretches]
        bodies = tuple(dict.fromkeys(body for each in shown for body in each if body != ANY))
        return [
            Claim(self._lost(body, gaps), (), (), (Stretches("lost", (body,)),))
            for body, gaps in untracked(self.clock, bodies)
        ]

    def _lost(self, body: str, gaps: Sequence[tuple[int, int]]) -> str:
        was = "were" if self.clock.called(body) in self.clock.several else "was"
        spans = [f"from {self.clock.at(first)} to {self.clock.at(last)}" for first, last in gaps]
        if len(spans) > MOST_GAPS:
            lost = sum(last - first for first, last in gaps) / self.clock.rate_hz
            spans = [f"{len(gaps)} times, for {lost:.2f} s in all"]
        return f"the {self.clock.called(body)} {was} not tracked {_listed(spans)}"

    def clauses(self, nodes: Sequence[Reason]) -> list[str]:
        """What is said of nodes, each once; contacts of two bodies at both borders are one.

        What holds of another segment is left to the tree: its start and end are not this one's.
        """
        nodes = [each for each in nodes if not self._of_another(each)]
        nodes = [each for each in nodes if not self._within_border(each, nodes)]
        pairs = merged_contacts(nodes, self.clock)
        told: list[str] = []
        courses = any(each.atom.startswith(COURSES) for each in nodes)
        aside = any(node.atom.startswith("travels(") for node in nodes)
        nodes = [node for node in nodes if aside or not node.atom.startswith(CLEAR)]
        for each in nodes:
            pair = pairs.get(each.atom)
            if pair is not None:
                told.append(self.tell(*pair, "brief"))
            elif not (courses and each.atom.startswith("moved(")):
                told.append(self.of(each))
        told = [each for each in dict.fromkeys(told) if each and UNBOUND not in each]
        return self._of_both(_at_both(told))

    def _of_both(self, clauses: Sequence[str]) -> list[str]:
        """The clauses, of which two that differ in the side, and in numbers of it, are one."""
        joined: dict[str, list[str]] = {}
        for clause in clauses:
            found = _SIDED.fullmatch(clause)
            joined.setdefault(found[1] if found else clause, []).append(clause)
        out = []
        for begin, parts in joined.items():
            text = " and ".join([parts[0], *(part.removeprefix(begin) for part in parts[1:])])
            text = text.replace(" and  at ", " and at ")
            if len(parts) > 1:
                claims = [self.claims[part] for part in parts if part in self.claims]
                self.claims[text] = joined_claims(text, claims)
            out.append(text)
        return out

    def _within_border(self, reason: Reason, nodes: Iterable[Reason]) -> bool:
        """Whether it is a contact at a time within a border, at which the two are told about."""
        if not reason.atom.startswith("contact_at("):
            return False
        told = [_parsed(each.atom)[1] for each in nodes if each.atom.startswith("contact_at(")]
        own = _parsed(reason.atom)[1]
        at_border = [each[1:3] for each in told if self.clock.side(each[0], int(each[4]))]
        return not self.clock.side(own[0], int(own[4])) and own[1:3] in at_border

    def _of_another(self, reason: Reason) -> bool:
        arguments = _parsed(reason.atom.removeprefix("not "))[1]
        return (
            bool(arguments) and arguments[0].startswith("seg(") and arguments[0] != self.clock.own
        )

    def touching(self, nodes: Iterable[Reason]) -> str:
        """Up to which distance bodies are counted as touching that are told to touch."""
        measured = self.clock.measured
        found: dict[tuple[bool, Between], dict[int, list[str]]] = {}
        bodies: list[str] = []
        for each in nodes:
            predicate, arguments = _parsed(each.atom)
            if predicate in ("contact_at", "no_contact"):
                one, other = arguments[1:3] if predicate == "contact_at" else arguments[2:4]
                reach = measured.reaches.get((one, other))
                bodies += [one, other]
                if reach:
                    pair = f"{self.clock.called(one)} and {self.clock.called(other)}"
                    alike = found.setdefault((measured.near(one, other), reach.between), {})
                    alike.setdefault(reach.told_mm, []).append(pair)
        several = sum(map(len, found.values())) > 1
        return "".join(
            _counted(told, several=several, near=near, between=between)
            for (near, between), told in found.items()
        ) + self._stand_ins(bodies)

    def _stand_ins(self, bodies: Iterable[str]) -> str:
        """That contacts are uncertain of bodies whose true shape is not known."""
        shapes = self.clock.measured.stand_ins
        return "".join(
            f" The shape of the {self.clock.called(each)} is a stand-in ({shapes[each]}): when it "
            "touches is known only roughly."
            for each in dict.fromkeys(bodies)
            if each in shapes
        )


def _counted(
    found: Mapping[int, Sequence[str]], *, several: bool, near: bool, between: Between
) -> str:
    """What distances are between, by how many millimetres they are, of which pairs of bodies."""
    told = _listed(
        [
            f"{reach} mm" + f" ({_listed(list(dict.fromkeys(pairs)))})" * several
            for reach, pairs in found.items()
        ]
    )
    if not near:
        return f" Contact is counted within {told}, {between.value}."
    return f" The {told} are {between.value}."


def summary(
    name: str,
    reason: Reason,
    briefs: Briefs,
    against: Sequence[Contrast],
    generals: Sequence[str] = (),
) -> Summary:
    """Why a segment has a name, and not that of its nearest neighbours.

    Where none is near, what is said apart is why it has no more general name.
    """
    nodes = leading(reason)
    doubts = [each for each in nodes if each.atom.startswith(DOUBTED)]
    nodes = [each for each in nodes if each not in doubts]
    clauses = briefs.clauses(nodes)
    own = briefs.clauses([each for each in nodes if _rank(each) == OWN])
    subjects = _subjects(nodes, briefs)
    against = [
        replace(each, though=tuple(clause for clause in each.though if clause not in clauses))
        for each in against
    ]
    fresh, alike = _told_contrasts(against, clauses)
    apart = bool(generals and own) and not alike and all(each.weak for each in fresh)
    fresh = [] if apart else fresh
    beside = [f"just {_listed(generals, 'or')}"] if apart else alike
    other = f", and not {_listed(beside, 'or')}" * bool(beside)
    told = f"{name}{other}, because "
    if apart:
        more = _by_subject([each for each in clauses if each not in own], subjects)
        told += _by_subject(own, subjects) + f". Also, {more}" * bool(more)
    else:
        told += _by_subject(clauses, subjects)
    for number, contrast in enumerate(fresh):
        told += f"{';' if number else '.'} {'n' if number else 'N'}ot {contrast.sentence}"
    said = [*clauses, *(clause for each in fresh for clause in (*each.clauses, *each.though))]
    every = (briefs.claims.get(each.removesuffix(_BOTH)) for each in dict.fromkeys(said))
    claims = [each for each in every if each is not None]
    mended = briefs.clauses(doubts)
    claims += [briefs.claims[each] for each in mended if each in briefs.claims]
    told += f". For this, {_listed(mended)}" * bool(mended)
    lost = briefs.lost(claims)
    told += "".join(f". {each.text[0].upper()}{each.text[1:]}" for each in lost)
    return Summary(f"{told}." + briefs.touching(nodes), (*claims, *lost))


def _told_contrasts(
    against: Sequence[Contrast], clauses: Sequence[str]
) -> tuple[list[Contrast], list[str]]:
    """The contrasts that are told with reasons of their own, and the names that need none.

    Those names are denied by what the summary says of its own. Names of other features are told
    only where too few others are.
    """
    fresh = [each for each in against if each.though or each.clause not in clauses]
    same = [each for each in against if each not in fresh and each.failing == 1]
    alike = [name for each in same for name in each.names if not each.by_features][:MOST_NAMES]
    near = [each for each in fresh if not each.by_features and not each.weak]
    fresh = near or [each for each in fresh if each.by_features]
    fresh = fresh[: max(MOST_TOLD - len(alike), sum(bool(each.though) for each in fresh))]
    if len(alike) + len(fresh) < MOST_TOLD:
        others = [name for each in same for name in each.names if each.by_features]
        alike += others[: MOST_TOLD - len(alike) - len(fresh)]
    return fresh, alike


def leading(reason: Reason) -> list[Reason]:
    """The nodes from which the name follows: first its own conditions, then its features."""
    passed = set[int]()
    own = list(_resting_on([reason], passed))
    shared = [each for each in own if each.atom.startswith(FEATURES)]
    features = [each for top in shared for each in _resting_on(top.because, passed)]
    features += [each for each in own if _rank(each) == 0]
    every = [*(each for each in own if _rank(each)), *sorted(features, key=_rank)]
    return [each for each in every if each.leading]


def bit(top: Reason, feature: str, clock: Clock) -> list[Reason]:
    """The leading nodes that one place of a feature string is about, by ``feature(_,Side,Place)``.

    First come the end-effector with each object, then the first object with each other one.
    """
    segment, side, text = split_arguments(feature)
    hand, place = segment[4:].split(",")[0], int(text)
    atoms = [each.atom for each in top.walk()]
    objects = {int(row[1]): row[2] for row in _rows(atoms, "object_at(") if row[0] == segment}
    dominant = [row[1] for row in _rows(atoms, "dominant(") if row[0] == segment]
    others = [row[1] for row in _rows(atoms, "subordinate(") if row[0] == segment]
    if len(others) < 2:  # of several, object_at says which is which
        objects |= dict(enumerate([*dominant[:1], *others]))
    if side == "change":
        wanted = [
            f"moved({objects.get(place)},{segment})",
            f"stays({objects.get(place)},{segment})",
        ]
        return [each for each in top.walk() if each.atom in wanted]
    if side == "force":
        return [each for each in top.walk() if each.atom.startswith(f"met_gently({segment},")]
    pair = hand, objects.get(place, "")
    if place >= len(objects):
        pair = objects.get(0, ""), objects.get(place - len(objects) + 1, "")
    return [each for each in top.walk() if _is_about(each.atom, pair, side, clock)]


def _rows(atoms: Iterable[str], prefix: str) -> list[list[str]]:
    return [split_arguments(each) for each in atoms if each.startswith(prefix)]


def _is_about(atom: str, pair: tuple[str, str], side: str, clock: Clock) -> bool:
    """Whether an atom says that two bodies touch, or do not, at a side of the segment."""
    arguments = split_arguments(atom) if "(" in atom else []
    if atom.startswith(("no_contact(", "uncounted(")):
        return arguments[1] == side and tuple(arguments[2:4]) == pair
    if atom.startswith("contact_at("):
        at = clock.side(arguments[0], int(arguments[4]))
        return at == side and tuple(arguments[1:3]) == pair
    return False


def _resting_on(tops: Iterable[Reason], passed: set[int]) -> Iterator[Reason]:
    """Nodes from the top, each once, as far down as the features."""
    waiting = list(reversed(list(tops)))
    while waiting:
        each = waiting.pop()
        if each.atom.startswith(BESIDE) or id(each) in passed:
            continue
        passed.add(id(each))
        yield each
        if not each.atom.startswith(FEATURES):
            waiting += [below for below in reversed(each.because) if _bears(each, below)]


def _bears(reason: Reason, below: Reason) -> bool:
    """Whether a child of a node is relevant to the name, not only to where a border is.

    Doubts are relevant to derived atoms, not to the measurements themselves.
    """
    if below.atom.startswith(DOUBTED):
        return bool(reason.rule)
    return not reason.atom.startswith((*BORDERS, *APART, *BESIDE_BORDERS))


def _rank(reason: Reason) -> int:
    """Sort key of features: contacts of the end-effector come first."""
    predicate = reason.atom.partition("(")[0]
    if predicate == "contact_at":
        hand, body = split_arguments(reason.atom)[:2]
        return 0 if hand == body else 2
    if predicate in APART:
        segment, _, body = split_arguments(reason.atom)[:3]
        return 0 if segment.startswith(f"seg({body},") else 2
    return {"moved": 1, "stays": 1}.get(predicate, OWN)


def _subjects(nodes: Iterable[Reason], briefs: Briefs) -> list[str]:
    """How clauses about the bodies that nodes name begin, the longest first."""
    bodies = {each for node in nodes for each in _parsed(node.atom)[1]}
    hand = briefs.clock.own[4:].split(",")[0]
    called = {f"the {briefs.clock.called(each)} " for each in {*bodies, hand}}
    return sorted(called, key=lambda each: (-len(each), each))


def _by_subject(clauses: Sequence[str], subjects: Sequence[str]) -> str:
    """The clauses in one sentence, those about one body together."""
    groups: dict[str, list[str]] = {}
    for clause in clauses:
        subject = next((each for each in subjects if clause.startswith(each)), "")
        groups.setdefault(subject or clause, []).append(clause.removeprefix(subject))
    told = [
        subject + _listed(said) if subject in subjects else subject
        for subject, said in groups.items()
    ]
    if any(" and " in each or "," in each for each in told) and len(told) > 1:
        return f"{'; '.join(told[:-1])}; and {told[-1]}"
    return _listed(told)


_SIDED = re.compile(r"(.*) at the (?:start|end) \([^()]*\)")
"""A clause that tells a number of one side."""

_START, _END, _BOTH = " at the start", " at the end", " and at the end"


def _at_both(clauses: Sequence[str]) -> list[str]:
    """The clauses, of which two that differ only in the side are one."""
    ends = {each.removesuffix(_END) for each in clauses if each.endswith(_END)}
    starts = {each.removesuffix(_START) for each in clauses if each.endswith(_START)}
    both = ends & starts
    return [
        each + _BOTH if each.removesuffix(_START) in both else each
        for each in clauses
        if each.removesuffix(_END) not in both
    ]


def _parsed(atom: str) -> tuple[str, list[str]]:
    arguments = split_arguments(atom) if "(" in atom else []
    return atom.partition("(")[0], [each.strip('"') for each in arguments]


def _listed(parts: Sequence[str], word: str = "and") -> str:
    if len(parts) < 2:
        return "".join(parts) or "the rules say so"
    comma = "," * (len(parts) > 2 or any("," in each for each in parts))
    return f"{', '.join(parts[:-1])}{comma} {word} {parts[-1]}"
