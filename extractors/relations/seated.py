"""When things are down on what bears them: a table, another thing, or a palm."""

from collections.abc import Iterable, Iterator, Mapping

from capar.model.facts import Displaced, Fact, Seated, Touching
from extractors.bodies.body_geometry import BodyGeometry
from extractors.contact.normals import contact_normal
from extractors.motion.seats import seat
from extractors.thresholds import Thresholds


def seated(
    things: Mapping[str, BodyGeometry],
    hands: Mapping[str, BodyGeometry],
    touches: Iterable[Touching],
    known: Iterable[Fact],
    thresholds: Thresholds,
) -> Iterator[Fact]:
    """When each thing is down on what bears it: it comes and goes while one of the two moves.

    On what has no surface of its own nothing is seen to come down: there a contact is its distance.
    A palm that faces up bears a thing as a table does.

    Args:
        things: Objects by name.
        hands: Acting end-effectors by name.
        touches: Contacts of either with objects.
        known: When things move, among other facts.
        thresholds: What is steep, and what a hair is.
    """
    moves = [fact for fact in known if isinstance(fact, Displaced)]
    for touch in touches:
        if touch.other not in things:
            continue
        if touch.body in things and things[touch.other].shape:
            body, other = things[touch.body], things[touch.other]
        elif touch.body in hands and hands[touch.body].shape:
            body, other = things[touch.other], hands[touch.body]
        else:
            continue
        normal = contact_normal(body, other, touch.first, thresholds)
        if normal is not None and normal[2] >= thresholds.steep:
            spans = [(m.first, m.last) for m in moves if m.object in (touch.body, touch.other)]
            down = seat(body, other, (touch.first, touch.last), spans, thresholds)
            yield Seated(body.name, other.name, *down)
