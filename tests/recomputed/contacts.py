"""Sentences about contact, recomputed from when bodies were measured to touch."""

from recomputed.known import NAME, ROUNDED, TIME, Known, covers, name, near


def touched(known: Known, one: str, other: str, at: str) -> bool:
    return any(covers(each, known.at(at)) for each in known.touching(one, other))


def not_touched(known: Known, one: str, other: str, at: str) -> bool:
    """No contact covers the instant."""
    frame = known.at(at)
    return not any(
        each.first + ROUNDED < frame < each.last - ROUNDED for each in known.touching(one, other)
    )


def ended_within(known: Known, one: str, other: str, at: str) -> bool:
    """A contact covers the instant, and ends within the reach of the same border."""
    frame = known.at(at)
    return any(
        each.first <= frame + ROUNDED and -ROUNDED <= each.last - frame <= known.reach
        for each in known.touching(one, other)
    )


def measured(known: Known, one: str, other: str, first: str, last: str) -> bool:
    return any(
        near(each.first, known.at(first)) and near(each.last, known.at(last))
        for each in known.touching(one, other)
    )


def begins(known: Known, one: str, other: str, at: str) -> bool:
    return any(near(each.first, known.at(at)) for each in known.touching(one, other))


def uncounted(known: Known, one: str, other: str, at: str) -> bool:
    """They do not touch then, or it is a thing that no end-effector has then."""
    if not touched(known, one, other, at):
        return True
    hands = {each.name for each in known.capture.sensors}
    return name(one) not in hands and not touched(known, known.segment.ee, one, at)


def possessed(known: Known, one: str, other: str, since: str) -> bool:
    """A contact begins then, before which no other ended within a flicker, and it moved in it."""
    first = known.at(since)
    ours = [each for each in known.touching(one, other) if each.first >= first - ROUNDED]
    return begins(known, one, other, since) and any(
        motion.first <= contact.last and motion.last >= contact.first
        for motion in known.moving(other)
        for contact in ours
    )


def moved_in_contact(known: Known, what: str, one: str, since: str) -> bool:
    return possessed(known, one, what, since)


def rested_on(known: Known, other: str) -> bool:
    """It touched the support before the hand came, and at the segment's borders."""
    what = known.segment.objects[0]
    times = (f"{known.segment.start_s:.3f}", f"{known.segment.end_s:.3f}")
    return all(touched(known, what, other, each) for each in times)


def no_support(known: Known, other: str) -> bool:
    """It was moved since the hand came, or came to it only after the hand came."""
    what = known.segment.objects[0]
    hand = min(each.first for each in known.touching(known.segment.ee, what))
    came_later = any(each.first >= hand for each in known.touching(what, other))
    moved = any(
        hand <= each.last and each.first < known.segment.last for each in known.moving(what)
    )
    return came_later or moved


FORMS = (
    (rf"the {NAME} still touched the {NAME} at {TIME}", touched),
    (rf"no relation of the {NAME} with the {NAME} counted at {TIME}", uncounted),
    (rf"the {NAME} touched the {NAME} at {TIME}", touched),
    (rf"the {NAME} did not touch the {NAME} at {TIME}", not_touched),
    (
        rf"contact of the {NAME} with the {NAME} at {TIME} does not count, as it ended within that "
        r"border",
        ended_within,
    ),
    (rf"contact of the {NAME} with the {NAME} was measured from {TIME} to {TIME}", measured),
    (rf"the {NAME} began to touch the {NAME} at {TIME}", begins),
    (
        rf"the {NAME} had hold of the {NAME}, which moved in the contact that began at {TIME}",
        possessed,
    ),
    (rf"the {NAME} moved in the contact with the {NAME} that began at {TIME}", moved_in_contact),
    (
        rf"the possessed object rested on the {NAME}, which it did before the hand came",
        rested_on,
    ),
    (rf"the {NAME} was not just what the possessed object had rested on all along", no_support),
)
