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


def counts(known: Known, one: str, other: str, at: str, border: str) -> bool:
    """The contact begins then and lasts on, and a border of the segment is at the other time."""
    ends = (known.segment.first, known.segment.last)
    lasts = any(
        near(each.first, known.at(at)) and covers(each, known.at(border))
        for each in known.touching(one, other)
    )
    return lasts and any(abs(known.at(border) - each) <= known.reach for each in ends)


def moved_before(known: Known, thing: str, hand: str, at: str) -> bool:
    """A contact of the two begins then, and the thing moves in it before the segment does begin."""
    first = known.at(at)
    began = any(near(each.first, first) for each in known.touching(hand, thing))
    return began and any(
        each.first < known.segment.first and each.last > first for each in known.moving(thing)
    )


def newly_met(known: Known, one: str, other: str, at: str, hand: str) -> bool:
    """A contact of the two begins then, while the end-effector touches the thing."""
    return begins(known, one, other, at) and touched(known, hand, one, at)


def let_go(known: Known, other: str, thing: str, hand: str, met: str, at: str) -> bool:
    """The one's contact with the thing ends then, and the other one's began before, when told."""
    own = [each for each in known.touching(other, thing) if near(each.last, known.at(at))]
    began = any(
        one.first < two.first <= one.last and near(two.first, known.at(met))
        for one in own
        for two in known.touching(hand, thing)
    )
    return known.at(at) >= known.segment.last - 1 and began


def took(known: Known, other: str, thing: str, at: str, hand: str, since: str, left: str) -> bool:
    """The one's contact begins then, and outlasts that of the other one, from since to left."""
    own = [each for each in known.touching(other, thing) if near(each.first, known.at(at))]
    ended = any(
        near(each.last, known.at(left)) and near(each.first, known.at(since))
        for each in known.touching(hand, thing)
    )
    return ended and any(each.last > known.at(left) for each in own)


def rested_on(known: Known, what: str, other: str, hand: str) -> bool:
    """It touched the support before the hand came, and at the segment's borders."""
    if name(hand) != known.segment.ee:
        return False
    times = (f"{known.segment.start_s:.3f}", f"{known.segment.end_s:.3f}")
    return all(touched(known, what, other, each) for each in times)


def no_support(known: Known, other: str, what: str, hand: str) -> bool:
    """It was moved since the hand came, or came to it only after the hand came."""
    came = min((each.first for each in known.touching(hand, what)), default=None)
    if came is None or name(hand) != known.segment.ee:
        return False
    came_later = any(each.first >= came for each in known.touching(what, other))
    moved = any(
        came <= each.last and each.first < known.segment.last for each in known.moving(what)
    )
    return came_later or moved


def ended(known: Known, what: str, other: str, at: str, border: str) -> bool:
    """A contact of the two ends then, near the border."""
    by = not border or known.thesis or abs(known.at(border) - known.at(at)) <= 2 * known.reach
    return by and any(near(each.last, known.at(at)) for each in known.touching(what, other))


def ended_at_once(known: Known, what: str, other: str, side: str) -> bool:
    """A contact of the two ends about that border."""
    border = known.border(side)
    return any(abs(each.last - border) <= 2 * known.reach for each in known.touching(what, other))


FORMS = (
    (rf"no relation of the {NAME} with the {NAME} counted at {TIME}", uncounted),
    (rf"the {NAME} touched the {NAME} at {TIME}", touched),
    (rf"the {NAME} did not touch the {NAME} at {TIME}", not_touched),
    (
        rf"contact of the {NAME} with the {NAME} at {TIME} does not count, as it ended within that "
        r"border",
        ended_within,
    ),
    (rf"contact of the {NAME} with the {NAME} was measured from {TIME} to {TIME}", measured),
    (
        rf"the {NAME} began to touch the {NAME} at {TIME}, and settled there by {TIME}",
        counts,
    ),
    (rf"the {NAME} began to touch the {NAME} at {TIME}", begins),
    (
        rf"the {NAME} moved at some time in the contact with the {NAME} that began at {TIME}, "
        rf"so the {NAME} is taken to have held it",
        lambda known, thing, hand, at, holder: hand == holder and possessed(known, hand, thing, at),
    ),
    (
        rf"the contact of the {NAME} with the {NAME} ended at {TIME}(?:; the border "
        rf"for it is placed at {TIME})?",
        ended,
    ),
    (
        rf"the contact of the {NAME} with the {NAME} at the (start|end) ends at once, and does not "
        r"count there",
        ended_at_once,
    ),
    (rf"the {NAME} moved in the contact with the {NAME} that began at {TIME}", moved_in_contact),
    (
        rf"the {NAME} had rested on the {NAME} since before the {NAME} touched it",
        rested_on,
    ),
    (
        rf"the {NAME} is not merely what the {NAME} rested on, unmoved, since before the {NAME} "
        "touched it",
        no_support,
    ),
    (
        rf"the {NAME} had moved before this in the contact with the {NAME} that began at {TIME}",
        moved_before,
    ),
    (
        rf"the {NAME} had come to touch the {NAME} (?:before this, )?at {TIME}, while held by "
        rf"the {NAME}",
        newly_met,
    ),
    (
        rf"the {NAME} was in contact with the {NAME} when the {NAME} came into contact with "
        rf"(?:it|them) \({TIME}\), and parted from (?:it|them) \(after {TIME}\)"
        r"(?: while the [\w ]+ stayed in contact)?",
        let_go,
    ),
    (
        rf"the {NAME} came into contact with the {NAME} at {TIME}, while the {NAME} was in contact "
        rf"with (?:it|them) \(from {TIME}\), and stayed so when the [\w ]+ parted from "
        rf"(?:it|them) \(after {TIME}\)",
        took,
    ),
)
