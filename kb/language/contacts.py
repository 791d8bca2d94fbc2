"""How a sentence may put what a segment did: where a thing stood, or that it was there before.

This is wording only. It chooses among ways to say an action that the rules have named ("put it
down", "put it back"), reads measured contacts alone, and names, splits or drops no segment.
"""

from collections.abc import Collection, Iterable, Sequence

import numpy as np

from capar.model.facts import Flies, Lies, Link, Moving, OfAgent, Swings, Touching
from capar.model.geometry import rotations
from capar.model.observation import Observation, ObservedLink, ObservedObject, Segment
from kb.language.lexicalisation import OPEN
from kb.language.thresholds import (
    FLOOR_M,
    LEVEL_M,
    REST_S,
    RISEN_M,
    RUNNING_MPS,
    STEADY_S,
    STILL_M,
    UNSEEN_S,
)
from kb.language.tracks import Tracks
from kb.lexicon.english import the_agent

LEFT_OUT = "objects-left-out"
"""The code of a notice that not all things are observed that were there."""


class Scene(Tracks):
    """Measured contacts of an observation, with the ways of its bodies, asked for sentences."""

    def __init__(self, observation: Observation) -> None:
        super().__init__(observation)
        effectors = {link.ee for link in observation.links}
        effectors |= {fact.ee for fact in observation.facts if isinstance(fact, Link)}
        touching = [fact for fact in observation.facts if isinstance(fact, Touching)]
        self._step_s = observation.duration_s / max(observation.frames - 1, 1)
        self._last = observation.frames - 1
        self._hands = [each for each in touching if each.body in effectors]
        self._pairs = [each for each in touching if each.body not in effectors]
        lies = [fact for fact in observation.facts if isinstance(fact, Lies)]
        self._aside = [fact for fact in lies if fact.how in {"beside", "below"}]
        self._within = [fact for fact in lies if fact.how in {"inside", "dips"}]
        self._over = [fact for fact in lies if fact.how in {"above", "inside"}]
        self._moving = [fact for fact in observation.facts if isinstance(fact, Moving)]
        flights = [(each.object, each) for each in observation.facts if isinstance(each, Flies)]
        swings = [(each.body, each) for each in observation.facts if isinstance(each, Swings)]
        self._by_itself: list[tuple[str, Flies | Swings]] = [*flights, *swings]
        self._tags = {thing.name: thing.tag for thing in observation.objects}
        self._objects = {thing.name: thing.kind for thing in observation.objects}
        owners = [fact for fact in observation.facts if isinstance(fact, OfAgent)]
        self._owners = {each.body: each.agent for each in owners}
        self._kinds = {each.name: each.kind for each in (observation.agent, *observation.others)}
        self._complete = all(each.code != LEFT_OUT for each in observation.notices)
        self._worked_in = [
            each
            for each in observation.segments
            if each.possessed and len(each.objects) > 1 and _works_in(each)
        ]

    def left_there(self, thing: str, time_s: float) -> bool:
        """Whether a thing is as high when nothing touches it for the first time afterwards."""
        track = self._tracks.get(thing)
        touches = [each for each in self._hands if each.other == thing]
        if track is None or track.step_s == 0.0 or not touches:
            return False
        step_s = self._step_s
        after_s = time_s
        for each in sorted(touches, key=lambda each: each.first):
            if each.first * step_s <= after_s + step_s:
                after_s = max(after_s, each.last * step_s)
        now = self._places(thing, time_s, time_s)
        if after_s >= (len(track.positions) - 2) * track.step_s:
            then = self._stands_again(thing, after_s)
        else:
            then = self._places(thing, after_s, after_s)
        if then is None or now is None:
            return False
        return abs(float(then[-1, 2] - now[-1, 2])) < LEVEL_M

    def _stands_again(self, thing: str, end_s: float) -> np.ndarray | None:
        """Where a thing is as a recording ends, if it stays there, as high as it was at first."""
        last = self._places(thing, end_s - UNSEEN_S, end_s)
        first = self._places(thing, 0.0, 0.0)
        if last is None or first is None:
            return None
        strays_m = float(np.linalg.norm(last - last[-1], axis=1).max())
        again = abs(float(last[-1, 2] - first[-1, 2])) < 0.5 * STILL_M
        return last if again and strays_m < 0.5 * STILL_M else None

    def sets_down(self, thing: str, start_s: float, end_s: float) -> bool:
        """Whether a thing stands at the end where it is left, and did not at the start."""
        return self.left_there(thing, end_s) and not self.left_there(thing, start_s)

    def is_up_between(self, thing: str, start_s: float, end_s: float) -> bool:
        """Whether a thing that stands at the start, and is left at the end, is up in between."""
        places = self._places(thing, start_s, end_s)
        if places is None or not self.left_there(thing, end_s):
            return False
        level = abs(float(places[-1, 2] - places[0, 2])) < LEVEL_M
        return level and float(places[:, 2].max() - places[0, 2]) > RISEN_M

    def gathers(self, goal: str, things: Sequence[str]) -> bool:
        """Whether all things are over a place in the end, and none was at first."""
        over = [each for each in self._over if each.other == goal]
        last = max((each.last for each in self._over), default=0)
        there = {each.body for each in over if each.last == last}
        before = {each.body for each in over if each.first == 0}
        return there >= set(things) and before.isdisjoint(things)

    def are_all(self, things: Sequence[str], goal: ObservedObject) -> bool:
        """Whether those are all that can be moved and were not in a box at first.

        Not where things were left out of what was observed.
        """
        movable = {name for name, tag in self._tags.items() if tag == "mobile"}
        there = {name for name in movable if self.inside(name, goal, 0.0)}
        return self._complete and movable - there == set(things)

    def inside(self, thing: str, container: ObservedObject, time_s: float) -> bool:
        """Whether a thing is in an open box, or heaped on what is in it.

        Where it was measured what lies in a box that has walls, or dips into it, that tells; else
        whether the thing's middle is within the shadow of the box, and below its rim.

        Args:
            thing: The thing.
            container: The box; one of which only the floor is known has no rim.
            time_s: When [s].
        """
        within = [fact for fact in self._within if fact.other == container.name]
        if within and container.size_m[2] >= FLOOR_M:
            frame = min(round(time_s / self._step_s), self._last)
            there = {each.body for each in within if each.first <= frame <= each.last}
            heaped = self._heaped(thing, there, container.name, frame)
            return thing in there or heaped or self._at_rim(thing, container, frame)
        return self.over(thing, container, time_s, rim_m=0.0)

    def _heaped(self, thing: str, there: Collection[str], container: str, frame: int) -> bool:
        """Whether a thing lies above a box and touches what is in it."""
        above = any(
            (each.body, each.how, each.other) == (thing, "above", container)
            and each.first <= frame <= each.last
            for each in self._over
        )
        return above and any(
            each.body == thing and each.other in there and each.first <= frame <= each.last
            for each in self._pairs
        )

    def _at_rim(self, thing: str, container: ObservedObject, frame: int) -> bool:
        """Whether a thing touches a box from above, with its middle no higher than about the rim.

        It is in there for all but the tolerance of contacts.
        """
        touches = any(
            {each.body, each.other} == {thing, container.name} and each.first <= frame <= each.last
            for each in self._pairs
        )
        return touches and self.over(thing, container, frame * self._step_s, rim_m=STILL_M)

    def over(
        self, thing: str, container: ObservedObject, time_s: float, *, rim_m: float | None = None
    ) -> bool:
        """Whether a thing's middle is within the shadow of a box, and above its floor.

        Args:
            thing: The thing.
            container: The box.
            time_s: When [s].
            rim_m: How far above the rim of the box, where it has one, it is at most [m].
        """
        places = self._places(thing, time_s, time_s)
        if places is None:
            return False
        own = rotations(np.array(container.orientation)).inv()
        offset = own.apply(places[-1] - np.array(container.position_m))
        size = np.array(container.size_m)
        walled = rim_m is not None and size[2] >= FLOOR_M
        above = walled and bool(offset[2] >= size[2] + (rim_m or 0.0))
        around = bool((np.abs(offset[:2]) < 0.5 * size[:2]).all())
        return around and bool(offset[2] > -size[2]) and not above

    def rises(self, segment: Segment) -> bool:
        """Whether the object is clearly higher when a segment ends."""
        places = self._places(segment.objects[0], segment.start_s, segment.end_s)
        return places is not None and float(places[-1, 2] - places[0, 2]) > RISEN_M

    def runs_over(self, segment: Segment) -> bool:
        """Whether the hand goes over the object, which stays: a hand that holds does not."""
        hand = self._places(segment.ee, segment.start_s, segment.end_s)
        thing = self._places(segment.objects[0], segment.start_s, segment.end_s)
        if hand is None or thing is None or len(hand) < 2 or segment.end_s <= segment.start_s:
            return False
        path = float(np.linalg.norm(np.diff(hand, axis=0), axis=1).sum())
        spread = float(np.linalg.norm(thing - thing[0], axis=1).max())
        return spread < STILL_M and path / (segment.end_s - segment.start_s) > RUNNING_MPS

    def steadies_since_s(self, segment: Segment) -> float | None:
        """Since when another hand works in the thing at which a hand stays [s]; None if none."""
        begins = [
            max(each.start_s, segment.start_s)
            for each in self._worked_in
            if each.ee != segment.ee
            and each.objects[1] == segment.objects[0]
            and min(each.end_s, segment.end_s) - max(each.start_s, segment.start_s) >= STEADY_S
        ]
        return min(begins, default=None)

    def carried_on(self, link: ObservedLink) -> frozenset[int]:
        """Segments in which contact was lost with what the hand went on carrying.

        That is where it moves on, between two segments in which the hand possesses it, while
        nothing else touches it, and neither falls freely nor swings.
        """
        out: set[int] = set()
        lost: list[Segment] = []
        before: Segment | None = None
        for segment in link.segments:
            if segment.possessed:
                if before is not None and self._never_left(before, lost, segment):
                    out |= {each.index for each in lost}
                before, lost = segment, []
            else:
                lost.append(segment)
        return frozenset(out)

    def _never_left(self, before: Segment, lost: Sequence[Segment], after: Segment) -> bool:
        thing = before.objects[:1]
        if not lost or after.objects[:1] != thing:
            return False
        first, last = lost[0].first, lost[-1].last
        moves = all(
            each.objects[:1] == thing and each.features.change_loc.startswith("1") for each in lost
        )
        forced = any("1" in each.features.force for each in (before, *lost, after))
        alone = [each for name, each in self._by_itself if name == thing[0]]
        others = [each for each in self._hands if each.other == thing[0] and each.body != before.ee]
        borne = any(each.first <= first < each.last for each in self._touched(thing[0]))
        during = any(each.first < last and first < each.last for each in (*alone, *others))
        return moves and not (forced or borne or during)

    def _touched(self, thing: str) -> Iterable[Touching]:
        """Contacts of a thing with what is no hand."""
        return (each for each in self._pairs if thing in {each.body, each.other})

    def is_self(self, name: str) -> bool:
        """Whether an object is of the agent's own body."""
        return self._tags.get(name) == "self"

    def is_open(self, name: str) -> bool:
        """Whether an object is open above by its kind or its name, so that things can be in it."""
        return not OPEN.isdisjoint((name, self._objects.get(name, "")))

    def is_movable(self, name: str) -> bool:
        """Whether an object can be moved."""
        return self._tags.get(name) == "mobile"

    def rests_on(self, thing: str, support: str) -> bool:
        """Whether the thing lay still on the support at some time while no hand touched it."""
        if self.is_self(support):
            return False
        return any(self._free(each, thing) for each in self._between(thing, support))

    def stood_on(self, thing: str, support: str, time_s: float) -> bool:
        """Whether the thing lay on the support from the beginning until about then."""
        contacts = self._between(thing, support)
        until_s = [contact.last * self._step_s for contact in contacts if contact.first == 0]
        return self.rests_on(thing, support) and max(until_s, default=0.0) >= time_s - REST_S

    def was_there(self, segment: Segment, thing: str, goal: str) -> bool:
        """Whether the thing touched the goal before, and left it."""
        return any(
            each.first <= segment.first and each.last < segment.last
            for each in self._between(thing, goal)
        )

    def goes_off(self, segment: Segment, thing: str, other: str) -> bool:
        """Whether the thing leaves the other at its edge, by the end of a segment."""
        soon = round(UNSEEN_S / self._step_s) if self._step_s else 0
        return any(
            segment.first < contact.last <= segment.last + soon
            and aside.first <= contact.last + soon
            and contact.last <= aside.last
            for contact in self._between(thing, other)
            for aside in self._aside
            if (aside.body, aside.other) == (thing, other)
        )

    def taker(self, segment: Segment) -> str:
        """The one other agent who has the dominant object when a segment begins, and after it.

        Said as a noun phrase; empty where there is none, or several.
        """
        own = self._owners.get(segment.ee)
        found = {
            self._owners.get(each.body, own)
            for each in self._hands
            if each.other in segment.objects[:1] and each.first <= segment.first < each.last
        }
        names = [each for each in found if each and each != own]
        return the_agent(names[0], self._kinds.get(names[0], "")) if len(names) == 1 else ""

    def _between(self, thing: str, other: str) -> Iterable[Touching]:
        return (each for each in self._pairs if {each.body, each.other} == {thing, other})

    def _free(self, contact: Touching, thing: str) -> bool:
        """Whether frames of a contact remain in which the thing is neither touched nor moved."""
        hands = [(each.first, each.last) for each in self._hands if each.other == thing]
        moves = [(each.first, each.last) for each in self._moving if each.object == thing]
        frame = contact.first
        for first, last in sorted(hands + moves):
            if first > frame:
                return True
            frame = max(frame, last + 1)
            if frame > contact.last:
                return False
        return frame <= contact.last


def _works_in(segment: Segment) -> bool:
    """Whether what the hand has moves at the second object from beginning to end."""
    features = segment.features
    both = features.rel_start[:1] + features.rel_start[2:3]
    return both == "11" and features.rel_start == features.rel_end and "1" in features.change_loc
