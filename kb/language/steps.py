"""The steps of a description: segments that are one action by the rules, as one phrase each."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from capar.model.facts import Touching
from capar.model.observation import Observation, ObservedLink, Segment
from capar.model.par import Motion
from kb.language.phrases import FREE, GIVEN, GOALS, MOMENTARY, QUIET, RECEIVED, Phrasebook
from kb.lexicon.english import joined, the_agent, words_of
from kb.lexicon.wordnet import table, wordnet

Key = tuple[str, int]
"""A segment: its end-effector and its index."""

ONE_ACTION = ("same_action", "resumes", "fragment_of", "rights")
"""Relations of a segment to the one whose action it is part of."""

ON_FOOT = frozenset({"walk", "take a step", "take some steps"})
"""Patterns of the whole body, which name no foot."""


@dataclass(frozen=True)
class Step:
    """One thing that was done."""

    pattern: str
    """``put {1} on {2}``: places for objects, and ``{ee}`` for the end-effector."""

    objects: tuple[str, ...]
    ees: tuple[str, ...]
    """The end-effectors that do it, sorted: one, or both hands."""

    start_s: float
    end_s: float
    name: str = ""
    """The primitive that it says."""

    changes: bool = False
    """Whether it moves an object or applies force to it."""

    segments: tuple[Key, ...] = ()
    """The segments that it tells."""

    count: int = 1
    """How often it was done in succession."""

    paused: bool = False
    """Whether it was interrupted and resumed."""

    purpose: str = ""
    """What for, as a verb, where no step says it."""

    @property
    def signature(self) -> tuple[object, ...]:
        """What two steps have in common that say the same."""
        return self.pattern, self.objects, self.ees, self.purpose


class Narrator:
    """Turns the segments of an observation into steps."""

    def __init__(self, observation: Observation, book: Phrasebook) -> None:
        self._seen, self._book = observation, book
        self._tags = {each.name: each.tag for each in observation.objects}
        self._motions = {(each.ee, each.start_s): each.core.motion for each in observation.ipars}
        self._actions: dict[Key, Key] = {}
        self._kinds: dict[Key, set[str]] = defaultdict(set)
        for each in observation.relations:
            self._kinds[each.segment].add(each.kind)
            if each.kind in ONE_ACTION:
                self._actions[each.segment] = each.other
        self._next = {(each.ee, each.index - 1): each for each in observation.segments}
        self._names = {each.name for each in observation.segments}
        self._takings = dict(_handed_over(observation.segments))

    def steps(self, links: Sequence[ObservedLink]) -> tuple[Step, ...]:
        """What some links of one agent did, in order of time; motion of no object is left out."""
        literal = self._seen.profile == "thesis"
        told = {link.ee: self._of_link(link) for link in _spoken(links)}
        hands = [link for link in _spoken(links) if link.kind == "hand"]
        steps = list(told.pop(hands[0].ee)) if hands else []
        for link in hands[1:]:
            steps = self._with(steps, told.pop(link.ee))
        handled = {(name, step.ees) for step in steps for name in step.objects[:1]}
        for link in _spoken(links):
            if link.ee in told and link.kind != "foot":
                steps += [
                    step
                    for step in told[link.ee]
                    if literal or not step.objects or not _is_handled(step, steps, handled)
                ]
        steps += self._on_foot([link for link in links if link.kind == "foot"], told)
        return tuple(sorted(steps, key=lambda each: (each.start_s, each.end_s, each.ees)))

    def _of_link(self, link: ObservedLink) -> list[Step]:
        """What one link did: a step for each group of segments that are one action."""
        groups: dict[Key, list[Segment]] = defaultdict(list)
        for segment in link.segments:
            groups[self._root((segment.ee, segment.index))].append(segment)
        found = [
            self._step(members, link)
            for members in groups.values()
            if any(each.objects for each in members) and members[0] not in self._takings.values()
        ]
        return self._with_purposes(sorted(found, key=lambda each: each.start_s))

    def _root(self, key: Key) -> Key:
        seen = {key}
        while (after := self._actions.get(key)) is not None and after not in seen:
            key = after
            seen.add(key)
        return key

    def _step(self, members: Sequence[Segment], link: ObservedLink) -> Step:
        own = [
            each
            for each in members
            if each.objects and not self._kinds[each.ee, each.index] & {"fragment_of", "rights"}
        ] or [each for each in members if each.objects]
        changing = [each for each in own if each.features.rel_start != each.features.rel_end]
        said = (changing[-1:] or sorted(own, key=lambda each: -len(each.objects)))[0]
        said = said if changing or said.name == own[0].name else own[0]
        before = _before(link, members[0])
        pattern, objects = self._phrase(said, before)
        changes = "1" in said.features.change_loc + said.features.force
        moment = pattern in MOMENTARY or said.name == "Give"
        start_s = min(each.start_s for each in members)
        return Step(
            pattern=pattern,
            objects=objects,
            ees=(link.ee,),
            start_s=start_s,
            end_s=start_s if moment else max(each.end_s for each in members),
            name=said.name,
            changes=(changes and pattern not in QUIET) or not said.known,
            segments=tuple((each.ee, each.index) for each in members),
            paused=any("resumes" in self._kinds[each.ee, each.index] for each in members),
            purpose=said.purpose,
        )

    def _phrase(self, segment: Segment, before: Segment | None) -> tuple[str, tuple[str, ...]]:
        """The pattern of a segment, and its objects with those that only the pattern names."""
        objects = segment.objects
        if not segment.known:
            moved = segment.possessed and segment.features.change_loc.startswith("1")
            things = "{1}" if moved else _places(len(objects))
            verb = "move" if moved else "handle"
            return f"{verb} {things} {{with}}in a way that no rule names", objects
        cases = self._cases(segment, before)
        pattern = self._book.pattern(segment.name, segment.general, cases, len(objects))
        if "in" in cases and pattern.startswith(GOALS):
            pattern = "put {1} in {2}"
        if pattern == GIVEN:
            pattern += self._receiver(segment)
        if "someone" in pattern:
            pattern = pattern.replace("someone", self._taker(segment) or "someone")
        if not segment.possessed and "{2}" not in pattern and _touches_all(segment):
            objects = tuple(sorted(objects))
            return pattern.replace("{1}", _places(len(objects))), objects
        source = self._source(segment)
        if source and pattern in {"lift {1}", "bring {1} to {2}"}:
            where = f"{{{len(objects) + 1}}}"
            to = f"{{1}} off {where}" if pattern == "lift {1}" else f"{{1}} from {where}"
            return pattern.replace("{1}", to), (*objects, source)
        loads = [
            other
            for word, body, other in segment.prepositions
            if word == "with" and body == objects[0] and other not in objects
        ]
        if loads and segment.possessed and "{1}" in pattern:
            places = [f"{{{len(objects) + at}}}" for at in range(1, len(loads) + 1)]
            pattern = pattern.replace("{1}", f"{{1}} with {joined(places)}")
        return pattern, (*objects, *loads)

    def _cases(self, segment: Segment, before: Segment | None) -> set[str]:
        """What holds of a segment, in the words of the table of phrases."""
        key = segment.ee, segment.index
        motion = self._motions.get((segment.ee, segment.start_s), Motion.NONE)
        same = before is not None and before.objects[:1] == segment.objects[:1]
        cases = {
            "held": segment.possessed or (before is not None and same and before.possessed),
            "steadies": "steadies" in self._kinds[key],
            "turns": motion is Motion.ROTATION,
            "tilts": motion is Motion.BOTH,
            "alone": len(segment.objects) < 2,
        }
        if len(segment.objects) > 1:
            thing, other = segment.objects[:2]
            said = {word for word, body, at in segment.prepositions if (body, at) == (thing, other)}
            cases |= {
                "tool": ("with", other, thing) in segment.prepositions,
                "there": before is not None and before.objects[:2] == (thing, other),
                "self": self._tags.get(other) == "self",
                "rises": ("up", thing, thing) in segment.prepositions,
                "on": bool(said & {"on", "onto"}) and not self._works_at(segment, thing, other),
                "movable": self._tags.get(other) == "mobile",
                "off": "off" in said,
                "in": bool(said & {"in", "into"}),
                "back": self._was_there(segment, thing, other),
            }
        return {name for name, holds in cases.items() if holds}

    def _works_at(self, segment: Segment, thing: str, other: str) -> bool:
        """Whether the other is of a body, or the hand next moves the object at it."""
        after = self._next.get((segment.ee, segment.index))
        works = (
            after is not None
            and after.objects[:2] == (thing, other)
            and after.features.change_loc.startswith("1")
        )
        return self._tags.get(other) == "self" or (self._tags.get(other) == "mobile" and works)

    def _was_there(self, segment: Segment, thing: str, other: str) -> bool:
        """Whether the object touched the other before, and left it."""
        return any(
            {each.body, each.other} == {thing, other}
            and each.first <= segment.first
            and each.last < segment.last
            for each in self._seen.facts
            if isinstance(each, Touching)
        )

    def _source(self, segment: Segment) -> str:
        """What the object is taken off, or out of, that the segment does not name."""
        return next(
            (
                other
                for word, body, other in segment.prepositions
                if word in {"off", "out of"}
                and body in segment.objects[:1]
                and other not in segment.objects
            ),
            "",
        )

    def _receiver(self, segment: Segment) -> str:
        """Which hand takes what this one gives: `` to the left hand``."""
        taking = self._takings.get(segment)
        return "".join(
            f" to the {spoken(other)}"
            for other in self._seen.links
            if taking is not None and other.ee == taking.ee
        )

    def _taker(self, segment: Segment) -> str:
        """The one other agent who has the object after this segment; empty if not known."""
        agents = {each.name: each.kind for each in (self._seen.agent, *self._seen.others)}
        own = self._seen.performer(segment.ee)
        takers = {
            self._seen.performer(other.ee)
            for other in self._seen.segments
            if other.objects[:1] == segment.objects[:1]
            and other.first <= segment.last
            and segment.first < other.last
        } - {own}
        return the_agent(name := takers.pop(), agents.get(name, "")) if len(takers) == 1 else ""

    def _with_purposes(self, steps: Sequence[Step]) -> list[Step]:
        """The steps, with each purpose at the last one that serves it, unless a step fulfils it.

        A purpose that is the name of another segment only says what comes next.
        """
        last = {each.purpose: at for at, each in enumerate(steps) if each.changes}
        out = [replace(each, purpose="") for each in steps]
        for purpose, at in last.items():
            verb = words_of(purpose)
            told = any(each.pattern.split()[0] == verb.split(" ")[0] for each in steps)
            if purpose and purpose not in self._names and not told and wordnet().of_lemma(verb):
                head, _, particle = verb.partition(" ")
                out[at] = replace(out[at], purpose=f"{head} it {particle}" if particle else verb)
        return out

    def _with(self, steps: Sequence[Step], others: Sequence[Step]) -> list[Step]:
        """The steps of two hands; what they do together is one step of both."""
        out, rest = list(steps), []
        for other in others:
            at = next((at for at, own in enumerate(out) if self._one(own, other)), None)
            if at is None:
                rest.append(other)
                continue
            own = out[at]
            out[at] = replace(
                other if self._joint(own, other) == other.name else own,
                ees=tuple(sorted({*own.ees, *other.ees})),
                start_s=min(own.start_s, other.start_s),
                end_s=max(own.end_s, other.end_s),
                segments=(*own.segments, *other.segments),
                paused=own.paused and other.paused,
            )
        return [*out, *rest]

    def _one(self, own: Step, other: Step) -> bool:
        """Whether two hands of one body do one thing: jointly, or the same at the same time."""
        if own.objects[:1] != other.objects[:1] or set(own.ees) & set(other.ees):
            return False
        if self._joint(own, other):
            return True
        alike = own.pattern == other.pattern and own.objects == other.objects
        momentary = own.start_s == own.end_s and other.start_s == other.end_s
        starts_s, ends_s = max(own.start_s, other.start_s), min(own.end_s, other.end_s)
        longest_s = max(own.end_s - own.start_s, other.end_s - other.start_s)
        together = 2.0 * (ends_s - starts_s) > longest_s
        return alike and (together or (momentary and _spans_meet(self._seen, own, other)))

    def _joint(self, own: Step, other: Step) -> str:
        """The name of what both do as one action; empty where they do not."""
        for joint in self._seen.joint:
            parts = set(zip(joint.ees, joint.segments, strict=True))
            if parts & set(own.segments) and parts & set(other.segments):
                return joint.name
        return ""

    def _on_foot(self, feet: Sequence[ObservedLink], told: dict[str, list[Step]]) -> Iterable[Step]:
        """Walks as one step each, other steps on foot by their number, and what else feet did."""
        ees = {link.ee for link in feet}
        walks = [each for each in self._seen.joint if each.name == "Walk" and set(each.ees) <= ees]
        walked = {key for each in walks for key in zip(each.ees, each.segments, strict=True)}
        for walk in walks:
            parts = tuple(zip(walk.ees, walk.segments, strict=True))
            yield Step("walk", (), walk.who, walk.start_s, walk.end_s, "Walk", True, parts)
        names = {(each.ee, each.index): each.name for each in self._seen.segments}
        taken = [
            step
            for ee in sorted(ees)
            for step in told.get(ee, ())
            if not walked & set(step.segments)
        ]
        stepped = [each for each in taken if names[each.segments[0]] == "Step"]
        if stepped and not walks:
            start_s, end_s = (
                min(each.start_s for each in stepped),
                max(each.end_s for each in stepped),
            )
            parts = tuple(key for each in stepped for key in each.segments)
            pattern = "take a step" if len(stepped) == 1 else "take some steps"
            yield Step(pattern, (), tuple(sorted(ees)), start_s, end_s, "Step", True, parts)
        stays = {"Step", "Stand", "RestFoot"}
        yield from (each for each in taken if names[each.segments[0]] not in stays)

    def free_motion(self, links: Sequence[ObservedLink]) -> dict[str, tuple[float, float]]:
        """The end-effectors that moved, of no object, each from when to when [s]."""
        out = {}
        for link in _spoken(links):
            free = [
                each
                for each in link.segments
                if self._book.pattern(each.name, each.general, (), 0) == FREE
            ]
            if free:
                out[link.ee] = free[0].start_s, free[-1].end_s
        return out


def spoken(link: ObservedLink) -> str:
    """A body part by its side, where it has one: ``left elbow``."""
    return (
        f"{link.side} {link.kind}" if link.side in {"left", "right"} else link.ee.replace("_", " ")
    )


def _spoken(links: Sequence[ObservedLink]) -> list[ObservedLink]:
    """The links that a description names: a finger's is left out where its hand's is there."""
    wholes = {row["part"]: row["whole"] for row in table("body_parts")}
    there = {(each.kind, each.side) for each in links}
    return [
        each
        for each in links
        if (wholes.get(each.kind.rstrip("0123456789")), each.side) not in there
    ]


def _before(link: ObservedLink, segment: Segment) -> Segment | None:
    """The last segment before another one of the same link that has an object."""
    earlier = [each for each in link.segments if each.index < segment.index and each.objects]
    return earlier[-1] if earlier else None


def _handed_over(segments: Sequence[Segment]) -> Iterable[tuple[Segment, Segment]]:
    """Each giving with the taking of the same object by another end-effector, begun by its end."""
    for giving in segments:
        takings = [
            each
            for each in segments
            if giving.name == "Give"
            and each.name in RECEIVED
            and each.ee != giving.ee
            and each.objects[:1] == giving.objects[:1]
            and each.first <= giving.last
        ]
        if takings:
            yield giving, max(takings, key=lambda each: each.first)


def _is_handled(
    step: Step, steps: Sequence[Step], handled: set[tuple[str, tuple[str, ...]]]
) -> bool:
    """Whether hands are told to have the object during a step of another limb."""
    return any(
        name in step.objects[:1]
        and any(
            own.ees == ees and own.start_s < step.end_s and step.start_s < own.end_s
            for own in steps
            if own.objects[:1] == (name,)
        )
        for name, ees in handled
    )


def _spans_meet(observation: Observation, own: Step, other: Step) -> bool:
    """Whether segments of two steps go on at the same time."""
    first, second = (
        [each for each in observation.segments if (each.ee, each.index) in step.segments]
        for step in (own, other)
    )
    return any(one.first <= two.last and two.first <= one.last for one in first for two in second)


def _touches_all(segment: Segment) -> bool:
    """Whether the end-effector touches all of several objects at once."""
    count = segment.features.count
    ends = (segment.features.rel_start[:count], segment.features.rel_end[:count])
    return count > 1 and "1" * count in ends


def _places(count: int) -> str:
    return joined([f"{{{number}}}" for number in range(1, count + 1)])
