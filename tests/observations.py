"""Observations made by hand, as exact values: what a test of a later stage starts from."""

from collections.abc import Mapping
from dataclasses import dataclass

from capar.model.capture import Agent, Notice, Source, notice
from capar.model.facts import (
    Fact,
    Frames,
    Gap,
    Link,
    LookingAt,
    Moving,
    RateMhz,
    Tag,
    Touching,
    ZeroCrossing,
)
from capar.model.locations import ConstraintLocation
from capar.model.observation import (
    Border,
    JointAction,
    Observation,
    ObservedLink,
    ObservedObject,
    Segment,
)
from capar.model.par import (
    UNKNOWN,
    Call,
    ComplexPar,
    Condition,
    Constraint,
    CoreSemantics,
    FeatureSet,
    Ipar,
    LinkSteps,
    Motion,
    Nlt,
    PathPoint,
    Preparation,
    Relation,
    Step,
    Style,
    Upar,
)

FEATURES = {
    "Reach": ("0", "1", "0", "0"),
    "Touch": ("1", "1", "0", "0"),
    "TouchWith": ("101", "101", "00", "00"),
    "MoveObj": ("101", "101", "10", "00"),
    "MoveObjTo": ("100", "101", "10", "00"),
    "ResumePosture": ("1", "0", "0", "0"),
}
"""Start, end, change of location and force of the published primitives (thesis 5.2.1)."""

ENDS_IN_POSTURE = "ResumePosture"


@dataclass(frozen=True)
class Piece:
    """One segment as a test states it: its name, its last frame, its objects and its purpose."""

    name: str
    last: int
    objects: tuple[str, ...]
    purpose: str = ""
    features: FeatureSet | None = None
    general: tuple[str, ...] = ()
    candidates: tuple[str, ...] = ()
    level: str = ""


def observation(
    name: str,
    links: Mapping[str, tuple[Piece, ...]],
    objects: tuple[ObservedObject, ...],
    *,
    facts: tuple[Fact, ...] = (),
    frames: int,
    rate_hz: float,
    agent: Agent | None = None,
    profile: str = "extended",
    notices: tuple[Notice, ...] = (),
    joint: tuple[JointAction, ...] = (),
) -> Observation:
    """The observation that has these segments, with the PARs that follow from them."""
    performer = agent or Agent()
    seen = tuple(_link(ee, pieces, rate_hz) for ee, pieces in links.items())
    segments = tuple(each for link in seen for each in link.segments)
    ipars = tuple(ipar(each, performer.name, name) for each in segments)
    known = {each.name: each for each in reversed(segments) if each.known}
    measured: list[Fact] = [Frames(0, frames - 1), RateMhz(round(rate_hz * 1000))]
    measured += [Link(each.ee, each.kind, each.side) for each in seen]
    measured += [Tag(each.name, each.tag) for each in objects]
    return Observation(
        capture=name,
        profile=profile,
        rules="5" * 64,
        version="0.1.0",
        agent=performer,
        duration_s=(frames - 1) / rate_hz,
        rate_hz=rate_hz,
        frames=frames,
        objects=objects,
        links=seen,
        facts=(*measured, *facts),
        upars=tuple(upar(known[each], name) for each in sorted(known)),
        ipars=ipars,
        complex_par=complex_par(name, seen, frames, rate_hz),
        locations=tuple(location(each) for each in segments if "1" in each.features.rel_end),
        styles=tuple(style(each) for each in segments),
        sources=(Source(f"{name}.csv", "csv", "a" * 64),),
        notices=notices,
        joint=joint,
    )


def _link(ee: str, pieces: tuple[Piece, ...], rate_hz: float) -> ObservedLink:
    side, _, kind = ee.partition("_")
    first, out = 0, []
    for index, piece in enumerate(pieces):
        bits = FEATURES.get(piece.name, ("", "", "", ""))
        out.append(
            Segment(
                ee=ee,
                index=index,
                first=first,
                last=piece.last,
                start_s=first / rate_hz,
                end_s=piece.last / rate_hz,
                name=piece.name,
                general=piece.general,
                candidates=piece.candidates,
                level=piece.level,
                objects=piece.objects,
                possessed=piece.name in {"MoveObj", "MoveObjTo", "TouchWith"},
                features=piece.features or FeatureSet(*bits[:3], kind or ee, bits[3]),
                begins=_borders(ee, pieces, index),
                ends=_borders(ee, pieces, index + 1),
                purpose=piece.purpose,
            )
        )
        first = piece.last
    return ObservedLink(ee, kind or ee, side if kind else "none", tuple(out))


def _borders(ee: str, pieces: tuple[Piece, ...], index: int) -> tuple[Border, ...]:
    if index in {0, len(pieces)}:
        return (Border("last" if index else "first"),)
    before, after = pieces[index - 1], pieces[index]
    if before.name == "Reach":
        return (Border("begins", ee, before.objects[0]),)
    if after.name == ENDS_IN_POSTURE:
        return (Border("ends", ee, after.objects[0]),)
    if before.name == "MoveObjTo":
        return (Border("begins", *before.objects[:2]),)
    return (Border("ends", *(before.objects * 2)[:2]),)


def _parameters(count: int) -> tuple[str, ...]:
    return tuple(f"obj{each + 1}" for each in range(count))


def _core(segment: Segment, objects: tuple[str, ...], *, bound: bool) -> CoreSemantics:
    features, moves = segment.features, "1" in segment.features.change_loc
    at_end = features.rel_end
    pair = (0, 1) if features.count > 1 else (-1, 0)
    return CoreSemantics(
        motion=Motion.TRANSLATION if moves else Motion.NONE,
        moved=objects[0] if moves else "",
        causal=moves,
        force=tuple(each for each, bit in zip(objects, features.force, strict=False) if bit == "1"),
        path=((0.3, -0.1, 1.0), (0.25, 0.0, 1.5)) if bound else (),
        purpose=segment.purpose if bound else "",
        enables=("MoveObjTo",) if segment.name == "Reach" else (),
        termination=(
            (Condition("duration", ("duration",)),)
            if at_end == features.rel_start
            else tuple(contacts(at_end, segment.ee if bound else "EE", objects))
        ),
        duration_s=segment.end_s - segment.start_s if bound else None,
        manner="agent" if bound else "",
        constraint=Constraint(features, pair),
    )


def contacts(bits: str, ee: str, objects: tuple[str, ...]) -> list[Condition]:
    """The relations that a string of bits over the objects states."""
    pairs = [(ee, each) for each in objects] + [(objects[0], each) for each in objects[1:]]
    return [Condition("contact", pair, bit == "1") for pair, bit in zip(pairs, bits, strict=False)]


def preparation(features: FeatureSet, ee: str, objects: tuple[str, ...]) -> Preparation:
    """What must hold before, and the action that makes it so (thesis 4.6.1.1)."""
    for relation in contacts(features.rel_start, ee, objects):
        if relation.holds:
            return Preparation(relation, Call("Reach", (relation.arguments[1],)))
    return Preparation(Condition("posture", ("standing",)), Call("PostureChange", ("standing",)))


def upar(segment: Segment, parent: str) -> Upar:
    """The action that a segment is a case of."""
    objects = _parameters(segment.features.count)
    return Upar(
        name=segment.name,
        agent="agent",
        objects=objects,
        general=segment.general,
        applicability=(Condition("capable", ("agent", segment.name)),),
        preparation=(preparation(segment.features, "EE", objects),),
        steps=(Call(segment.name, objects),),
        core=_core(segment, objects, bound=False),
        post_assertions=tuple(contacts(segment.features.rel_end, "EE", objects)),
        parent=parent,
    )


def ipar(segment: Segment, agent: str, parent: str) -> Ipar:
    """The action as this agent did it."""
    return Ipar(
        upar=segment.name,
        agent=agent,
        ee=segment.ee,
        objects=segment.objects,
        start_s=segment.start_s,
        core=_core(segment, segment.objects, bound=True),
        preparation=(
            (preparation(segment.features, segment.ee, segment.objects),)
            if segment.features.count
            else ()
        ),
        post_assertions=tuple(contacts(segment.features.rel_end, segment.ee, segment.objects)),
        posture=f"{parent}End" if segment.name == ENDS_IN_POSTURE else "",
        parent=parent,
    )


def complex_par(
    name: str, links: tuple[ObservedLink, ...], frames: int, rate_hz: float
) -> ComplexPar:
    """Sequences in parallel; a ResumePosture that ends every link becomes one common step."""
    whole = frames - 1
    common = all(
        len(each.segments) > 1 and each.segments[-1].name == ENDS_IN_POSTURE for each in links
    )
    steps = {
        link.ee: tuple(
            Step(
                action=each.name,
                ee=each.ee,
                objects=each.objects,
                share=(each.last - each.first) / whole,
                purpose=each.purpose,
                begin=each.first / whole,
                segments=(each.index,),
                posture=f"{name}End" if each.name == ENDS_IN_POSTURE else "",
            )
            for each in link.segments
        )
        for link in links
    }
    last = steps[links[0].ee][-1]
    names: list[str] = []
    for link in links:
        for segment in link.segments:
            names += [each for each in segment.objects if each not in names]
    return ComplexPar(
        name=name,
        objects=tuple(names),
        duration_s=whole / rate_hz,
        links=tuple(
            LinkSteps(ee, each[:-1] if common else each) for ee, each in sorted(steps.items())
        ),
        common=(
            Step(
                action=last.action,
                ee="all",
                objects=last.objects,
                share=1.0 - max(each[-1].begin for each in steps.values()),
                purpose=last.purpose,
                begin=max(each[-1].begin for each in steps.values()),
                segments=tuple(each.segments[-1].index for each in links),
                posture=last.posture,
            )
            if common
            else None
        ),
        relations=(
            (Relation((links[0].ee, 0), "equals", (links[1].ee, 0)),) if len(links) > 1 else ()
        ),
    )


def location(segment: Segment) -> ConstraintLocation:
    """Where a segment ended on its objects."""
    two = segment.features.count > 1
    return ConstraintLocation(
        action=segment.name,
        purpose=segment.purpose,
        ee=segment.ee,
        side=segment.ee.partition("_")[0],
        frame=segment.last,
        dominant=segment.objects[0] if two else "",
        goal=segment.objects[1 if two else 0],
        ee_nlt=Nlt((0.5, 0.0, 0.25), (1.0, 0.0, 0.0, 0.0)) if two else None,
        goal_nlt=Nlt((0.0, -0.5, 0.5), (0.6, 0.8, 0.0, 0.0)),
        seen=segment.objects[0],
        v_nlt=Nlt((0.1, 0.2, 0.3), (1.0, 0.0, 0.0, 0.0)),
    )


def style(segment: Segment) -> Style:
    """How a segment went: a minimum-jerk covering of the way."""
    times = [each / 10 for each in range(11)]
    return Style(
        action=segment.name,
        purpose=segment.purpose,
        ee=segment.ee,
        velocity=tuple(10 * t**3 - 15 * t**4 + 6 * t**5 for t in times),
        path=(PathPoint(0.5, (0.3, -0.05, 1.2)),),
    )


MUG = ObservedObject(
    "mug", "mug", "mobile", (0.08, 0.11, 0.1), "mesh", "", (0.4, -0.1, 0.85), (1.0, 0.0, 0.0, 0.0)
)
MOUTH = ObservedObject(
    "mouth",
    "mouth",
    "self",
    (0.02, 0.05, 0.02),
    "box 0.02 x 0.05 x 0.02 m",
    "",
    (0.05, 0.0, 1.5),
    (1.0, 0.0, 0.0, 0.0),
)
TABLE = ObservedObject(
    "table",
    "table",
    "fixed",
    (1.2, 0.8, 0.8),
    "assumed",
    "a box whose top is the mug's lowest point at rest",
    (0.6, 0.0, 0.4),
    (1.0, 0.0, 0.0, 0.0),
)
RATE_HZ = 103.3
"""Frames a second of the thesis's rig."""


def drink_from_mug(*, agent: str = "agent", profile: str = "thesis") -> Observation:
    """DrinkFromMug with the published frames: 402 at 103.3 Hz (thesis 4.6.2, 5.2.1)."""
    mug, mouth, table = "mug", "mouth", "table"
    pieces = (
        Piece("Reach", 178, (mug,), "PickUp"),
        Piece("MoveObjTo", 246, (mug, mouth), "Drink"),
        Piece("MoveObj", 264, (mug, mouth), "Drink"),
        Piece("MoveObjTo", 312, (mug, table), "PutDown"),
        Piece("TouchWith", 330, (mug, table), "Release"),
        Piece("ResumePosture", 401, (mug,), "Release"),
    )
    crossings = (0, 88, 178, 212, 246, 255, 264, 288, 312, 321, 330, 366, 401)
    facts: tuple[Fact, ...] = (
        *(ZeroCrossing("right_hand", each) for each in crossings),
        Touching("right_hand", mug, 178, 330),
        Touching(mug, mouth, 246, 264),
        Touching(mug, table, 0, 183),
        Touching(mug, table, 312, 401),
        Gap(mug, mouth, 246, 120),
        Moving(mug, 184, 311),
        LookingAt("head", mug, 120, 200),
        LookingAt("head", table, 270, 330),
    )
    return observation(
        "DrinkFromMug",
        {"right_hand": pieces},
        (MUG, MOUTH, TABLE),
        facts=facts,
        frames=402,
        rate_hz=RATE_HZ,
        agent=Agent(agent, "person", {"stature": 1.78, "upper_arm": 0.31}),
        profile=profile,
        notices=(
            notice("stand-in-shape", "mouth", shape="box 0.02 x 0.05 x 0.02 m"),
            notice(
                "assumed-support",
                "table",
                assumed="a box whose top is the mug's lowest point at rest",
            ),
        ),
    )


def pick_up_with_both_hands() -> Observation:
    """A box lifted and lowered by two hands, both of which resume at the end (thesis 5.2.4)."""
    box = ObservedObject(
        "box", "box", "mobile", (0.3, 0.4, 0.2), "mesh", "", (0.5, 0.0, 0.9), (1.0, 0.0, 0.0, 0.0)
    )
    pieces = {
        ee: (
            Piece("Reach", 100 + late, ("box",), "PickUp"),
            Piece("TouchWith", 140, ("box", "table"), "PickUp"),
            Piece("MoveObj", 260, ("box", "table"), "PickUp"),
            Piece("ResumePosture", 360, ("box",), "Release"),
        )
        for ee, late in (("left_hand", 0), ("right_hand", 4))
    }
    facts: tuple[Fact, ...] = (
        Touching("left_hand", "box", 100, 260),
        Touching("right_hand", "box", 104, 260),
        Touching("box", "table", 0, 145),
        Touching("box", "table", 255, 360),
        Moving("box", 146, 254),
    )
    return observation(
        "PickUpWithBothHands",
        pieces,
        (box, TABLE),
        facts=facts,
        frames=361,
        rate_hz=100.0,
        profile="thesis",
        joint=(
            JointAction(
                "MoveObj",
                ("box", "table"),
                ("left_hand", "right_hand"),
                (2, 2),
                140,
                260,
                1.4,
                2.6,
            ),
        ),
    )


def with_unknown() -> Observation:
    """One reach, and one segment whose features no rule covers."""
    strange = FeatureSet("011", "110", "10", "hand", "00")
    pieces = (
        Piece("Reach", 50, ("mug",)),
        Piece(
            UNKNOWN,
            120,
            ("mug", "table"),
            features=strange,
            candidates=("MoveObj", "MoveObjTo"),
            level="rel_start",
        ),
    )
    return observation("Strange", {"right_hand": pieces}, (MUG, TABLE), frames=121, rate_hz=100.0)
