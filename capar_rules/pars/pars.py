"""PARs of named segments: primitive, complex, and the rules that named them."""

import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache, cached_property
from hashlib import sha256
from itertools import pairwise
from pathlib import Path

from capar.model.observation import ObservedLink, Segment
from capar.model.par import (
    Call,
    ComplexPar,
    Condition,
    Constraint,
    CoreSemantics,
    Ipar,
    LinkSteps,
    Motion,
    NamingRule,
    Preparation,
    Relation,
    Step,
    Threshold,
    Upar,
)
from capar_rules.engine.profiles import Profile
from capar_rules.engine.solver import loaded_files
from capar_rules.pars.inference import Conditions, Inference, Key, Pair

ALL = "all"
"""The end-effector of a step that is common to every link."""


def compose(inference: Inference, *, name: str, frames: int, duration_s: float) -> ComplexPar:
    """The complex PAR of everything observed (thesis 4.6.2).

    ``inference``: segments, and which of them make one common last step. ``duration_s``: the whole
    duration [s].
    """
    common = _common(inference, name, frames)
    end = common.begin if common else 1.0
    links = tuple(
        LinkSteps(link.ee, _steps(inference, link, name, frames, end)) for link in inference.links
    )
    return ComplexPar(
        name=name,
        objects=_in_order(inference.links),
        duration_s=duration_s,
        links=links,
        common=common,
        relations=tuple(_relations(links, frames)),
    )


def _common(inference: Inference, name: str, frames: int) -> Step | None:
    """The last step of all links, from when the last of them begins it."""
    segments = [
        each
        for link in inference.links
        for each in link.segments
        if (each.ee, each.index) in inference.common
    ]
    if not segments:
        return None
    begin = max(segment.first for segment in segments)
    return Step(
        action=segments[0].name,
        ee=ALL,
        objects=tuple(sorted({name for each in segments for name in each.objects})),
        share=_share(begin, frames, frames),
        purpose=segments[0].purpose,
        begin=_share(0, begin, frames),
        segments=tuple(segment.index for segment in segments),
        posture=f"{name}End",
    )


def _steps(
    inference: Inference, link: ObservedLink, name: str, frames: int, end: float
) -> tuple[Step, ...]:
    """One step a segment, but for rest; the last before a common step waits for it."""
    own = [
        segment for segment in link.segments if (segment.ee, segment.index) not in inference.common
    ]
    steps = [_step(each, name, frames) for each in _waited(own, inference)]
    if steps and steps[-1].begin + steps[-1].share != end:
        steps[-1] = _lasting(steps[-1], end - steps[-1].begin)
    return tuple(steps)


def _waited(segments: Sequence[Segment], inference: Inference) -> list[Segment]:
    """Segments without those of rest: it belongs to what it precedes, or, at the end, follows."""
    active = [
        segment for segment in segments if (segment.ee, segment.index) not in inference.no_steps
    ]
    if not active:
        return list(segments)
    edges = [segments[0].first, *(each.last for each in active[:-1]), segments[-1].last]
    return [
        replace(each, first=first, last=last)
        for each, (first, last) in zip(active, pairwise(edges), strict=True)
    ]


def _step(segment: Segment, name: str, frames: int) -> Step:
    return Step(
        action=segment.name,
        ee=segment.ee,
        objects=segment.objects,
        share=_share(segment.first, segment.last, frames),
        purpose=segment.purpose,
        begin=_share(0, segment.first, frames),
        segments=(segment.index,),
        posture=posture(segment, name),
    )


def posture(segment: Segment, name: str) -> str:
    """The posture that a segment ends in, where it ends in no contact (thesis 4.6.2)."""
    if "1" in segment.features.rel_end:
        return ""
    return f"{name}End" if segment.ends[0].kind == "last" else f"{name}{segment.index}"


def _lasting(step: Step, share: float) -> Step:
    return Step(
        step.action,
        step.ee,
        step.objects,
        share,
        step.purpose,
        step.begin,
        step.segments,
        step.posture,
    )


def _share(first: int, last: int, frames: int) -> float:
    return float(Fraction(last - first, frames))


def _in_order(links: Iterable[ObservedLink]) -> tuple[str, ...]:
    """Every object of a segment, in order of first use; of one segment, in its own order."""
    segments = [each for link in links for each in link.segments]
    ordered = sorted(segments, key=lambda each: (each.last, each.ee))
    return tuple(dict.fromkeys(name for each in ordered for name in each.objects))


def _relations(links: tuple[LinkSteps, ...], frames: int) -> Iterable[Relation]:
    """Allen's relations of steps of different links that share time or meet."""
    for place, link in enumerate(links):
        for other in links[place + 1 :]:
            yield from _between(link, other, frames)


def _between(link: LinkSteps, other: LinkSteps, frames: int) -> Iterable[Relation]:
    start = 0
    for index, step in enumerate(link.steps):
        first, last = _span(step, frames)
        while start < len(other.steps) and _span(other.steps[start], frames)[1] < first:
            start += 1
        for number in range(start, len(other.steps)):
            begin, end = _span(other.steps[number], frames)
            if begin > last:
                break
            yield Relation((link.ee, index), allen(first, last, begin, end), (other.ee, number))


def _span(step: Step, frames: int) -> tuple[int, int]:
    return round(step.begin * frames), round((step.begin + step.share) * frames)


def allen(first: float, last: float, begin: float, end: float) -> str:
    """Allen's relation of the interval [first, last] to [begin, end], in OWL-Time's words."""
    if last < begin or end < first:
        return "before" if last < begin else "after"
    if last == begin or end == first:
        return "meets" if last == begin else "metBy"
    if first == begin:
        return "equals" if last == end else ("starts" if last < end else "startedBy")
    if last == end:
        return "finishes" if first > begin else "finishedBy"
    if first < begin:
        return "contains" if last > end else "overlaps"
    return "during" if last < end else "overlappedBy"


AGENT = "agent"
"""The parameter that stands for the agent."""

EE = "EE"
"""The parameter that stands for the end-effector."""


@dataclass(frozen=True)
class Measured:
    """What was measured of a segment for its core semantics."""

    motion: Motion
    path: tuple[tuple[float, float, float], ...]
    """Where the moved object, or else the end-effector, begins and ends [m]."""


def upars(inference: Inference, measured: Mapping[Key, Measured], *, name: str) -> tuple[Upar, ...]:
    """One UPAR for each name and feature set, from the first segment that has them."""
    found: dict[tuple[str, object], Upar] = {}
    for segment in _segments(inference):
        if segment.known:
            key = (segment.name, segment.features)
            conditions = inference.conditions[segment.ee, segment.index]
            motion = measured[segment.ee, segment.index].motion
            found.setdefault(key, _upar(segment, conditions, motion, name))
    return tuple(sorted(found.values(), key=lambda each: (each.name, each.core.constraint)))


def ipars(
    inference: Inference, measured: Mapping[Key, Measured], *, agent: str, name: str
) -> tuple[Ipar, ...]:
    """One IPAR a segment, links in order.

    ``inference``: segments and their conditions. ``measured``: what was measured of each segment.
    ``agent``: who acts, where a link does not say whose it is.
    """
    agents = {link.ee: link.agent or agent for link in inference.links}
    return tuple(
        _ipar(
            segment,
            inference.conditions[segment.ee, segment.index],
            measured[segment.ee, segment.index],
            agents[segment.ee],
            name,
        )
        for segment in _segments(inference)
    )


def _segments(inference: Inference) -> Iterable[Segment]:
    return (segment for link in inference.links for segment in link.segments)


def _upar(segment: Segment, conditions: Conditions, motion: Motion, parent: str) -> Upar:
    objects = tuple(f"obj{index + 1}" for index in range(len(segment.objects)))
    return Upar(
        name=segment.name,
        agent=AGENT,
        objects=objects,
        general=segment.general,
        applicability=_applicability(AGENT, segment.name, objects),
        preparation=_preparation(conditions, EE, objects, purpose=segment.name),
        steps=(Call(segment.name, objects),),
        core=_core(segment, conditions, EE, objects, motion),
        post_assertions=_post_assertions(conditions, EE, objects),
        parent=parent,
    )


def _ipar(
    segment: Segment, conditions: Conditions, measured: Measured, agent: str, parent: str
) -> Ipar:
    objects, ee = segment.objects, segment.ee
    return Ipar(
        upar=segment.name,
        agent=agent,
        ee=ee,
        objects=objects,
        start_s=segment.start_s,
        core=_core(
            segment,
            conditions,
            ee,
            objects,
            measured.motion,
            path=measured.path,
            purpose=segment.purpose,
            duration_s=segment.end_s - segment.start_s,
            manner=agent,
        ),
        preparation=_preparation(conditions, ee, objects, purpose=segment.name),
        post_assertions=_post_assertions(conditions, ee, objects),
        posture=posture(segment, parent),
        parent=parent,
    )


def _core(
    segment: Segment,
    conditions: Conditions,
    ee: str,
    objects: Sequence[str],
    motion: Motion,
    *,
    path: tuple[tuple[float, float, float], ...] = (),
    purpose: str = "",
    duration_s: float | None = None,
    manner: str = "",
) -> CoreSemantics:
    moves = "1" in segment.features.change_loc
    forced = (name for name, bit in zip(objects, segment.features.force, strict=True) if bit == "1")
    return CoreSemantics(
        motion=motion,
        moved=objects[segment.features.change_loc.index("1")] if moves else "",
        causal=moves and segment.possessed,
        force=tuple(forced),
        path=path,
        purpose=purpose,
        enables=(purpose,) if purpose else (),
        termination=tuple(
            Condition("duration", ()) if pair is None else _contact(pair, ee, objects, holds=holds)
            for pair, holds in conditions.ends_when
        ),
        duration_s=duration_s,
        manner=manner,
        constraint=Constraint(segment.features, conditions.colliding),
    )


def _contact(pair: Pair, ee: str, objects: Sequence[str], *, holds: bool) -> Condition:
    names = tuple(ee if place < 0 else objects[place] for place in pair)
    return Condition("contact", names, holds)


def _applicability(agent: str, name: str, objects: Sequence[str]) -> tuple[Condition, ...]:
    """That the agent can do the action, and each object can undergo it (thesis 4.6.1.4)."""
    return tuple(Condition("capable", (each, name)) for each in (agent, *objects))


def _preparation(
    conditions: Conditions, ee: str, objects: Sequence[str], *, purpose: str
) -> tuple[Preparation, ...]:
    """Conditions with the actions that make them hold; their purpose is this action's name."""
    return tuple(
        Preparation(
            Condition("posture", (AGENT,))
            if pair is None
            else _contact(pair, ee, objects, holds=True),
            Call(action, tuple(objects[place] for place in places), purpose),
        )
        for pair, action, places in conditions.needs
    )


def _post_assertions(
    conditions: Conditions, ee: str, objects: Sequence[str]
) -> tuple[Condition, ...]:
    return tuple(_contact(pair, ee, objects, holds=holds) for pair, holds in conditions.afterwards)


CUTTING = "segmentation"
"""The folder of the rules that say where segments begin and end, whose thresholds cut and do not
name."""

THRESHOLDS = "thresholds.lp"

FITS = re.compile(r'fits\([^,"]+,\s*"(\w+)"\)')
_STATED = re.compile(r'primitive\("(\w+)"\)')
_COMMENT = re.compile(r'"[^"]*"|%\*.*?\*%|%[^\n]*', re.DOTALL)
_CONSTANT = re.compile(r"^#const (\w+) = (-?\d+)\.", re.MULTILINE)
_PREDICATE = re.compile(r"\b_*[a-z]\w*(?=\()")
_WORD = re.compile(r"\b[a-z]\w*\b")


@dataclass(frozen=True, eq=False)
class _Statement:
    text: str
    file: Path

    @cached_property
    def reads(self) -> frozenset[str]:
        """Predicates in its body, or ``fits NAME``; most statements are never asked for theirs."""
        return frozenset(_nodes(self.text.partition(":-")[2]))

    @cached_property
    def words(self) -> frozenset[str]:
        return frozenset(_WORD.findall(self.text))


@dataclass(frozen=True, eq=False)
class _Rules:
    """The texts of a rule base: which file states a primitive, and what defines a predicate."""

    texts: Mapping[Path, str]
    stated: Mapping[str, Path]
    defining: Mapping[str, Sequence[_Statement]]
    thresholds: Mapping[str, int]


def naming_rules(base: Profile, names: Iterable[str]) -> tuple[NamingRule, ...]:
    """The rules of a rule base that define these names, by name; unknown names have none."""
    known = _rules(base, base.fingerprint)
    return tuple(_naming_rule(known, each) for each in sorted(set(names)) if each in known.stated)


@cache
def _rules(base: Profile, fingerprint: str) -> _Rules:
    del fingerprint  # what is kept holds for these texts alone
    texts = {each: each.read_text("utf-8") for each in loaded_files(base.files)}
    thresholds = {
        name: int(value) for text in texts.values() for name, value in _CONSTANT.findall(text)
    }
    stated, defining = dict[str, Path](), defaultdict[str, list[_Statement]](list)
    for file, text in texts.items():
        bare = _COMMENT.sub(_strings, text)
        stated |= dict.fromkeys(_STATED.findall(bare), file)
        for each in re.split(r"\.(?=\s)", bare) if file.parent.name != CUTTING else ():
            statement = _Statement(each, file)
            for head in _nodes(each.partition(":-")[0]):
                defining[head].append(statement)
    return _Rules(texts, stated, dict(defining), thresholds)


@cache
def _naming_rule(rules: _Rules, name: str) -> NamingRule:
    file, known = rules.stated[name], rules.thresholds
    digest = sha256(rules.texts[file].encode()).hexdigest()
    used = sorted(_words(name, rules.defining) & {*known})
    rests_on = tuple(Threshold(each, known[each]) for each in used)
    place = f"{file.parent.name}/{file.name}"
    return NamingRule(name, place, digest, rules.texts[file], rests_on)


def _words(name: str, defining: Mapping[str, Sequence[_Statement]]) -> frozenset[str]:
    """The words that the definition of a primitive uses, and of the vocabulary that it reads.

    A predicate of the vocabulary is followed within its own file, and to the thresholds; beyond,
    nearly everything depends on everything.
    """
    own = defining.get(f"fits {name}", [])
    found = {word for each in own for word in each.words}
    seen = set[tuple[str, str]]()
    waiting = {(read, "") for each in own for read in each.reads}
    while waiting:
        read, file = waiting.pop()
        seen.add((read, file))
        for statement in defining.get(read, ()):
            if not file or statement.file.name in {file, THRESHOLDS}:
                found |= statement.words
                waiting |= {(below, statement.file.name) for below in statement.reads} - seen
    return frozenset(found)


def _nodes(text: str) -> set[str]:
    """The predicates in a text, and for each name whose fitting it speaks of a node of its own."""
    named = {f"fits {name}" for name in FITS.findall(text)}
    return named | (set(_PREDICATE.findall(text)) - ({"fits"} if named else set()))


def _strings(found: "re.Match[str]") -> str:
    """A string as it is, and nothing for a comment."""
    return found[0] if found[0].startswith('"') else ""
