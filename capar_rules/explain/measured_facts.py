"""What facts say of the bodies of a capture, gathered for sentences."""

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import replace

from capar.model.facts import (
    ClosingSpeed,
    ContactNormal,
    Displaced,
    Fact,
    FlickerCorrection,
    Lies,
    Link,
    Moving,
    Phase,
    Place,
    Posture,
    PressDirection,
    Resting,
    Shapeless,
    Swings,
    Tag,
    Touching,
    Travelled,
)
from capar_rules.explain.measured import FEET, HANDS, Frames, Measured, Pair, Pressing


def measured_by(facts: Iterable[Fact], known: Measured) -> Measured:
    """What is known of bodies, with what facts say of their motions, places and postures."""
    moving: dict[str, list[tuple[int, int]]] = defaultdict(list)
    displaced: dict[str, list[tuple[int, int]]] = defaultdict(list)
    rests: dict[str, list[tuple[int, int]]] = defaultdict(list)
    swings: dict[str, list[tuple[int, int]]] = defaultdict(list)
    level: dict[str, list[tuple[int, int]]] = defaultdict(list)
    held: dict[str, list[tuple[str, int, int]]] = defaultdict(list)
    places, postures, travelled, touched = {}, {}, {}, False
    every = list(facts)
    links = [fact for fact in every if isinstance(fact, Link)]
    acting = {link.ee for link in links}
    for fact in every:
        match fact:
            case Moving():
                moving[fact.object].append((fact.first, fact.last))
            case Displaced():
                displaced[fact.object].append((fact.first, fact.last))
            case Resting():
                rests[fact.ee].append((fact.first, fact.last))
            case Place():
                places[fact.body, fact.frame] = fact.x, fact.y, fact.z
            case Posture():
                postures[fact.body, fact.frame] = fact.lean, fact.spin
            case Phase(kind="level"):
                level[fact.object].append((fact.first, fact.last))
            case Swings():
                swings[fact.body].append((fact.first, fact.last))
            case Travelled():
                travelled[fact.body, fact.frame] = fact.way, fact.turn
            case Touching() if fact.body in acting:
                touched = True
                held[fact.other].append((fact.body, fact.first, fact.last))
            case Tag(type="mobile" | "fixed"):
                touched = True
            case _:
                pass
    found = replace(
        known, moving=moving, level=level, rests=rests, places=places, postures=postures
    )
    found = _of_pairs(every, found)
    return replace(
        found,
        displaced=displaced,
        swings=swings,
        travelled=travelled,
        held=held,
        tracked=touched,
        feet=frozenset(link.ee for link in links if link.kind in FEET),
        hands=frozenset(link.ee for link in links if link.kind.startswith(HANDS)),
    )


def _of_pairs(facts: Iterable[Fact], known: Measured) -> Measured:
    """What is known, with what facts say of two bodies and of shapes."""
    contacts: dict[Pair, list[Frames]] = defaultdict(list)
    normals: dict[Pair, dict[int, int]] = defaultdict(dict)
    presses: dict[Pair, dict[int, Pressing]] = defaultdict(dict)
    closing: dict[Pair, dict[int, int]] = defaultdict(dict)
    lies: dict[tuple[str, str, str], list[Frames]] = defaultdict(list)
    flickers: dict[Pair, list[Frames]] = defaultdict(list)
    shapeless: set[str] = set()
    movable: set[str] = set()
    for fact in facts:
        match fact:
            case Touching():
                contacts[fact.body, fact.other].append((fact.first, fact.last))
            case ContactNormal():
                normals[fact.body, fact.other][fact.first] = fact.permille
            case ClosingSpeed():
                closing[fact.body, fact.other][fact.first] = fact.speed
            case PressDirection():
                presses[fact.body, fact.other][fact.first] = fact.x, fact.y
            case FlickerCorrection(taken="touching"):
                flickers[fact.body, fact.other].append((fact.first, fact.last))
            case Lies():
                lies[fact.how, fact.body, fact.other].append((fact.first, fact.last))
            case Shapeless():
                shapeless.add(fact.object)
            case Tag(type="mobile"):
                movable.add(fact.object)
            case _:
                pass
    found = replace(known, contacts=contacts, normals=normals, presses=presses, lies=lies)
    return replace(
        found,
        closing=closing,
        flickers=flickers,
        shapeless=frozenset(shapeless),
        movable=frozenset(movable),
    )
