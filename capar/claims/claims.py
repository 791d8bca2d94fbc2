"""Claims about captures, in words and in files `*.motion.toml`, and their verdicts."""

import re
import tomllib
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TypeVar

from capar.model.errors import CaparError, FileError, UnknownNameError
from capar.model.facts import Fact, Frames, LookingAt, Moving, Touching
from capar.model.observation import BOTH, Observation, Segment
from capar.model.par import UNKNOWN
from capar.pipelines.observation import observe
from capar_rules.authoring.user_primitives import rules_of
from capar_rules.authoring.user_rules import user_rules
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from capar_rules.lint.checking import admitted_profile
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.bundle.patterns import SUFFIX as SUFFIX
from extractors.readers.bundle.patterns import find_captures

STEP = re.compile(r"([A-Z]\w*)(?:\(([^()]*)\))?")
"""A step of a claim, such as ``MoveObjTo(mug, head)``: its name, then its objects."""

RELATIONS: Mapping[str, Callable[["Span", "Span"], bool]] = {
    "begins before": lambda one, other: one[0] < other[0],
    "ends before": lambda one, other: one[1] < other[1],
    "before": lambda one, other: one[1] <= other[0],
    "after": lambda one, other: one[0] >= other[1],
    "while": lambda one, other: one[0] < other[1] and other[0] < one[1],
}
"""Relations of two times, those first whose name contains another's."""

HELP = (
    "a claim is EVENT; no EVENT; EVENT before EVENT (or after, while, begins before, ends before); "
    "EVENT lasts 0.5 to 2 s; or END_EFFECTOR: Name, Name, ... with its whole sequence. An event is "
    "END_EFFECTOR Name(object, _); both hands do Name(object, _); BODY touches BODY; "
    "BODY lets go of BODY; OBJECT moves; "
    "HEAD looks at OBJECT; HEAD looks away from OBJECT"
)

EE, PAIR, OBJECT, BODY, SENSOR, PRIMITIVE = (
    "acting end-effector", "pair of acting end-effectors", "object", "body", "sensor that looks",
    "primitive",
)  # fmt: skip
"""Kinds of names in claims, as messages call them."""

Names = Mapping[str, Collection[str]]
"""By kind, the names that exist in one capture, under one rule base."""

Span = tuple[float, float]
"""When something was, from one time to another [s]."""

_Kind = TypeVar("_Kind", bound=Fact)

_NUMBER = r"\d+(?:\.\d*)?|\.\d+"


class ClaimError(CaparError):
    """A claim that cannot be read, or that names what is not there."""


class UnknownInClaimError(ClaimError, UnknownNameError):
    """A name in a claim that nothing here bears: the claim could never be true."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether a claim holds of a capture, and what was found instead."""

    claim: str
    capture: str
    holds: bool
    found: str
    mistake: str = ""
    """Why it could not be judged at all; else empty."""


@dataclass(frozen=True, slots=True)
class _Scene:
    """What was observed, and the names that claims may use."""

    seen: Observation
    names: Names

    def named(self, kind: str, name: str) -> str:
        """The name, if it exists.

        Raises:
            UnknownInClaimError: It does not.
        """
        if name not in self.names[kind]:
            raise UnknownInClaimError(kind, name, self.names[kind], where=self.seen.capture)
        return name

    def step(self, text: str) -> str:
        """The text, if it is a step whose primitive and objects there are."""
        name, objects = _parts(text)
        self.named(PRIMITIVE, name)
        for thing in objects or ():
            if thing not in {"_", *self.names[EE]}:
                self.named(OBJECT, thing)
        return text

    def facts(self, kind: type[_Kind]) -> Iterator[_Kind]:
        """The facts of a kind."""
        return (fact for fact in self.seen.facts if isinstance(fact, kind))

    def segments(self, ee: str) -> Sequence[Segment]:
        """The segments of an end-effector."""
        self.named(EE, ee)
        return next(link.segments for link in self.seen.links if link.ee == ee)

    def span(self, fact: Touching | LookingAt | Moving, *, ending: bool) -> Span:
        """When a fact holds, or the moment of its end [s]."""
        last_s = fact.last / self.seen.rate_hz
        return (last_s if ending else fact.first / self.seen.rate_hz), last_s

    def cut_off(self, last: int) -> bool:
        """Whether something holds until the capture's end: nobody saw it end."""
        return any(each.last == last for each in self.facts(Frames))


def judge(claim: str, observation: Observation, *, names: Names | None = None) -> Verdict:
    """Check a claim against an observed capture.

    Args:
        claim: In words; ``HELP`` says in which.
        observation: The capture, observed.
        names: What may be named; None for what the observation itself shows.

    Raises:
        ClaimError: The claim cannot be read, or names what there is not.
    """
    scene = _Scene(observation, names or names_of(observation))
    holds, found = _judged(claim.strip(), scene)
    return Verdict(claim, observation.capture, holds, found)


def names_of(
    seen: Observation, *, rules: Profile | None = None, sensors: Iterable[str] = ()
) -> Names:
    """The names that claims about an observed capture may use, by kind.

    Args:
        seen: The observation.
        rules: The rule base that it was observed with; None for what ships of its profile, and the
            names that its segments bear.
        sensors: Those with a line of sight, beside heads that act and those that are seen to look.
    """
    kinds = {each.kind for each in seen.links}
    ees, objects = {each.ee for each in seen.links}, {each.name for each in seen.objects}
    heads = {each.ee for each in seen.links if each.kind == "head"}
    looking = {each.sensor for each in seen.facts if isinstance(each, LookingAt)}
    segments = {each for one in seen.segments for each in (one.name, *one.general)}
    return {
        EE: ees,
        PAIR: {f"both {several}" for kind, several in BOTH.items() if kind in kinds},
        OBJECT: objects,
        BODY: objects | ees,
        SENSOR: looking | heads | set(sensors),
        PRIMITIVE: _primitives(rules or profile(seen.profile)) | segments | {UNKNOWN},
    }


@cache
def _primitives(rules: Profile) -> frozenset[str]:
    return frozenset(each.name for each in rules_of(rules))


def _parts(step: str) -> tuple[str, tuple[str, ...] | None]:
    """The name of a step and its objects; None where it says nothing of objects.

    Raises:
        ClaimError: The text is no step.
    """
    found = STEP.fullmatch(step)
    if found is None:
        raise ClaimError(f"{step!r} is no step such as MoveObjTo(mug, head)")
    if found[2] is None:
        return found[1], None
    return found[1], tuple(each.strip() for each in found[2].split(",") if each.strip())


def _judged(claim: str, scene: _Scene) -> tuple[bool, str]:
    if sequence := re.fullmatch(r"(\w+):\s*(.+)", claim):
        return _sequence(sequence[1], sequence[2], scene)
    if lasting := re.fullmatch(rf"(.+) lasts ({_NUMBER}) to ({_NUMBER}) s", claim):
        spans = list(_event(lasting[1], scene))
        low, high = float(lasting[2]), float(lasting[3])
        if low > high:
            raise ClaimError(
                f"nothing lasts {lasting[2]} to {lasting[3]} s; the shorter time first"
            )
        return bool(spans) and all(low <= b - a <= high for a, b in spans), _shown(spans)
    if claim.startswith("no "):
        spans = list(_event(claim[3:], scene))
        return not spans, _shown(spans)
    for relation in RELATIONS:
        first, word, second = claim.partition(f" {relation} ")
        if word:
            one, other = list(_event(first, scene)), list(_event(second, scene))
            holds = any(RELATIONS[relation](a, b) for a in one for b in other)
            return holds, f"{first}: {_shown(one)}; {second}: {_shown(other)}"
    spans = list(_event(claim, scene))
    return bool(spans), _shown(spans)


def _sequence(ee: str, names: str, scene: _Scene) -> tuple[bool, str]:
    """The whole sequence of an end-effector; ... stands for any steps."""
    segments = scene.segments(ee)
    wanted = [each.strip() for each in re.split(r",\s*(?![^()]*\))", names)]
    for step in wanted:
        if step != "...":
            scene.step(step)
    found = ", ".join(segment.name for segment in segments)
    return _follows(wanted, list(segments)), f"{ee}: {found}"


def _follows(wanted: list[str], segments: list[Segment]) -> bool:
    if not wanted:
        return not segments
    if wanted[0] == "...":
        return any(_follows(wanted[1:], segments[at:]) for at in range(len(segments) + 1))
    return bool(segments and _fits(segments[0], wanted[0]) and _follows(wanted[1:], segments[1:]))


def _fits(segment: Segment, text: str) -> bool:
    """Whether a segment is of that name, or of one that specialises it, with those objects."""
    name, objects = _parts(text)
    if name not in (segment.name, *segment.general):
        return False
    pairs = zip(objects or (), segment.objects, strict=False)
    return len(objects or ()) <= len(segment.objects) and all(
        each in ("_", found) for each, found in pairs
    )


def _event(text: str, scene: _Scene) -> Iterator[Span]:
    """When an event is."""
    for pattern, spans in _EVENTS:
        if found := re.fullmatch(pattern, text):
            return spans(found, scene)
    raise ClaimError(f"{text!r} is no event; {HELP}")


def _looks(found: re.Match[str], scene: _Scene) -> Iterator[Span]:
    pair = scene.named(SENSOR, found[1]), scene.named(OBJECT, found[3])
    ending = found[2] != "at"
    for look in scene.facts(LookingAt):
        if (look.sensor, look.object) == pair and not (ending and scene.cut_off(look.last)):
            yield scene.span(look, ending=ending)


def _meets(found: re.Match[str], scene: _Scene) -> Iterator[Span]:
    pair = {scene.named(BODY, found[1]), scene.named(BODY, found[3])}
    if len(pair) == 1:
        raise ClaimError(f"{found[0]!r}: nothing touches itself")
    ending = found[2] != "touches"
    spans = {
        scene.span(each, ending=ending)
        for each in scene.facts(Touching)
        if {each.body, each.other} == pair and not (ending and scene.cut_off(each.last))
    }
    return iter(sorted(spans))


def _moves(found: re.Match[str], scene: _Scene) -> Iterator[Span]:
    name = scene.named(OBJECT, found[1])
    motions = (each for each in scene.facts(Moving) if each.object == name)
    return (scene.span(each, ending=False) for each in motions)


def _step(found: re.Match[str], scene: _Scene) -> Iterator[Span]:
    segments, step = scene.segments(found[1]), scene.step(found[2])
    return ((each.start_s, each.end_s) for each in segments if _fits(each, step))


def _together(found: re.Match[str], scene: _Scene) -> Iterator[Span]:
    """When several end-effectors do a step as one action."""
    both, seen = found[1].startswith("both "), scene.seen
    named = [found[1]] if both else found[1].split(" and ")
    who = [scene.named(PAIR if both else EE, each) for each in named]
    if len(set(who)) < len(who):
        raise ClaimError(f"{found[0]!r} names an end-effector twice")
    step = scene.step(found[2])
    segments = {(segment.ee, segment.index): segment for segment in seen.segments}
    for joint in seen.joint:
        own = [segments[each] for each in zip(joint.ees, joint.segments, strict=True)]
        acting = [seen.who(joint)] if both else joint.who
        if sorted(acting) == sorted(who) and all(_fits(each, step) for each in own):
            yield joint.start_s, joint.end_s


_EVENTS: tuple[tuple[str, Callable[[re.Match[str], _Scene], Iterator[Span]]], ...] = (
    (r"(\w+) looks (at|away from) (\w+)", _looks),
    (r"(\w+) (touches|lets go of) (\w+)", _meets),
    (r"(\w+) moves", _moves),
    (r"(both (?:hands|feet)|\w+(?: and \w+)+) do ([A-Z]\w*(?:\([^()]*\))?)", _together),
    (r"(\w+) ([A-Z]\w*(?:\([^()]*\))?)", _step),
)


def _shown(spans: Sequence[Span]) -> str:
    return ", ".join(f"{first:.2f} to {last:.2f} s" for first, last in spans) or "never"


_EXAMPLE = (
    'Write captures = ["drink_*"] and, for each claim, [[expect]] with '
    'that = "right_hand MoveObjTo(mug, head)".'
)


@dataclass(frozen=True)
class MotionTest:
    """Claims, and the captures that they are made of."""

    path: Path
    captures: tuple[str, ...]
    """Folders, or files, each with ``:TAKE`` where one of several takes is meant."""

    claims: tuple[str, ...]
    profile: str
    rules: Path | None


def read_motion_test(path: Path) -> MotionTest:
    """Read a file of claims.

    Raises:
        FileError: It cannot be read, says something unknown, or names no capture that there is.
    """
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror}.", _EXAMPLE) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise FileError(path, f"is no TOML: {error}.", _EXAMPLE) from None
    unknown = sorted(set(content) - {"captures", "expect", "profile", "rules"})
    if unknown:
        raise FileError(path, f"unknown key {unknown[0]!r}.", _EXAMPLE)
    patterns = content.get("captures", [])
    patterns = [patterns] if isinstance(patterns, str) else patterns
    expected = content.get("expect", [])
    if not isinstance(patterns, list) or not all(isinstance(each, str) for each in patterns):
        raise FileError(path, "captures is no list of patterns.", _EXAMPLE)
    if not isinstance(expected, list) or not expected:
        raise FileError(path, "it expects nothing.", _EXAMPLE)
    claims = [each.get("that") if isinstance(each, dict) else None for each in expected]
    if not all(isinstance(each, str) for each in claims):
        raise FileError(path, 'an [[expect]] has no that = "...".', _EXAMPLE)
    rules = content.get("rules")
    return MotionTest(
        path,
        tuple(find_captures(patterns, path.parent, where=path)),
        tuple(str(each) for each in claims),
        str(content.get("profile", DEFAULT)),
        path.parent / str(rules) if rules else None,
    )


def run_motion_test(
    test: MotionTest, *, rules: Path | None = None, actionary: str | None = None
) -> Iterator[Verdict]:
    """Judge every claim of every capture; what cannot be judged is reported with the rest.

    Raises:
        CaparError: The rules have a fault, or there is no such profile.
    """
    files = user_rules(test.rules or rules, actionary=actionary)
    base = admitted(test.profile, files)
    for capture in test.captures:
        for claim in test.claims:
            name = Path(capture).name
            try:
                seen, names = _observed(capture, base)
                name = seen.capture
                yield judge(claim, seen, names=names)
            except (CaparError, OSError) as error:
                yield Verdict(claim, name, holds=False, found="", mistake=str(error))


@cache
def admitted(name: str, added: tuple[Path, ...]) -> Profile:
    """A profile with rule files of users, checked once."""
    return admitted_profile(name, added=added)


@cache
def _observed(capture: str, base: Profile) -> tuple[Observation, Names]:
    trial = read_capture(capture)
    looking = (
        each.name
        for each in trial.sensors
        if each in trial.attending or each.end_effector == "head"
    )
    seen = observe(trial, rules=base)
    return seen, names_of(seen, rules=base, sensors=looking)
