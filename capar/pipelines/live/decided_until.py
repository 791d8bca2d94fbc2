"""From which frame on later frames may yet decide what an end-effector does."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field

from capar.model.facts import Displaced, Leans, Moving, Resting, Swings, Touching
from extractors.measure import Arriving


@dataclass(frozen=True, slots=True)
class Handling:
    """What end-effectors touch and what moves, up to the newest frame.

    Attributes:
        touching: Contacts of end-effectors.
        moving: Motions of objects.
        mobile: Names of the objects that can be moved.
        last: The newest frame.
        margin: Frames that events of one kind are apart at most.
        longest: How many frames a decision is awaited at most.
        lost: Of each body that is not seen now, the last frame in which it was.
        swings: When objects move to and fro.
        stroke: How many frames one way of moving to and fro takes at most.
        displaced: The motions from when objects truly set off.
        fresh: Frames for which a motion that has just begun may yet turn out to be none.
        lingering: Bodies whose contact may have gone on, as they are near each other, or one is out
            of sight, and the last frame in which they were seen to touch.
        leans: When objects lean far over.
        arriving: Objects that have just come to rest, where and when is not measured yet.
        fast: Contacts that began as fast as a blow: end-effector, object, first frame.
        laid: Contacts of objects that can be moved with what is fixed.
        limbs: What limb an end-effector is of, where it is of one.
        rested: Rests of end-effectors that have not gone far since.
        departs: For how many frames after a rest later ones may tell when it truly ended.
    """

    touching: Sequence[Touching]
    moving: Sequence[Moving]
    mobile: AbstractSet[str]
    last: int
    margin: int
    longest: int
    lost: Mapping[str, int] = field(default_factory=dict)
    swings: Sequence[Swings] = ()
    stroke: int = 0
    displaced: Sequence[Displaced] = ()
    fresh: int = 0
    lingering: Mapping[tuple[str, str], int] = field(default_factory=dict)
    leans: Sequence[Leans] = ()
    arriving: Mapping[str, Arriving] = field(default_factory=dict)
    fast: AbstractSet[tuple[str, str, int]] = frozenset()
    laid: Sequence[Touching] = ()
    limbs: Mapping[str, object] = field(default_factory=dict)
    rested: Sequence[Resting] = ()
    departs: int = 0

    @property
    def sure(self) -> int:
        """The last frame before which no contact ends that may yet go on, and no motion."""
        lost = (since for since in self.lost.values() if since > self.last - self.longest)
        stops = (rest.first - self.margin for rest in self.arriving.values())
        left = (stay.last for stay in self.just_left())
        open_ = (*lost, *self.lingering.values(), *stops, *left)
        return min((since - 1 for since in open_), default=self.last)

    def just_left(self) -> list[Resting]:
        """The rests in the air of which later frames may yet tell when they truly ended."""
        return [
            stay
            for stay in self.rested
            if self.last - self.departs <= stay.last < self.last
            and not any(t.body == stay.ee and t.last >= stay.last for t in self.touching)
        ]

    def with_margin(self, since: Mapping[str, int]) -> dict[str, int]:
        """Frames so much earlier that no event of those at them is before."""
        return {ee: frame - self.margin for ee, frame in since.items()}

    def going(self) -> list[Touching]:
        """The contacts with objects that can be moved that go on."""
        since = self.last - self.margin
        return [t for t in self.touching if t.other in self.mobile and t.last >= since]

    def moves(self, own: Touching) -> list[Moving]:
        """The motions of an object since it was touched."""
        return [m for m in self.moving if m.object == own.other and m.last >= own.first]

    def may_be_blow(self, own: Touching) -> bool:
        """Whether an object was met fast and has not moved: to be taken is no blow."""
        fast = (own.body, own.other, own.first) in self.fast
        return fast and not self.moves(own) and self.last - own.first <= self.longest

    def besides(self, own: Touching) -> list[Touching]:
        """What is touched beside an object that has not moved yet, for some time.

        Once it moves, the hand has possessed it from the first, and its other contacts do not
        count.
        """
        if self.moves(own):
            return []
        return [
            touch
            for touch in self.touching
            if touch.body == own.body
            and touch.other != own.other
            and touch.last >= own.first
            and self.last - max(own.first, touch.first) <= self.longest
        ]


def undecided(handling: Handling) -> dict[str, int]:
    """The first frame of each end-effector about which something is still open."""
    pairs = []
    for own in handling.going():
        besides = handling.besides(own)
        if besides or _is_shared(handling, own) or handling.may_be_blow(own):
            pairs += [(own.body, min(own.first, *(touch.first for touch in (own, *besides))))]
    return _earliest(
        (
            *pairs,
            *out_of_sight(handling).items(),
            *_swinging(handling),
            *_lingering(handling),
            *_just_moving(handling),
            *((stay.ee, stay.last - handling.margin) for stay in handling.just_left()),
            *_arriving(handling, handling.arriving),
        )
    )


def nameless(handling: Handling) -> dict[str, int]:
    """The first frame of each end-effector about which too much is open to announce anything."""
    parting = [name for name in handling.arriving if _may_part(handling, name)]
    return _earliest(
        (
            *out_of_sight(handling).items(),
            *((o.body, o.first) for o in handling.going() if handling.may_be_blow(o)),
            *_lingering(handling),
            *_just_moving(handling),
            *_arriving(handling, parting),
            *_just_tipped(handling),
        )
    )


def decided_at(handling: Handling) -> Iterator[int]:
    """The frames at which it is known whether motions go on, and where something came to rest."""
    for swing in handling.swings:
        yield swing.last + handling.stroke + 1
    for move in handling.moving:
        yield move.first + handling.fresh + 1
    for stay in handling.rested:
        yield stay.last + handling.departs + 1
    for rest in handling.arriving.values():
        yield handling.last + rest.missing


def out_of_sight(handling: Handling) -> dict[str, int]:
    """End-effectors in contact with what was lost since, and the frame in which it was last seen.

    If they touch when it is seen again, they have touched all the time.
    """
    return _earliest(
        (touch.body, since)
        for touch in handling.touching
        for since in (handling.lost.get(touch.body, -1), handling.lost.get(touch.other, -1))
        if touch.last >= since >= max(touch.first, handling.last - handling.longest)
    )


def _earliest(pairs: Iterable[tuple[str, int]]) -> dict[str, int]:
    """The least frame of each name."""
    out: dict[str, int] = {}
    for name, frame in pairs:
        out[name] = min(frame, out.get(name, frame))
    return out


def _is_shared(handling: Handling, own: Touching) -> bool:
    """Whether somebody else has held the object before, from whom it may be taken.

    Who takes it over is known once one of the two lets go of it, or is taken not to. What lies on
    something fixed for some time before and after it is touched is not taken over, nor is what the
    same limb has already.
    """
    margin = handling.margin
    laid = any(
        own.other in (touch.body, touch.other)
        and touch.first <= own.first - margin
        and own.first + margin <= touch.last
        for touch in handling.laid
    )
    if laid or handling.last - own.first > handling.longest:
        return False
    before = [
        touch.body
        for touch in handling.going()
        if touch.other == own.other and touch.body != own.body and touch.first < own.first - margin
    ]
    limb = handling.limbs.get(own.body)
    by_the_same = any(limb is not None and handling.limbs.get(body) == limb for body in before)
    return bool(before) and not by_the_same


def _swinging(handling: Handling) -> Iterator[tuple[str, int]]:
    """End-effectors that touch what may move to and fro on, and since when that is open."""
    for swing in handling.swings:
        if swing.last >= handling.last - handling.stroke:
            for touch in handling.touching:
                if swing.body in (touch.body, touch.other) and touch.last >= swing.last:
                    yield touch.body, swing.last


def _just_moving(handling: Handling) -> Iterator[tuple[str, int]]:
    """End-effectors that touch what has just begun to move, and since when that matters.

    Throughout a contact in which an object moves it is possessed, so that from its beginning it
    matters what it touched. Where the motion turns out to be none, nothing began when it set off.
    """
    recent = handling.last - handling.fresh
    for own in handling.going():
        moves = handling.moves(own)
        if moves and min(move.first for move in moves) > recent:
            yield own.body, own.first
        for move in handling.moving:
            if move.object == own.other and move.first > recent:
                offs = (
                    path.first
                    for path in handling.displaced
                    if path.object == move.object and path.first <= move.first <= path.last
                )
                yield own.body, max(offs, default=move.first)


def _arriving(handling: Handling, names: Iterable[str]) -> Iterator[tuple[str, int]]:
    """End-effectors that touch what has just come to rest, and since when that is open."""
    for name in names:
        first = handling.arriving[name].first
        for touch in handling.touching:
            if touch.other == name and touch.last >= first - handling.margin:
                yield touch.body, first


def _just_tipped(handling: Handling) -> Iterator[tuple[str, int]]:
    """End-effectors that touch what has begun to lean not long ago, and since when.

    Where it comes to touch something else before it is righted, its tipping was no event.
    """
    for lean in handling.leans:
        goes_on = lean.last >= handling.last - handling.margin
        if goes_on and handling.last - lean.first <= handling.longest:
            for own in handling.going():
                if own.other == lean.object:
                    yield own.body, lean.first


def _may_part(handling: Handling, name: str) -> bool:
    """Whether it is open if a contact began or ended at once with a stop, or well before.

    When an object stopped is known to two thirds of the time within which events are one.
    """
    stop = handling.arriving[name].first
    return any(
        abs(stop - frame - handling.margin) <= 2 * handling.margin // 3
        for touch in (*handling.touching, *handling.laid)
        if name in (touch.body, touch.other)
        for frame in (touch.first, touch.last)
    )


def _lingering(handling: Handling) -> Iterator[tuple[str, int]]:
    """End-effectors whose contact, or that of what they touch, may yet go on, and since when."""
    acting = {touch.body for touch in handling.touching}
    for pair, since in handling.lingering.items():
        yield from ((body, since) for body in pair if body in acting)
        for touch in handling.touching:
            if touch.other in pair and touch.first <= since <= touch.last:
                yield touch.body, since
