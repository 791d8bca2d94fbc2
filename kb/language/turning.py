"""How things are turned while a hand has them: upside down, upright again, around, to and fro.

Wording only, from measured postures (lean, turn about the vertical) and ways; rules name segments.
"""

from bisect import bisect_right
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from statistics import median

import numpy as np
from jaxtyping import Float

from capar.model.facts import Posture, Travelled
from capar.model.observation import Observation, Segment
from kb.language.clause import Clause, in_time
from kb.language.contacts import Scene
from kb.language.lexicalisation import (
    ABOUT,
    AROUND,
    BACK_UPRIGHT,
    BY_A_QUARTER,
    HELD_OVER,
    SHIFTED,
    SLID,
    THIS_WAY,
    TURN,
    TURNED,
    UPRIGHT,
    UPSIDE_DOWN,
    moves_only,
)
from kb.language.thresholds import (
    AROUND_RAD,
    FACING_M,
    KNOWN_S,
    NOTICED_SHARE,
    OVER_RAD,
    PLACE_M,
    POURING_RAD,
    QUARTER_RAD,
    REST_S,
    SAME_TURN,
    SCRAP_M,
    SCRAP_S,
    SETTLING_S,
    SOMEWHAT_RAD,
    TO_AND_FRO_RAD,
    TURN_SHARE,
    TURNED_RAD,
    UPRIGHT_RAD,
)


@dataclass(frozen=True)
class Attitude:
    """How a thing stands at a time."""

    time_s: float
    lean: float
    """How far it leans from upright [rad]."""

    spin: float
    """How far it is turned about the vertical [rad]."""


class Turning:
    """Postures of an observation's objects by time."""

    def __init__(self, observation: Observation) -> None:
        self._step_s = observation.duration_s / max(observation.frames - 1, 1)
        self._postures: dict[str, list[Attitude]] = defaultdict(list)
        self._turns: dict[str, dict[int, int]] = defaultdict(dict)
        for fact in sorted(each for each in observation.facts if isinstance(each, Posture)):
            found = Attitude(fact.frame * self._step_s, fact.lean / 1000.0, fact.spin / 1000.0)
            self._postures[fact.body].append(found)
        self._tracks = {track.body: track for track in observation.tracks}
        self._large = {each.name for each in observation.objects if max(each.size_m) > FACING_M}
        for way in observation.facts:
            if isinstance(way, Travelled):
                self._turns[way.body][way.frame] = way.turn

    def this_way_and_that(self, segment: Segment) -> bool:
        """Whether what a hand has turns much in a segment, and ends turned by much less."""
        turns = self._turns[segment.objects[0]]
        if segment.first not in turns or segment.last not in turns:
            return False
        turned = (turns[segment.last] - turns[segment.first]) / 1000.0
        seen = self._between(segment.objects[0], segment.start_s, segment.end_s)
        if not seen or turned < TO_AND_FRO_RAD:
            return False
        net = abs(seen[-1].lean - seen[0].lean) + abs(seen[-1].spin - seen[0].spin)
        return net < 0.5 * turned or turned > 2.0 * TO_AND_FRO_RAD

    def turned_rad(self, thing: str, start_s: float, end_s: float) -> float:
        """How far it turns along its way in a time [rad]; 0 where that was not measured."""
        turns = self._turns[thing]
        first, last = (round(time_s / self._step_s) for time_s in (start_s, end_s))
        measured = first in turns and last in turns
        return (turns[last] - turns[first]) / 1000.0 if measured else 0.0

    def seen_to_turn(self, clause: Clause) -> str:
        """How to say that it is turned about the vertical while it is moved, and stands upright.

        Empty where it is not.
        """
        seen = self._between(clause.objects[0], clause.start_s, clause.end_s)
        if not seen or max(seen[0].lean, seen[-1].lean) > UPRIGHT_RAD:
            return ""
        spin = abs(seen[-1].spin - seen[0].spin)
        if spin > AROUND_RAD or spin < SOMEWHAT_RAD:
            return AROUND if spin > AROUND_RAD else ""
        return BY_A_QUARTER if spin > QUARTER_RAD else TURN

    def beside(self, grip: Sequence[Clause]) -> Iterator[Clause]:
        """Clauses of how a thing turns that a hand slides."""
        for clause in grip:
            pattern = self.seen_to_turn(clause) if clause.name in SLID else ""
            if pattern in {TURN, BY_A_QUARTER}:
                seen = self._between(clause.objects[0], clause.start_s, clause.end_s)
                since, until = _course(seen)
                if until.time_s <= clause.end_s:
                    yield _turned((clause,), pattern, since, until)

    def spins_rad(self, clause: Clause) -> float:
        """How far a thing is turned about the vertical at the end of a clause [rad]."""
        seen = self._between(clause.objects[0], clause.start_s, clause.end_s)
        return abs(seen[-1].spin - seen[0].spin) if seen else 0.0

    def swings_rad(self, clause: Clause) -> float:
        """Over which angle the line between two hands turns that have a thing [rad].

        0 where that was not kept.
        """
        line = self._line(clause.ees, clause.start_s, clause.end_s)
        return 0.0 if line is None else float(np.ptp(line[1]))

    def faces_aside(self, clause: Clause) -> bool:
        """Whether a thing so large that people notice it faces another way at the end."""
        return clause.objects[0] in self._large and self.spins_rad(clause) > SOMEWHAT_RAD

    def course(self, clause: Clause) -> tuple[float, float] | None:
        """From when to when a thing is turned about the vertical within a clause [s].

        That is from where a share is done to where all but a share is, as the line between two
        hands that have the thing tells it in every frame; else as its postures do, which were
        measured where something began or ended, if they are close enough to each other.

        Returns:
            None where it turns by less than is noticed, or the times are not known so closely.
        """
        seen = self._between(clause.objects[0], clause.start_s, clause.end_s)
        if self.spins_rad(clause) < SOMEWHAT_RAD:
            return None
        net = seen[-1].spin - seen[0].spin
        line = self._line(clause.ees, seen[0].time_s, seen[-1].time_s)
        if line is not None and abs(line[1][-1] - line[1][0] - net) < SAME_TURN * abs(net):
            done = (line[1] - line[1][0]) / (line[1][-1] - line[1][0])
            first, last = _course_of(done, TURN_SHARE)
            return float(line[0][first]), float(line[0][last])
        seen = self._between(clause.objects[0], clause.start_s, clause.end_s + REST_S)
        times = np.array([attitude.time_s for attitude in seen])
        between = np.linspace(times[0], times[-1], max(round((times[-1] - times[0]) * 100.0), 2))
        spins = np.interp(between, times, [attitude.spin for attitude in seen])
        done = (spins - spins[0]) / (spins[-1] - spins[0])
        first, last = _course_of(np.minimum(done, 2.0 - done), NOTICED_SHARE)
        ends = float(between[first]), float(between[last])
        return ends if all(_gap_s(times, time_s) < KNOWN_S for time_s in ends) else None

    def _line(
        self, ees: Sequence[str], start_s: float, end_s: float
    ) -> tuple[Float[np.ndarray, "frames"], Float[np.ndarray, "frames"]] | None:
        """Times [s], and where the line between two hands then points over the ground [rad]."""
        tracks = [self._tracks[ee] for ee in ees if ee in self._tracks]
        if len(tracks) != 2 or not tracks[0].step_s == tracks[1].step_s > 0.0:
            return None
        step_s = tracks[0].step_s
        frames = np.arange(round(start_s / step_s), round(end_s / step_s) + 1)
        frames = frames[frames < min(len(track.positions) for track in tracks)]
        offsets = (tracks[1].positions[frames] - tracks[0].positions[frames])[:, :2]
        if len(frames) < 2 or not np.linalg.norm(offsets, axis=1).min() > SCRAP_M:
            return None
        return frames * step_s, np.unwrap(np.arctan2(offsets[:, 1], offsets[:, 0]))

    def tipped_s(self, thing: str, start_s: float, end_s: float) -> float:
        """Until when, from a time on, it leans so far that it is poured from [s]."""
        for seen in self._between(thing, start_s, end_s):
            if seen.time_s > start_s and seen.lean < POURING_RAD:
                break
            start_s = max(start_s, seen.time_s)
        return start_s

    def leant(self, thing: str, start_s: float, end_s: float) -> float:
        """How far it leans from upright most of that time [rad]; 0 where that is not known."""
        seen = self._between(thing, start_s, end_s)
        return median(each.lean for each in seen) if seen else 0.0

    def leans_rad(self, thing: str, start_s: float, end_s: float) -> float:
        """How far it leans from upright for half of a time at least [rad]; 0 if unknown."""
        seen = self._between(thing, start_s, end_s)
        if not seen:
            return 0.0
        times = np.linspace(start_s, end_s, max(round((end_s - start_s) * 100.0), 2))
        leans = np.interp(times, [each.time_s for each in seen], [each.lean for each in seen])
        return float(np.median(leans))

    def told(self, grip: Sequence[Clause]) -> Iterator[Clause]:
        """Clauses of how a thing is turned over or around while a hand moves it.

        Args:
            grip: What the hand does to it on end.
        """
        thing, start_s, end_s = grip[0].objects[0], grip[0].start_s, grip[-1].end_s
        seen = self._between(thing, start_s, end_s)
        if len(seen) < 2:
            return
        over = seen[0].lean > OVER_RAD
        leant = not over and seen[0].lean > UPRIGHT_RAD
        since, turned_over = seen[0], False
        for before, after in pairwise(seen):
            if not over and not leant and before.lean <= UPRIGHT_RAD:
                since = before
            if not over and after.lean > OVER_RAD:
                yield _turned(grip, UPSIDE_DOWN, since, after)
                over, leant, since, turned_over = True, False, after, True
            elif over and after.lean > OVER_RAD:
                since = after
            elif (over or leant) and after.lean < UPRIGHT_RAD:
                yield _turned(grip, BACK_UPRIGHT if turned_over else UPRIGHT, since, after)
                over, leant, since = False, False, after
        spin = abs(seen[-1].spin - seen[0].spin)
        faces = thing in self._large and any(each.name == "Carry" for each in grip)
        if max(each.lean for each in seen) < OVER_RAD:
            if spin > AROUND_RAD:
                yield _turned(grip, AROUND, *_course(seen))
            elif faces and spin > QUARTER_RAD:
                yield _turned(grip, BY_A_QUARTER, *_course(seen))

    def _between(self, thing: str, start_s: float, end_s: float) -> list[Attitude]:
        """Its postures from the last one before the start to the one nearest to the end."""
        found, slack_s = self._postures[thing], 0.5 * self._step_s
        begin = bisect_right(found, start_s + slack_s, key=_time) - 1
        end = bisect_right(found, end_s + slack_s, key=_time)
        late = found[end : end + 1]
        if late and end and late[0].time_s - end_s < min(end_s - found[end - 1].time_s, REST_S):
            end += 1
        return found[max(begin, 0) : end]


def _time(attitude: Attitude) -> float:
    return attitude.time_s


def _course(seen: Sequence[Attitude]) -> tuple[Attitude, Attitude]:
    """From where it still is turned as at first to where it is turned as at last."""
    noticed = min(TURNED_RAD, NOTICED_SHARE * abs(seen[-1].spin - seen[0].spin))
    moved = [abs(each.spin - seen[0].spin) > noticed for each in seen]
    rest = [abs(each.spin - seen[-1].spin) > noticed for each in seen]
    last = len(seen) - 1 - rest[::-1].index(True)
    return seen[max(moved.index(True) - 1, 0)], seen[min(last + 1, len(seen) - 1)]


def _course_of(done: Float[np.ndarray, "frames"], share: float) -> tuple[int, int]:
    """The first frame in which a share of a turn is done, and from which on all but a share is."""
    going = done < 1.0 - share
    return int(np.argmax(done > share)), min(len(done) - int(np.argmax(going[::-1])), len(done) - 1)


def _gap_s(times: Float[np.ndarray, "samples"], time_s: float) -> float:
    """How far the samples before and after a time are apart [s]."""
    after = min(int(np.searchsorted(times, time_s)), len(times) - 1)
    return float(times[after] - times[max(after - 1, 0)])


def _turned(grip: Sequence[Clause], pattern: str, since: Attitude, until: Attitude) -> Clause:
    return replace(
        grip[0],
        pattern=pattern,
        objects=grip[0].objects[:1],
        start_s=since.time_s,
        end_s=until.time_s,
        changes=True,
        name="Turn",
        general=("MoveObj",),
        goes_on=True,
        possessed=True,
        rights=False,
    )


def turned(told: Sequence[Clause], turning: Turning) -> tuple[list[Clause], list[Clause]]:
    """How what one hand has is turned over or around, beside its other clauses.

    A clause that says no more than that the thing is moved meanwhile is left out of those.

    Returns:
        The other clauses, and those of turning; both in order of time.
    """
    rest: list[Clause] = []
    found: list[Clause] = []
    at = 0
    while at < len(told):
        size = 1
        while at + size < len(told) and _goes_on(told[at + size - 1], told[at + size]):
            size += 1
        grip = told[at : at + size]
        at += size
        moved = [each for each in grip if each.changes]
        wrung = any(each.pattern == THIS_WAY for each in grip)
        ways = list(turning.told(moved)) if moved and grip[0].possessed and not wrung else []
        ways += [] if ways else turning.beside(moved)
        rest += (step for step in (_turn(each, ways, turning) for each in grip) if step)
        found += ways
        found += _held_over(moved, ways)
    return rest, found


def _held_over(moved: Sequence[Clause], ways: Sequence[Clause]) -> Iterator[Clause]:
    """That a thing is held upside down, of which no more is said meanwhile than that it moves."""
    for over, back in pairwise(ways):
        turned_over = (over.pattern, back.pattern) == (UPSIDE_DOWN, BACK_UPRIGHT)
        if not turned_over or back.start_s - over.end_s < SETTLING_S:
            continue
        held = replace(over, pattern=HELD_OVER, start_s=over.end_s, end_s=back.start_s)
        meanwhile = [each for each in moved if each.overlaps(held)]
        if all(moves_only(each.pattern) for each in meanwhile):
            yield held


def _turn(clause: Clause, ways: Sequence[Clause], turning: Turning) -> Clause | None:
    """A clause of a thing that is moved, as one of turning it; None where that is told already."""
    if not (moves_only(clause.pattern) and clause.possessed and clause.changes):
        return clause
    if any(clause.overlap_s(way) > 0.0 for way in ways):
        return None
    turns = turning.seen_to_turn(clause)
    return replace(clause, pattern=TURN, name="Turn") if turns else clause


def timed(steps: Sequence[Clause], scene: Scene, turning: Turning) -> tuple[Clause, ...]:
    """The clauses, those of turning about the vertical from when to when the thing turns.

    Where that is not known closely, turning has no times of its own: the thing is moved then, and
    turned meanwhile. One that hardly leaves its place is only turned, while it moves.

    Args:
        steps: What was done, in order of time.
        scene: Measured contacts and places.
        turning: How things are turned.
    """
    out: list[Clause] = []
    for step in steps:
        if step.pattern not in ABOUT or not step.possessed or step.pauses:
            out.append(step)
            continue
        course = turning.course(step)
        start_s, end_s = course or (step.start_s, step.end_s)
        alone = not any(_moves_beside(step, other) for other in steps)
        _, strays_m = scene.over_ground_m(step.objects[0], step.start_s, step.end_s)
        if course is None and alone and strays_m < PLACE_M:
            out.append(step)
            continue
        if course is None and alone and turning.faces_aside(step):
            out.append(replace(step, pattern="move {1}", name="MoveObj"))
        out.append(replace(step, start_s=start_s, end_s=end_s, sharp=course is not None))
    return tuple(sorted(out, key=in_time))


def _moves_beside(turn: Clause, other: Clause) -> bool:
    """Whether the same hands are told to move the same thing otherwise meanwhile."""
    same = (turn.ees, turn.objects[:1]) == (other.ees, other.objects[:1])
    return same and other.changes and other.pattern not in TURNED and turn.overlaps(other)


def with_turning(told: Sequence[Clause], ways: Sequence[Clause]) -> tuple[Clause, ...]:
    """The clauses of one hand with those of turning, each in the grip to which it belongs."""
    out = [step for step in told if not any(_scrap_beside(step, way) for way in ways)]
    for way in ways:
        same = [step for step in told if step.objects[:1] == way.objects]
        grip = max(same, key=way.overlap_s).grip if same else way.grip
        out.append(replace(way, grip=grip))
    return tuple(sorted(out, key=_start))


def _scrap_beside(step: Clause, way: Clause) -> bool:
    """Whether it is a short shift of a thing that was just turned: the end of putting it there."""
    brief = step.possessed and step.end_s - step.start_s < SCRAP_S
    soon = 0.0 <= step.start_s - way.end_s < SETTLING_S
    return brief and soon and step.name in SHIFTED and step.objects[:1] == way.objects


def _start(clause: Clause) -> float:
    return clause.start_s


def _goes_on(one: Clause, other: Clause) -> bool:
    """Whether the hand still has the same thing."""
    return one.possessed and other.possessed and one.objects[:1] == other.objects[:1]
