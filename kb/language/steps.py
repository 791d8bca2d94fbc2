"""The steps of a description: segments that are one action by the rules, as one phrase each."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from capar.model.facts import Touching
from capar.model.observation import Observation, ObservedLink, Segment
from capar.model.par import Motion
from kb.language.phrases import phrase_pattern
from kb.lexicon.english import joined, the_agent, words_of
from kb.lexicon.links import PrimitiveWords
from kb.lexicon.wordnet import table, wordnet

Key = tuple[str, int]
"""A segment: its end-effector and its index."""

ONE_ACTION = ("same_action", "resumes", "fragment_of", "rights")
"""Relations of a segment to the one whose action it is part of."""

QUIET = frozenset({"reach for {1}", "let go of {1}", "take {ee} away"})
"""Patterns of the hand's own way to an object, or back from it."""

ON_FOOT = frozenset({"walk", "take a step", "take some steps"})
"""Patterns of the whole body, which name no foot."""

NAMELESS = ON_FOOT | {"clap the hands"}
"""Patterns that say who does it without an end-effector."""

FREE = "PostureChange"
"""The primitive of motion that is of no object."""


@dataclass(frozen=True)
class Step:
    """One action of a description."""

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
    count: int = 1
    """How often it was done in succession."""

    paused: bool = False
    """Whether it was interrupted and resumed."""

    purpose: str = ""
    """What for, as a verb, where no step says it."""


class Narrator:
    """Turns the segments of an observation into steps."""

    def __init__(self, observation: Observation, words: Iterable[PrimitiveWords]) -> None:
        self._seen = observation
        self._words = {each.name: each for each in words}
        self._tags = {each.name: each.tag for each in observation.objects}
        self._motions = {(each.ee, each.start_s): each.core.motion for each in observation.ipars}
        self._whole: dict[Key, Key] = {}
        self._kinds: dict[Key, set[str]] = defaultdict(set)
        for relation in observation.relations:
            self._kinds[relation.segment].add(relation.kind)
            if relation.kind in ONE_ACTION:
                self._whole[relation.segment] = relation.other
        self._next = {(each.ee, each.index - 1): each for each in observation.segments}
        self._takings = {
            giving: taking
            for giving in observation.segments
            if giving.name == "Give"
            for taking in sorted(observation.segments, key=lambda each: each.first)
            if taking.name in {"Receive", "Accept"}
            if taking.ee != giving.ee and taking.objects[:1] == giving.objects[:1]
            if taking.first <= giving.last
        }

    def steps(self, links: Sequence[ObservedLink]) -> list[Step]:
        """What some links of one agent did, in order of time; motion of no object is left out.

        What another limb does to an object that hands have meanwhile is left out, but in the
        thesis profile.
        """
        wholes = {row["part"]: row["whole"] for row in table("body_parts")}
        there = {(each.kind, each.side) for each in links}
        named = [
            link
            for link in links
            if (wholes.get(link.kind.rstrip("0123456789")), link.side) not in there
        ]
        hands: list[Step] = []
        for link in named:
            if link.kind == "hand":
                hands = self._with(hands, self._of_link(link))
        feet = [link for link in links if link.kind == "foot"]
        steps = [*hands, *self._on_foot(feet)]
        for link in named:
            if link.kind not in {"hand", "foot"}:
                steps += [
                    step
                    for step in self._of_link(link)
                    if self._seen.profile == "thesis"
                    or not any(
                        step.objects[:1] == own.objects[:1]
                        and own.start_s < step.end_s
                        and step.start_s < own.end_s
                        for own in hands
                    )
                ]
        return sorted(steps, key=lambda each: (each.start_s, each.end_s, each.ees))

    def _of_link(self, link: ObservedLink) -> list[Step]:
        """What one link did: a step for each group of segments that are one action."""
        groups: dict[Key, list[Segment]] = defaultdict(list)
        for segment in link.segments:
            key = segment.ee, segment.index
            for _ in link.segments:
                key = self._whole.get(key, key)
            groups[key].append(segment)
        steps = [
            self._step(members, link)
            for members in groups.values()
            if any(each.objects or self._gesture(each, link) for each in members)
            and members[0] not in self._takings.values()
        ]
        steps.sort(key=lambda each: each.start_s)
        last = {step.purpose: at for at, step in enumerate(steps) if step.changes}
        said = {step.pattern.split()[0] for step in steps}
        ends = {at: self._end(purpose, said) for purpose, at in last.items()}
        return [replace(step, purpose=ends.get(at, "")) for at, step in enumerate(steps)]

    def _gesture(self, segment: Segment, link: ObservedLink) -> bool:
        """Whether motion of no object is said: it has a word, or the limb handles nothing."""
        if segment.name == FREE:
            tags = {self._tags.get(name) for each in link.segments for name in each.objects}
            whither = self._cases(segment, None) & {"rises", "sinks", "away", "toward"}
            return link.kind == "hand" and bool(whither) and tags <= {"self"}
        return FREE in segment.general and not segment.objects

    def _end(self, purpose: str, said: set[str]) -> str:
        """A purpose as a verb; none where a step says it or another segment has its name."""
        head, _, particle = words_of(purpose).partition(" ")
        known = bool(wordnet().of_lemma(words_of(purpose))) if purpose else False
        if not known or head in said or any(each.name == purpose for each in self._seen.segments):
            return ""
        return f"{head} it {particle}" if particle else head

    def _step(self, members: Sequence[Segment], link: ObservedLink) -> Step:
        """The step of segments that are one action: the last one that changes something says it."""
        own = [
            each
            for each in members
            if not self._kinds[each.ee, each.index] & {"fragment_of", "rights"}
        ]
        own = [each for each in own if each.objects] or own or list(members)
        changing = [each for each in own if each.features.rel_start != each.features.rel_end]
        said = changing[-1] if changing else own[0]
        earlier = [e for e in link.segments if e.index < members[0].index and e.objects]
        pattern, objects = self._phrase(said, earlier[-1] if earlier else None)
        changes = "1" in said.features.change_loc + said.features.force
        return Step(
            pattern=pattern,
            objects=objects,
            ees=(link.ee,),
            start_s=min(each.start_s for each in members),
            end_s=max(each.end_s for each in members),
            name=said.name,
            changes=(changes and pattern not in QUIET) or not said.known,
            segments=tuple((each.ee, each.index) for each in members),
            paused=any("resumes" in self._kinds[each.ee, each.index] for each in members),
            purpose=said.purpose,
        )

    def _phrase(self, segment: Segment, before: Segment | None) -> tuple[str, tuple[str, ...]]:
        """The pattern of a segment, and its objects with those that only the pattern names."""
        objects, count = segment.objects, len(segment.objects)
        places = joined([f"{{{number}}}" for number in range(1, count + 1)])
        if not segment.known:
            moved = segment.possessed and segment.features.change_loc.startswith("1")
            verb = "move {1}" if moved else f"handle {places}"
            return f"{verb} in a way that no rule names", objects
        cases = self._cases(segment, before)
        text = phrase_pattern(segment.name, segment.general, cases, count, self._words)
        if "in" in cases and text in {"put {1} on {2}", "bring {1} to {2}"}:
            text = "put {1} in {2}"
        if text == "hand {1} over" and (taking := self._takings.get(segment)) is not None:
            (link,) = (each for each in self._seen.links if each.ee == taking.ee)
            text += f" to the {spoken(link)}"
        if "someone" in text:
            text = text.replace("someone", self._taker(segment))
        touched = segment.features.rel_start[:count], segment.features.rel_end[:count]
        if not segment.possessed and count > 1 and "{2}" not in text and "1" * count in touched:
            return text.replace("{1}", places), tuple(sorted(objects))
        others = [
            (word, other)
            for word, body, other in segment.prepositions
            if objects[:1] == (body,) and other not in objects
        ]
        source = [other for word, other in others if word in {"off", "out of"}][:1]
        if source and text in {"lift {1}", "bring {1} to {2}"}:
            word = "off" if text == "lift {1}" else "from"
            return text.replace("{1}", f"{{1}} {word} {{{count + 1}}}"), (*objects, *source)
        goal = [each for each in others if each[0] in {"into", "onto"}][:1]
        if goal and text == "drop {1}":
            return f"drop {{1}} {goal[0][0]} {{{count + 1}}}", (*objects, goal[0][1])
        loads = [other for word, other in others if word == "with" and segment.possessed]
        if loads:
            loaded = joined([f"{{{count + at}}}" for at in range(1, len(loads) + 1)])
            text = text.replace("{1}", f"{{1}} with {loaded}")
        return text, (*objects, *loads)

    def _cases(self, segment: Segment, before: Segment | None) -> set[str]:
        """What holds of a segment, in the words of the table of phrases."""
        key = segment.ee, segment.index
        motion = self._motions.get((segment.ee, segment.start_s))
        same = before is not None and before.objects[:1] == segment.objects[:1]
        cases = {
            "held": segment.possessed or (before is not None and same and before.possessed),
            "steadies": "steadies" in self._kinds[key],
            "turns": motion is Motion.ROTATION,
            "tilts": motion is Motion.BOTH,
            "alone": len(segment.objects) < 2,
            "rises": ("up", segment.ee, segment.ee) in segment.prepositions,
            "sinks": ("down", segment.ee, segment.ee) in segment.prepositions,
        }
        own = {word for word, _, other in segment.prepositions if self._tags.get(other) == "self"}
        cases |= {"away": "away from" in own, "toward": "toward" in own}
        if len(segment.objects) > 1:
            pair = thing, other = segment.objects[:2]
            words = {word for word, body, at in segment.prepositions if (body, at) == pair}
            after = self._next.get(key)
            worked_at = (
                after is not None
                and after.objects[:2] == pair
                and after.features.change_loc.startswith("1")
            )
            tag = self._tags.get(other)
            cases |= {
                "tool": ("with", other, thing) in segment.prepositions,
                "there": before is not None and before.objects[:2] == pair,
                "self": tag == "self",
                "rises": ("up", thing, thing) in segment.prepositions,
                "on": bool(words & {"on", "onto"})
                and tag != "self"
                and not (tag == "mobile" and worked_at),
                "in": bool(words & {"in", "into"}),
                "movable": tag == "mobile",
                "off": "off" in words,
                "back": any(
                    isinstance(each, Touching)
                    and {each.body, each.other} == set(pair)
                    and each.first <= segment.first
                    and each.last < segment.last
                    for each in self._seen.facts
                ),
            }
        return {name for name, holds in cases.items() if holds}

    def _taker(self, segment: Segment) -> str:
        """The one other agent who has the object after this segment, or ``someone``."""
        takers = {
            self._seen.performer(other.ee)
            for other in self._seen.segments
            if other.objects[:1] == segment.objects[:1]
            and other.first <= segment.last
            and segment.first < other.last
        } - {self._seen.performer(segment.ee)}
        if len(takers) != 1:
            return "someone"
        name = takers.pop()
        agents = (self._seen.agent, *self._seen.others)
        return the_agent(name, next((each.kind for each in agents if each.name == name), ""))

    def _with(self, steps: Sequence[Step], others: Sequence[Step]) -> list[Step]:
        """The steps of two hands; what they do together is one step of both."""
        out = list(steps)
        for other in others:
            found = (at for at, own in enumerate(steps) if self._joint(own, other) is not None)
            at = next(found, None)
            if at is None:
                out.append(other)
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
        return out

    def _joint(self, own: Step, other: Step) -> str | None:
        """The name of what two hands of one body do together; None where they do not.

        It is a joint action by the rules, or the same action for more than half of the time.
        """
        each_other = (own.objects[:1], other.objects[:1]) == (other.ees, own.ees)
        if own.objects[:1] != other.objects[:1] and not each_other:
            return None
        for joint in self._seen.joint:
            parts = set(zip(joint.ees, joint.segments, strict=True))
            if parts & set(own.segments) and parts & set(other.segments):
                return joint.name
        alike = own.pattern == other.pattern and (each_other or own.objects == other.objects)
        shared_s = min(own.end_s, other.end_s) - max(own.start_s, other.start_s)
        longest_s = max(own.end_s - own.start_s, other.end_s - other.start_s)
        return "" if alike and 2.0 * shared_s > longest_s else None

    def _on_foot(self, feet: Sequence[ObservedLink]) -> Iterable[Step]:
        """Walks as one step each, other steps on foot together, and what else feet did."""
        ees = tuple(sorted(link.ee for link in feet))
        walked: set[Key] = set()
        for walk in self._seen.joint:
            if walk.name == "Walk" and set(walk.ees) <= set(ees):
                parts = tuple(zip(walk.ees, walk.segments, strict=True))
                walked |= set(parts)
                yield Step("walk", (), walk.who, walk.start_s, walk.end_s, "Walk", True, parts)
        done = [
            step for link in feet for step in self._of_link(link) if not walked & set(step.segments)
        ]
        taken = [step for step in done if step.name == "Step"]
        if taken and not walked:
            start_s, end_s = min(s.start_s for s in taken), max(s.end_s for s in taken)
            parts = tuple(key for step in taken for key in step.segments)
            pattern = "take a step" if len(parts) == 1 else "take some steps"
            yield Step(pattern, (), ees, start_s, end_s, "Step", True, parts)
        told = [step for step in done if step.name not in {"Step", "Stand", "RestFoot"}]
        kicks = [step for step in told if step.name == "KickOut"]
        yield from (
            step
            for step in told
            if step.name != "StandOnOneLeg"
            or not any(k.start_s < step.end_s and step.start_s < k.end_s for k in kicks)
        )


def spoken(link: ObservedLink) -> str:
    """A body part by its side, where it has one: ``left elbow``."""
    return (
        f"{link.side} {link.kind}" if link.side in {"left", "right"} else link.ee.replace("_", " ")
    )
