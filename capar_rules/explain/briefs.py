"""The clauses that a summary says of atoms, each with what was measured for it."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from capar_rules.explain.arrangements import hand_of, kept, reached, untracked
from capar_rules.explain.claimed_measures import ANY, Measure
from capar_rules.explain.claims import Claim, Quantity, Stretches, claim, joined_claims, resting_on
from capar_rules.explain.clock import Clock
from capar_rules.explain.contact_pairs import merged_contacts
from capar_rules.explain.joining import at_both, joined_sides, listed
from capar_rules.explain.leading import DOUBTED, nodes_below, parsed, rank
from capar_rules.explain.quantities import degrees, gap
from capar_rules.explain.reaches import Between
from capar_rules.explain.reason import Reason
from capar_rules.explain.sentences import Sentences
from capar_rules.explain.told_argument import UNBOUND

CLEAR = "not sliding("
"""Prefix of atoms that say that a body was clear of others; told of what goes aside."""

COURSES = ("rises", "comes_down", "travels", "stays_near", "sliding")
"""Predicates that tell how a body moved, so that its motion need not be told again, or that it was
not slid."""

COURSES_TOLD = ("way", "course", "steep_course", "level_course", "place", "lean", "turn")
"""Formats in which a clause tells how a thing that is possessed moved."""

NUMBERED = ("stays(", "met_gently(", "met_unseen(")
"""Prefixes of atoms of which a contrast tells the number that decided, or that none is known."""

AT_ONE_SIDE = {
    "touches_at_start": "start",
    "near_at_start": "start",
    "touches_at_end": "end",
    "near_at_end": "end",
}
"""Clauses of contact at one border, and that border."""

THROUGHOUT = ("touches_throughout", "near_throughout")
"""Predicates that say that two bodies touch as long as the segment lasts."""

TOUCHING_NOTHING = ("rests", "touches_no_object")
"""Predicates that say that an end-effector touches nothing."""

LEANING = {
    "tips": (
        "the lean of the {thing} reaches {least}",
        "the tipping of the {thing} to {least} or more is taken to begin",
    ),
    "rights": (
        "the lean of the {thing} falls below {least}",
        "the righting of the {thing} from {least} or more is taken to end",
    ),
}
"""Kinds of events at which borders lie, of a far lean, as the summary says it: where the thing
leans so far at the border, and where its tipping or righting counts too."""

FAR_M = 0.5
"""What is no nearer than this [m] nobody takes for touched."""

LEAN_SLACK_RAD = 0.05
"""At a border at which a thing leans less by more than that [rad] it does not lean far over."""

MOST_GAPS = 3
"""So many gaps of a track are told one by one."""

_SIDED = re.compile(r"(.*) at the (?:start|end) \([^()]*\)")
"""A clause that tells a number of one side."""


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
        text = text.replace(") (", "; ")
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
        predicate, arguments = parsed(reason.atom.removeprefix("not "))
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
        for each in nodes_below([reason], set()):
            if each.atom.startswith((CLEAR, DOUBTED)):
                continue  # what decides against a name is what the thing did
            predicate, arguments = parsed(each.atom)
            told = self.tell(predicate, arguments, "despite", each)
            if each.atom in pairs and rank(each):
                told = self.tell(*pairs[each.atom], "brief")
            told = told or (self.of(each) if each.leading and rank(each) else "")
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
                told = self.tell(*parsed(each.atom), "despite")
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

    def leaning(self, top: Reason) -> list[Claim]:
        """That the segment's borders are where its thing begins or ceases to lean far over."""
        thing, span = self.clock.objects.get(self.clock.own, ""), self.clock.span(self.clock.own)
        hand, since = self.clock.own.removeprefix("seg(").removesuffix(")").split(",")
        ticks = {int(since): "start"}
        ticks[self.clock.ends.get((hand, int(since)), int(since))] = "end"
        found: dict[str, str] = {}
        for node in top.walk():
            predicate, arguments = parsed(node.atom)
            if predicate == "event" and arguments[2] in LEANING and arguments[3] == thing:
                side = ticks.get(int(arguments[1])) if arguments[0] == hand else None
                if side is not None:
                    found[side] = arguments[2]
        if not found or span is None:
            return []
        told = [
            f"{begins} {self._far_lean(found[side], thing, frame)}"
            for side, begins, frame in zip(("start", "end"), ("begins", "ends"), span, strict=True)
            if side in found
        ]
        text = f"the segment {listed(told)}"
        return [Claim(text, (Quantity(Measure.LEAN, (thing,), *span, form="leaning"),))]

    def _far_lean(self, kind: str, thing: str, frame: int) -> str:
        """What a thing that leans far over begins or ceases to do at a border."""
        known = self.clock.measured
        lean = known.postures.get((thing, frame), (0, 0))[0] / 1000.0
        far = lean >= known.far_over_rad - LEAN_SLACK_RAD
        least = degrees(round(1000.0 * known.far_over_rad))
        told = LEANING[kind][not far].format(thing=self.clock.called(thing), least=least)
        before = lean < known.far_over_rad if kind == "tips" else lean > known.far_over_rad
        return f"{'about ' * (far and before)}where {told}"

    def clear_of(self, claims: Iterable[Claim]) -> list[Claim]:
        """How far an end-effector that touches nothing is from what it may seem to touch.

        That is what is fixed, of a foot, and the nearest of all bodies of which shapes are known or
        assumed.
        """
        known, span = self.clock.measured, self.clock.span(self.clock.own)
        hand, called = hand_of(self.clock.own), self.clock.called
        clear = known.grasps(hand) and any(claim.of in TOUCHING_NOTHING for claim in claims)
        if not clear or span is None or known.apart is None:
            return []
        near: dict[str, float] = {}
        for other in sorted(other for one, other in known.reaches if one == hand):
            between = known.reaches[hand, other].between
            apart = known.apart(hand, other, *span) if between is not Between.ORIGINS else None
            if apart is not None:
                near[other] = apart[0]
        fixed = [other for other in near if hand in known.feet and other not in known.movable]
        nearest = min(near, key=lambda other: (near[other], other), default="")
        shown = [*fixed, *([nearest] if near.get(nearest, FAR_M) < FAR_M else [])]
        return [
            Claim(
                f"the {called(hand)} was {far} from the {called(other)} at the nearest",
                (Quantity(Measure.DISTANCE, (hand, other), *span, form="nearest"),),
            )
            for other, far in {other: gap(near[other]) for other in shown}.items()
        ]

    def also_reached(self, claims: Iterable[Claim]) -> list[Claim]:
        """What else the segment's thing came to touch, where of one thing it is told."""
        thing, span = self.clock.objects.get(self.clock.own, ""), self.clock.span(self.clock.own)
        claims = list(claims)
        known = {body for claim in claims for part in claim.quantities for body in part.bodies}
        new = reached(self.clock, self.clock.own)
        called = self.clock.called
        if span is None or thing not in known:
            return []
        if not new and self._moves_clear(claims, thing, span):
            row = Stretches("touching", (thing, ANY))
            what = "no new object" if self._met_within(thing, span) else "nothing new"
            return [Claim(f"the {called(thing)} came into contact with {what}", (), (), (row,))]
        if not known & {*new}:
            return []
        too = [other for other in new if other not in known]
        both = [other for other in kept(self.clock, self.clock.own) if other not in known]
        clauses = (
            ("came into contact with {} too", too),
            ("counted as in contact with {} both at the start and at the end", both),
        )
        told = (
            (clause.format(listed([f"the {called(other)}" for other in others])), others)
            for clause, others in clauses
            if others
        )
        return [
            Claim(
                f"the {called(thing)} {clause}",
                tuple(Quantity(Measure.DISTANCE, (thing, other), *span) for other in others),
            )
            for clause, others in told
        ]

    def fixed(self, claims: Iterable[Claim]) -> list[Claim]:
        """That what an end-effector touches throughout is fixed, so that it stays."""
        hand, thing = hand_of(self.clock.own), self.clock.objects.get(self.clock.own, "")
        kept = any(claim.of in THROUGHOUT and self._is_of(claim, hand, thing) for claim in claims)
        if not kept or not thing or thing in self.clock.measured.movable:
            return []
        text = f"the {self.clock.called(thing)} {'are' if self._several(thing) else 'is'} fixed"
        return [Claim(text, (), (), (Stretches("thing", (thing,)),))]

    @staticmethod
    def _is_of(claim: Claim, one: str, other: str) -> bool:
        return any({*quantity.bodies} == {one, other} for quantity in claim.quantities)

    def _several(self, body: str) -> bool:
        """Whether a body is told as more than one."""
        return self.clock.called(body) in self.clock.several

    def _moves_clear(self, claims: Iterable[Claim], thing: str, span: tuple[int, int]) -> bool:
        """Whether claims tell how a thing moved, and no contact of it with an object began."""
        courses = any(
            quantity.form in COURSES_TOLD and thing in quantity.bodies
            for claim in claims
            for quantity in claim.quantities
        )
        begun = self._met_within(thing, span) - {*self.clock.frames}
        touches = self.clock.measured.contacts.get((hand_of(self.clock.own), thing), ())
        held = any(first <= span[0] and last >= span[1] for first, last in touches)
        return held and courses and not begun and thing in self.clock.measured.movable

    def _met_within(self, thing: str, span: tuple[int, int]) -> set[str]:
        """What a thing came into contact with after the first frame, but the end-effector."""
        return {
            other
            for pair, spans in self.clock.measured.contacts.items()
            if thing in pair
            for other in pair
            if other not in (thing, hand_of(self.clock.own))
            and any(span[0] < first <= span[1] for first, _ in spans)
        }

    def _lost(self, body: str, gaps: Sequence[tuple[int, int]]) -> str:
        was = "were" if self._several(body) else "was"
        spans = [f"from {self.clock.at(first)} to {self.clock.at(last)}" for first, last in gaps]
        if len(spans) > MOST_GAPS:
            lost = sum(last - first for first, last in gaps) / self.clock.rate_hz
            spans = [f"{len(gaps)} times, for {lost:.2f} s in all"]
        return f"the {self.clock.called(body)} {was} not tracked {listed(spans)}"

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
        nodes.sort(key=lambda node: node.atom.startswith(CLEAR))
        courses = courses or any(each.atom.startswith("wrung(") for each in nodes)
        borne = {tuple(parsed(node.atom)[1][1:]) for node in nodes if node.atom.startswith("on(")}
        for each in nodes:
            pair = pairs.get(each.atom)
            if pair is not None and pair[0] in AT_ONE_SIDE:
                side = AT_ONE_SIDE[pair[0]]
                if rank(each) and (side, *pair[1][1:]) in borne:
                    continue  # which of the two is below is told of the same contact
            if pair is not None:
                told.append(self.tell(*pair, "brief"))
            elif not (courses and each.atom.startswith("moved(")):
                told.append(self.of(each))
        told = [each for each in dict.fromkeys(told) if each and UNBOUND not in each]
        return self._of_both(at_both(told))

    def _of_both(self, clauses: Sequence[str]) -> list[str]:
        """The clauses, of which two that differ in the side, and in numbers of it, are one."""
        joined: dict[str, list[str]] = {}
        for clause in clauses:
            found = _SIDED.fullmatch(clause)
            joined.setdefault(found[1] if found else clause, []).append(clause)
        out = []
        for begin, parts in joined.items():
            text = joined_sides(begin, parts)
            if len(parts) > 1:
                claims = [self.claims[part] for part in parts if part in self.claims]
                self.claims[text] = joined_claims(text, claims)
            out.append(text)
        return out

    def _within_border(self, reason: Reason, nodes: Iterable[Reason]) -> bool:
        """Whether it is a contact at a time within a border, at which the two are told about."""
        if not reason.atom.startswith("contact_at("):
            return False
        told = [parsed(each.atom)[1] for each in nodes if each.atom.startswith("contact_at(")]
        own = parsed(reason.atom)[1]
        at_border = [each[1:3] for each in told if self.clock.side(each[0], int(each[4]))]
        return not self.clock.side(own[0], int(own[4])) and own[1:3] in at_border

    def _of_another(self, reason: Reason) -> bool:
        arguments = parsed(reason.atom.removeprefix("not "))[1]
        return (
            bool(arguments) and arguments[0].startswith("seg(") and arguments[0] != self.clock.own
        )
