"""Sentences about blows, and about other end-effectors and agents."""

from itertools import pairwise

import numpy as np

from capar.model.capture import TagType
from capar.model.facts import Moving, Touching
from recomputed.known import NAME, ROUNDED, TIME, Known, covers, name, near

BLOW_MPS = 1.0
"""Whoever means to touch has slowed down to less than this [m/s]."""


def met_fast(known: Known, what: str) -> bool:
    """The speed at which the bodies close in over the last hundredths of a second before."""
    begin = min(
        each.first
        for each in known.touching(known.segment.ee, what)
        if abs(each.first - known.segment.last) <= known.reach
    )
    before = max(begin - 3, 0)
    own, others = (
        known.middle(each, begin) - known.middle(each, before) for each in (known.segment.ee, what)
    )
    return bool(np.linalg.norm(own - others) * known.rate / (begin - before) >= 0.9 * BLOW_MPS)


def _own(known: Known, what: str) -> list[Touching]:
    return known.touching(known.segment.ee, what)


def _others(known: Known, what: str, frame: float) -> list[str]:
    """Which other end-effectors touch it then."""
    return [
        each.body
        for each in known.of(Touching)
        if each.other == what
        and each.body != known.segment.ee
        and each.body in {sensor.name for sensor in known.capture.sensors}
        and each.first - ROUNDED <= frame <= each.last + ROUNDED
    ]


def _taken_from(known: Known) -> list[str]:
    """Who has the object when this one begins to touch it, and lets go of it first."""
    what = known.segment.objects[0]
    (own,) = [each for each in _own(known, what)
              if abs(each.first - known.segment.last) <= known.reach]  # fmt: skip
    return [other for other in _others(known, what, own.first)
            if all(each.last < own.last for each in known.touching(other, what)
                   if covers(each, own.first))]  # fmt: skip


def _left_to(known: Known) -> list[str]:
    """Who has the object when this one leaves it, and took it later."""
    what = known.segment.objects[0]
    (own,) = [each for each in _own(known, what)
              if abs(each.last - known.segment.first) <= known.reach]  # fmt: skip
    return [other for other in _others(known, what, own.last)
            if all(each.first > own.first for each in known.touching(other, what)
                   if covers(each, own.last))]  # fmt: skip


def agent(known: Known, what: str) -> str:
    (body,) = [each for each in known.capture.sensors if each.name == name(what)]
    return known.capture.agent_of(body)


def another_had(known: Known, other: str, _: str) -> bool:
    return name(other) in _taken_from(known)


def another_took(known: Known, other: str, _: str) -> bool:
    return name(other) in _left_to(known)


def stranger_had(known: Known) -> bool:
    mine = agent(known, known.segment.ee)
    return any(agent(known, each) != mine for each in _taken_from(known))


def stranger_took(known: Known) -> bool:
    mine = agent(known, known.segment.ee)
    return any(agent(known, each) != mine for each in _left_to(known))


def belongs(known: Known, what: str, who: str) -> bool:
    return agent(known, what) == name(who)


def different(known: Known, one: str, other: str) -> bool:
    return agent(known, one) != agent(known, other)


def joined(known: Known, other: str) -> bool:
    """The other end-effector touches the object for a while within the segment."""
    return any(
        min(each.last, known.segment.last) > max(each.first, known.segment.first)
        for each in known.touching(other, known.segment.objects[0])
    )


def force_passes(known: Known) -> bool:
    return known.capture.force_transfer


def tagged(known: Known, what: str, kind: str) -> bool:
    tags = {"movable": "mobile", "part of a body": "self"}
    return known.capture.tag_object(name(what)).tag == tags.get(kind, kind)


def not_borne(known: Known, what: str, bearer: str) -> bool:
    """It cannot go along, or does not, or is not above what would bear it, or does not touch it."""
    loads = {each.name for each in known.capture.objects if each.tag is TagType.MOBILE}
    met = known.touching(what, bearer)
    if name(what) not in loads or not any(
        _overlap(each, move) for each in met for move in known.moving(what)
    ):
        return True
    return bool(np.isnan(known.middle(what, known.segment.first)[2])) or any(
        known.middle(what, frame)[2] < known.middle(bearer, frame)[2]
        for frame in (known.segment.first, known.segment.last)
    )


def not_carried(known: Known, bearer: str, what: str) -> bool:
    return not_borne(known, what, bearer)


RIDE_SHARE, RIDE_M = 0.25, 0.01
"""What goes along strays by no larger share of its bearer's way [1], or by so little [m]."""


def borne(known: Known, what: str, bearer: str, at: str) -> bool:
    """In that contact it is above the bearer's bottom, and stays at its place when that moves."""
    for met in known.touching(what, bearer):
        spans = [
            (max(met.first, move.first), min(met.last, move.last))
            for move in known.moving(bearer)
            if near(met.first, known.at(at)) and _overlap(met, move)
        ]
        if any(_rode(known, what, bearer, *span) for span in spans):
            return True
    return False


def _rode(known: Known, what: str, bearer: str, first: int, last: int) -> bool:
    frames = range(first, last + 1, 5)
    ways = [known.middle(bearer, frame) - known.middle(bearer, first) for frame in frames]
    offsets = [
        known.turn(bearer, frame)
        .inv()
        .apply(known.middle(what, frame) - known.middle(bearer, frame))
        for frame in frames
    ]
    stray = max(float(np.linalg.norm(each - offsets[0])) for each in offsets)
    way = max(float(np.linalg.norm(each)) for each in ways)
    low = float(known.points(bearer, first)[:, 2].min())
    above = bool(known.middle(what, first)[2] > low)
    return above and stray <= max(RIDE_SHARE * way, RIDE_M)


def _overlap(one: Touching, other: Moving) -> bool:
    return one.first <= other.last and other.first <= one.last


def met_at(known: Known, one: str, other: str, mm_s: str) -> bool:
    """Their middles came together so fast shortly before some contact of the two began."""
    return any(
        abs(_pace(known, one, other, each.first) - float(mm_s) / 1000.0)
        <= 0.3 * float(mm_s) / 1000.0
        for each in known.touching(one, other)
    )


def pressed(known: Known, one: str, other: str, x: str, y: str, at: str) -> bool:
    """From its middle the other's surface is nearest in about that direction."""
    frame = known.frame(at)
    found = known.nearest_way(one, other, frame)
    return bool(found[:2] @ np.array([float(x), float(y)]) >= 650.0 * np.linalg.norm(found))


def met_sideways(known: Known, one: str, other: str, permille: str) -> bool:
    """From its middle the head is nearest in a direction that makes that angle with its sight."""
    (head,) = [each for each in known.capture.sensors if each.name == name(other)]
    frames = [each.first for each in known.touching(one, other)]
    return any(
        abs(_against_sight(known, one, other, frame, np.array(head.gaze)) - float(permille) / 1000)
        <= 0.35
        for frame in frames
    )


def met_aside(known: Known, other: str) -> bool:
    """Neither its sight, nor the vertical, nor their contraries lead to where it is met."""
    one, frame = known.segment.ee, known.segment.last
    way = known.nearest_way(one, other, frame)
    (head,) = [each for each in known.capture.sensors if each.name == name(other)]
    along = _against_sight(known, one, other, frame, np.array(head.gaze))
    return abs(along) < 0.75 and abs(float(way[2])) < 0.75 * float(np.linalg.norm(way))


def _against_sight(known: Known, one: str, other: str, frame: int, gaze: np.ndarray) -> float:
    way = known.nearest_way(one, other, frame)
    ray = known.turn(other, frame).apply(gaze)
    return -float(way @ ray / np.linalg.norm(way) / np.linalg.norm(ray))


def _pace(known: Known, one: str, other: str, frame: int) -> float:
    """The fastest relative motion of two middles in the last 0.06 s before a frame [m/s]."""
    frames = range(max(frame - round(0.06 * known.rate), 0), frame + 1)
    ways = [known.middle(one, each) - known.middle(other, each) for each in frames]
    steps = (float(np.linalg.norm(b - a)) * known.rate for a, b in pairwise(ways))
    return max(steps, default=0.0)


def went_at(known: Known, what: str, mm_s: str, one: str) -> bool:
    """Its middle went so fast as some contact with the other ended."""
    return any(
        abs(_speed(known, what, each.last) - float(mm_s) / 1000.0) <= 0.3 * float(mm_s) / 1000.0
        for each in known.touching(one, what)
    )


def _speed(known: Known, what: str, frame: int) -> float:
    reach = max(round(0.03 * known.rate), 1)
    first, last = max(frame - reach, 0), min(frame + reach, len(known.capture.times) - 1)
    way = known.middle(what, last) - known.middle(what, first)
    return float(np.linalg.norm(way)) * known.rate / (last - first)


def clings(known: Known, what: str, one: str) -> bool:
    """They touch for longer than a blow does."""
    return any(each.last - each.first > 0.1 * known.rate for each in known.touching(one, what))


def started_from_rest(known: Known) -> bool:
    """It touches another thing at the start, or was where it is shortly before."""
    what, start = known.segment.objects[0], known.segment.first
    others = [*known.capture.objects, *known.capture.sensors]
    for each in others:
        for touch in known.touching(what, each.name):
            if touch.first - known.reach <= start <= touch.last + known.reach:
                return True
    before = max(start - round(0.3 * known.rate), 0)
    return bool(np.linalg.norm(known.middle(what, start) - known.middle(what, before)) < 0.03)


def _goes_along(known: Known, what: str, way: np.ndarray) -> bool:
    """It makes nearly the same way."""
    return bool(np.linalg.norm(known.way(what) - way) < 0.3 * np.linalg.norm(way))


def not_slid(known: Known, _: str) -> bool:
    """Nothing touches it from border to border, or it hardly goes aside, or up or down."""
    what, way = known.segment.objects[0], known.way(known.segment.objects[0])
    kept = [
        each
        for each in known.of(Touching)
        if each.body == what
        and each.other != known.segment.ee
        and each.first <= known.segment.first
        and each.last >= known.segment.last
        and not _goes_along(known, each.other, way)
    ]
    return not kept or float(np.linalg.norm(way)) < 0.1 or abs(float(way[2])) > 0.03


def touched_nothing(known: Known, ee: str) -> bool:
    """No contact of it reaches into the segment by more than what merges with its borders."""
    first, last = known.segment.first + known.reach, known.segment.last - known.reach
    return not any(
        each.body == name(ee) and each.first < last and each.last > first
        for each in known.of(Touching)
    )


def not_resting(known: Known, ee: str) -> bool:
    """Somewhere in the segment it is well away from where it began, in place or in turn."""
    frames = range(known.segment.first, known.segment.last + 1)
    place = known.stream(ee).positions[list(frames)]
    if float(np.linalg.norm(place - place[0], axis=1).max()) > 0.005:
        return True
    turn = known.turns(ee, frames) * known.turn(ee, known.segment.first).inv()
    return float(turn.magnitude().max()) > 0.03


def not_put_down(known: Known, _: str) -> bool:
    """It stays in the hand to the last frame, or for long, or does not go down."""
    what = known.segment.objects[0]
    lets_go = any(
        abs(each.last - known.segment.last) <= 2 * known.reach + 0.6 * known.rate
        and each.last < len(known.capture.times) - 1
        for each in known.touching(known.segment.ee, what)
    )
    return not lets_go or float(known.way(what)[2]) > -0.045


def only_held(known: Known, what: str, side: str) -> bool:
    """Nothing but end-effectors touches it at that side, or what is there for no longer."""
    at = known.segment.last if side == "end" else known.segment.first
    acting = {link.ee for link in known.seen.observation.links}
    return not any(
        each.first + ROUNDED < at < each.last - ROUNDED - known.reach
        for each in known.of(Touching)
        if name(what) in (each.body, each.other) and not {each.body, each.other} & acting
    )


FORMS = (
    (rf"the {NAME} touched nothing but what held it at the segment's (start|end)", only_held),
    (
        rf"the {NAME} (?:was at rest when the [\w ]+ took it|left the [\w ]+)",
        lambda known, what: name(what) == known.segment.objects[0] and started_from_rest(known),
    ),
    (rf"the {NAME} was not slid on anything", not_slid),
    (rf"the {NAME} did not come down to where it was then let go", not_put_down),
    (
        rf"the {NAME} touched no recorded or assumed object when the segment began, nor when it "
        r"ended",
        touched_nothing,
    ),
    (rf"the {NAME} moved", not_resting),
    (rf"the {NAME} did not carry the {NAME} along", not_carried),
    (
        rf"the {NAME} was borne by the {NAME} and went along with it, "
        rf"in the contact that began at {TIME}",
        borne,
    ),
    (rf"the {NAME} reached the {NAME} at a relative speed of (\d+) mm/s", met_at),
    (
        rf"the relative speed of the {NAME} and the {NAME} was (\d+) mm/s, as their contact began",
        met_at,
    ),
    (
        rf"the {NAME} pressed on the {NAME} along \((-?\d+), (-?\d+), level\) thousandths,"
        rf" at {TIME}",
        pressed,
    ),
    (
        rf"the {NAME} met the {NAME} from a side that points (-?\d+) thousandths"
        r" along its line of sight",
        met_sideways,
    ),
    (rf"the {NAME} was met at its side, neither before, nor behind, nor above", met_aside),
    (rf"the {NAME} went at (\d+) mm/s when the {NAME} let it go", went_at),
    (rf"the {NAME} stayed with the {NAME}", clings),
    (rf"the {NAME} was reached as fast as by a blow", met_fast),
    (rf"the {NAME} had the {NAME} by then", another_had),
    (rf"the {NAME} had taken the {NAME} by then", another_took),
    (r"it was another agent who had it", stranger_had),
    (r"it was another agent who had taken it", stranger_took),
    (rf"the {NAME} belongs to {NAME}", belongs),
    (rf"the {NAME} and the {NAME} are of different agents", different),
    (rf"it is one action with what the {NAME} does to the same object", joined),
    (r"force passes to objects in this trial, as its user says", force_passes),
    (rf"the {NAME} is a (movable) thing", tagged),
    (rf"the {NAME} is (fixed|part of a body)", tagged),
)
