"""From which frame on later frames may yet decide what an end-effector does."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field

from capar.model.facts import Displaced, Leans, Moving, Swings, Touching
from extractors.measure import Arriving


@dataclass(frozen=True, slots=True)
class Handling:
    """What end-effectors touch and what moves, up to the newest frame."""

    touching: Sequence[Touching]
    """Contacts of end-effectors."""

    moving: Sequence[Moving]
    mobile: AbstractSet[str]
    """Names of the objects that can be moved."""

    last: int
    """The newest frame."""

    margin: int
    """Frames that events of one kind are apart at most."""

    longest: int
    """How many frames a decision is awaited at most."""

    lost: Mapping[str, int] = field(default_factory=dict)
    """Of each body that is not seen now, the last frame in which it was."""

    swings: Sequence[Swings] = ()
    """When things move to and fro."""

    stroke: int = 0
    """How many frames one way of moving to and fro takes at most."""

    displaced: Sequence[Displaced] = ()
    """The motions from when things truly set off."""

    fresh: int = 0
    """Frames for which a motion that has just begun may yet turn out to be none."""

    lingering: Mapping[tuple[str, str], int] = field(default_factory=dict)
    """Bodies that may be said to have touched on, as they are near each other, or one is out of
    sight, and the last frame in which they were seen to touch."""

    leans: Sequence[Leans] = ()
    """When things lean far over."""

    arriving: Mapping[str, Arriving] = field(default_factory=dict)
    """Objects that have just come to rest, where and when is not told yet."""

    fast: AbstractSet[tuple[str, str, int]] = frozenset()
    """Contacts that began as fast as a blow: end-effector, object, first frame."""

    laid: Sequence[Touching] = ()
    """Contacts of objects that can be moved with what is fixed."""

    limbs: Mapping[str, object] = field(default_factory=dict)
    """What limb an end-effector is of, where it is of one."""

    @property
    def sure(self) -> int:
        """The last frame before which no contact ends that may yet go on, and no motion."""
        lost = (since for since in self.lost.values() if since > self.last - self.longest)
        stops = (rest.first - self.margin for rest in self.arriving.values())
        open_ = (*lost, *self.lingering.values(), *stops)
        return min((since - 1 for since in open_), default=self.last)

    def with_margin(self, since: Mapping[str, int]) -> dict[str, int]:
        """Frames so much earlier that no event of those at them is before."""
        return {ee: frame - self.margin for ee, frame in since.items()}


def undecided(handling: Handling) -> dict[str, int]:
    """The first frame of each end-effector about which something is still open."""
    out: dict[str, int] = {}
    for own in _going(handling):
        besides = _besides(handling, own)
        if besides or _is_shared(handling, own) or _may_be_blow(handling, own):
            first = min(
                own.first, *(touch.first for touch in besides), out.get(own.body, own.first)
            )
            out[own.body] = first
    later = (
        *out_of_sight(handling).items(),
        *_swinging(handling),
        *_lingering(handling),
        *_just_taken(handling),
        *_just_set_off(handling),
        *_arriving(handling),
    )
    for body, since in later:
        out[body] = min(since, out.get(body, since))
    return out


def awaited(handling: Handling) -> dict[str, int]:
    """The things whose first motion decides, and the frame at which each is touched first."""
    out: dict[str, int] = {}
    for own in _going(handling):
        if _besides(handling, own) or _may_be_blow(handling, own):
            out[own.other] = min(own.first, out.get(own.other, own.first))
    return out


def nameless(handling: Handling) -> dict[str, int]:
    """The first frame of each end-effector about which too much is open to announce anything."""
    out = out_of_sight(handling)
    for own in _going(handling):
        if _may_be_blow(handling, own):
            out[own.body] = min(own.first, out.get(own.body, own.first))
    later = (
        *_lingering(handling),
        *_just_taken(handling),
        *_just_set_off(handling),
        *_arriving(handling, lambda thing: _may_part(handling, thing)),
        *_just_tipped(handling),
    )
    for body, since in later:
        out[body] = min(since, out.get(body, since))
    return out


def out_of_sight(handling: Handling) -> dict[str, int]:
    """End-effectors in contact with what was lost since, and the frame in which it was last seen.

    If they touch when it is seen again, they have touched all the time.
    """
    out: dict[str, int] = {}
    for touch in handling.touching:
        for body in (touch.body, touch.other):
            since = handling.lost.get(body, -1)
            if touch.last >= since >= max(touch.first, handling.last - handling.longest):
                out[touch.body] = min(since, out.get(touch.body, since))
    return out


def _going(handling: Handling) -> list[Touching]:
    """The contacts with things that can be moved that go on."""
    return [
        touch
        for touch in handling.touching
        if touch.other in handling.mobile and touch.last >= handling.last - handling.margin
    ]


def _is_shared(handling: Handling, own: Touching) -> bool:
    """Whether somebody else has held the thing before, from whom it may be taken.

    Who takes it over is known once one of the two lets go of it, or is taken not to. What lies on
    something fixed as it is touched is not taken over, nor is what the same limb has already.
    """
    if handling.last - own.first > handling.longest or _is_laid(handling, own):
        return False
    before = [
        touch.body
        for touch in _going(handling)
        if touch.other == own.other
        and touch.body != own.body
        and touch.first < own.first - handling.margin
    ]
    limb = handling.limbs.get(own.body)
    by_the_same = any(limb is not None and handling.limbs.get(body) == limb for body in before)
    return bool(before) and not by_the_same


def _may_be_blow(handling: Handling, own: Touching) -> bool:
    """Whether a thing was met fast, is touched still, and has not moved: to be taken is no blow."""
    return (
        (own.body, own.other, own.first) in handling.fast
        and not _has_moved(handling, own)
        and handling.last - own.first <= handling.longest
    )


def _has_moved(handling: Handling, own: Touching) -> bool:
    """Whether a thing has moved since it was touched."""
    return any(move.object == own.other and move.last >= own.first for move in handling.moving)


def _swinging(handling: Handling) -> Iterator[tuple[str, int]]:
    """End-effectors that touch what may move to and fro on, and since when that is open."""
    for swing in handling.swings:
        if swing.last >= handling.last - handling.stroke:
            for touch in handling.touching:
                if swing.body in (touch.body, touch.other) and touch.last >= swing.last:
                    yield touch.body, swing.last


def decided_at(handling: Handling) -> Iterator[int]:
    """The frames at which it is known whether motions go on, and where something came to rest."""
    for swing in handling.swings:
        yield swing.last + handling.stroke + 1
    for move in handling.moving:
        yield move.first + handling.fresh + 1
    for rest in handling.arriving.values():
        yield handling.last + rest.missing


def _just_taken(handling: Handling) -> Iterator[tuple[str, int]]:
    """End-effectors that touch what has just begun to move, and since when they touch it.

    Throughout a contact in which a thing moves it is possessed, so that it matters what it touched.
    """
    for own in _going(handling):
        moves = [
            move.first
            for move in handling.moving
            if move.object == own.other and move.last >= own.first
        ]
        if moves and min(moves) > handling.last - handling.fresh:
            yield own.body, own.first


def _just_set_off(handling: Handling) -> Iterator[tuple[str, int]]:
    """End-effectors that touch what has just begun to move, and since when it has set off.

    Where the motion turns out to be none, nothing began there.
    """
    for own in _going(handling):
        for move in handling.moving:
            if move.object == own.other and move.first > handling.last - handling.fresh:
                yield own.body, _set_off(handling, move)


def _arriving(
    handling: Handling, counts: Callable[[str], bool] = lambda _: True
) -> Iterator[tuple[str, int]]:
    """End-effectors that touch what has just come to rest, and since when that is open."""
    for thing in filter(counts, handling.arriving):
        first = handling.arriving[thing].first
        for touch in handling.touching:
            if touch.other == thing and touch.last >= first - handling.margin:
                yield touch.body, first


def _just_tipped(handling: Handling) -> Iterator[tuple[str, int]]:
    """End-effectors that touch what has begun to lean not long ago, and since when.

    Where it comes to touch something else before it is righted, its tipping was no event.
    """
    for lean in handling.leans:
        goes_on = lean.last >= handling.last - handling.margin
        if goes_on and handling.last - lean.first <= handling.longest:
            yield from (
                (own.body, lean.first) for own in _going(handling) if own.other == lean.object
            )


def _may_part(handling: Handling, thing: str) -> bool:
    """Whether it is open if a contact began or ended at once with a stop, or well before.

    When a thing stopped is known to two thirds of the time within which events are one.
    """
    stop = handling.arriving[thing].first
    unsure = 2 * handling.margin // 3
    return any(
        abs(stop - frame - handling.margin) <= unsure
        for touch in (*handling.touching, *handling.laid)
        if thing in (touch.body, touch.other)
        for frame in (touch.first, touch.last)
    )


def _set_off(handling: Handling, move: Moving) -> int:
    """When what is seen to move truly set off."""
    return max(
        (
            way.first
            for way in handling.displaced
            if way.object == move.object and way.first <= move.first <= way.last
        ),
        default=move.first,
    )


def _lingering(handling: Handling) -> Iterator[tuple[str, int]]:
    """End-effectors whose contact, or that of what they touch, may yet go on, and since when."""
    acting = {touch.body for touch in handling.touching}
    for pair, since in handling.lingering.items():
        yield from ((body, since) for body in pair if body in acting)
        for touch in handling.touching:
            if touch.other in pair and touch.first <= since <= touch.last:
                yield touch.body, since


def _is_laid(handling: Handling, own: Touching) -> bool:
    """Whether a thing lies on something fixed for some time before and after it is touched."""
    return any(
        own.other in (touch.body, touch.other)
        and touch.first <= own.first - handling.margin
        and own.first + handling.margin <= touch.last
        for touch in handling.laid
    )


def _besides(handling: Handling, own: Touching) -> list[Touching]:
    """What is touched beside a thing that has not moved yet.

    Once it moves, the hand has possessed it from the first, and its other contacts do not count;
    for some time it is awaited that it does.
    """
    if _has_moved(handling, own):
        return []
    return [
        touch
        for touch in handling.touching
        if touch.body == own.body
        and touch.other != own.other
        and touch.last >= own.first
        and handling.last - max(own.first, touch.first) <= handling.longest
    ]
