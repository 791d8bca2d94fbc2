"""What is decided of a performance before hands' ways are: goals, and grips that reach."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.body.human import Human
from capar.body.recording import HAND_SEGMENTS
from capar.regeneration import attending
from capar.regeneration.body_frames import body_frames, head_path
from capar.regeneration.clearing import ClearTask
from capar.regeneration.collisions import NEAR_M, Pair, Surroundings, things_apart
from capar.regeneration.companions import led_holds
from capar.regeneration.errors import PlanError
from capar.regeneration.forces.flights import first_guess
from capar.regeneration.grips import OUT_M, Grip, Gripping, Turn, drawn_turns, turns
from capar.regeneration.scenes import Scene
from capar.regeneration.solving import Solver, Targets, vectors
from capar.regeneration.sources import Hold, Source
from capar.regeneration.styles import Style
from capar.regeneration.thing_goals import thing_goals
from capar.regeneration.thing_paths import Ways, thing_paths

REACH_M, REACH_RAD = 0.0009, float(np.radians(0.9))
"""A hand that misses a goal by more cannot reach it: a little less than the gates allow."""

CUT_M = 0.001
"""How deep a part of the body may be inside a thing [m]."""

PRESSED_M = 0.025
"""An arm that is no deeper inside what it holds presses against it: flesh gives way and the
mannequin does not. It is a last resort, told, and fails the gate of penetration [m]."""

APART_M = 0.02
"""Things that a hand takes together are no more than this farther apart than they were [m]."""

KEYS = 6
"""Key postures in a hold, besides those at goals."""

KEY_ITERATIONS = 40
MOST_TURNS = 120
"""Turns of a grip that are tried."""

GAINED_M = 0.06
"""Nearer to the body no turn of a grip brings the palm (of a mug's 112 turns at most 42 mm) [m]."""

FREELY = 0.003
"""Share of its weight that a palm's turning has where it is sought how the body would turn it."""

MOST_EASED_RAD = 1.05
"""So far a grip is turned at most as the body would take it [rad]."""

ROUNDS = 4
"""So often a grip is turned as the body would take it: each time the hand touches elsewhere [1]."""

SETTLE_S = 0.45
"""How long the head takes to be firmly where it is to be [s]."""


@dataclass(frozen=True)
class Beyond:
    """Where a palm does not come, however it is turned."""

    frame: int
    sentence: str


@dataclass(frozen=True)
class Miss:
    """By how much grips fail at their worst key posture."""

    ratio: float = 0.0
    """In units of what is allowed [1]."""

    sentence: str = ""
    cuts: bool = False
    """Whether a part of the body is inside what is held, while the hands reach it."""


class Draft:
    """A plan whose grips are still open."""

    def __init__(
        self,
        source: Source,
        scene: Scene,
        human: Human,
        style: Style,
        watched: frozenset[int] = frozenset(),
        ways: Ways | None = None,
    ) -> None:
        self.source, self.scene = source, scene
        self.old = body_frames(source.human, source.scene)
        self.new = body_frames(human, scene)
        if ways is None:
            goals = thing_goals(source, scene, self.old, self.new, style.force)
            ways = thing_paths(source, scene, goals, human, style)
        self.goals, self.things, self.told = ways.goals, ways.paths, list(ways.told)
        self.things = first_guess(source, scene, self.things)
        self.head = head_path(source, self.old, self.new)
        self.firmness = attending.around(source, source.meetings, SETTLE_S)
        self.looks = attending.looks(source, self.things, self.head)
        self.gripping = Gripping(source, scene, self.old, self.new)
        self.clear = ClearTask(self.gripping.around, source.met)
        self.grips: tuple[Grip, ...] = ()
        self.pressed: list[str] = []
        self.worst = Miss()
        self.only: frozenset[int] = frozenset()
        self.watched, self.style = watched, style

    def beyond(self, frames: frozenset[int] | None = None) -> Beyond | None:
        """The first key frame at which a palm that may turn freely misses by more than grips gain.

        Args:
            frames: Frames at which it is tried; the key frames of every hold, unless stated.
        """
        for hold in self.source.holds:
            grips, solver = self._gripped([hold], Turn()), self._solver()
            solver.turning = FREELY
            held = {f for f in frames or () if hold.first <= f <= hold.last}
            for frame in self.key_frames([hold]) if frames is None else sorted(held):
                goal = self.targets(grips, frame)
                solver.follow(goal, most=KEY_ITERATIONS)
                missed_m = solver.missed(goal)[0]
                if missed_m > GAINED_M:
                    return Beyond(
                        frame,
                        f"the {hold.side} hand cannot {self._does(hold, frame)} {hold.thing!r} at "
                        f"{self.source.times[frame]:.2f} s: however it is turned, it misses by "
                        f"{1e3 * missed_m:.0f} mm",
                    )
        return None

    def _does(self, hold: Hold, frame: int) -> str:
        """What a hand does at a frame with what it holds, as a verb."""
        tosses = [toss for toss in self.source.tosses if toss.thing == hold.thing]
        if any(frame == toss.first and hold.side == toss.side for toss in tosses):
            return "throw"
        caught = any(frame == toss.last and hold.side == toss.catcher for toss in tosses)
        return "catch" if caught else "follow"

    def reachable_grips(
        self, most: int = MOST_TURNS, *, thorough: bool | None = None
    ) -> tuple[list[Grip], str | None]:
        """A grip for every hold with the least turn that reaches; what is missed if none does.

        Where an arm presses against what it holds whatever the grip, that is in ``pressed``.

        Args:
            most: Turns of a grip that are tried.
            thorough: Whether a hand is also drawn back, and turned as the body would take the
                thing; with all turns only, unless stated.
        """
        thorough = most == MOST_TURNS if thorough is None else thorough
        chosen: list[Grip] = []
        for group in _groups(led_holds(self.source.holds, self.source.companions)):
            usual = list(turns(self.scene.thing(group[0].thing)))[:most]
            miss, grips = self._best_grips(chosen, group, usual)
            if miss.ratio > 1.0 and miss.cuts and thorough:
                found = self._best_grips(chosen, group, list(drawn_turns()))
                miss, grips = min((miss, grips), found, key=lambda tried: tried[0].ratio)
            if miss.ratio > 1.0 and thorough:
                found = self._eased_grips(chosen, group, miss, grips)
                miss, grips = min((miss, grips), found, key=lambda tried: tried[0].ratio)
            chosen += grips
            self.worst = max(self.worst, miss, key=lambda found: found.ratio)
            if miss.ratio > 1.0 and not (miss.cuts and miss.ratio * CUT_M <= PRESSED_M):
                return chosen, miss.sentence
            if miss.ratio > 1.0:
                self.pressed.append(miss.sentence)
        return chosen, None

    def _best_grips(
        self, chosen: list[Grip], group: list[Hold], options: list[Turn]
    ) -> tuple[Miss, list[Grip]]:
        """The first of some turns that reaches, or else the one that misses least."""
        best: tuple[Miss, list[Grip]] | None = None
        for turn in options:
            grips = self._gripped(group, turn)
            enough = np.inf if best is None else max(best[0].ratio, 1.0)
            miss = self._missed(chosen + grips, group, enough)
            if best is None or miss.ratio < best[0].ratio:
                best = (miss, grips)
            if miss.ratio <= 1.0:
                break
        assert best is not None
        return best

    def _eased_grips(
        self, chosen: list[Grip], group: list[Hold], miss: Miss, grips: list[Grip]
    ) -> tuple[Miss, list[Grip]]:
        """Grips turned as the body itself would take the thing; the best ones that were tried."""
        best = miss, grips
        for start in (self._gripped(group, Turn()), grips):
            eased = start
            for _ in range(ROUNDS):
                eased = self._as_turned(chosen, group, eased)
                found = self._missed(chosen + eased, group, best[0].ratio)
                best = min(best, (found, eased), key=lambda tried: tried[0].ratio)
                if best[0].ratio <= 1.0:
                    return best
        return best

    def _gripped(self, group: list[Hold], turn: Turn) -> list[Grip]:
        """Grips of some holds, and of what these hands hold besides."""
        return self.gripping.with_companions([self.gripping.grip(hold, turn) for hold in group])

    def _as_turned(self, chosen: list[Grip], group: list[Hold], grips: list[Grip]) -> list[Grip]:
        """Grips turned as palms are, in the mean, that have to be somewhere and may turn freely."""
        solver = self._solver()
        solver.turning = FREELY
        turns: dict[str, list[Rotation]] = {grip.hold.side: [] for grip in grips}
        for frame in self.key_frames(group):
            self._follow(solver, chosen + grips, frame)
            for grip in grips:
                if grip.hold.first <= frame <= grip.hold.last:
                    side, thing = grip.hold.side, self.things[grip.hold.thing][frame]
                    hand = solver.palm(side) * self.new.palms[side].inv()
                    wanted = (thing * grip.pose).rotation
                    turns[side].append(wanted.inv() * hand.rotation)
        out = []
        for grip in (one for one in grips if not one.beside):
            by = Rotation.concatenate(turns[grip.hold.side]).mean()
            eased = (Rotation.from_rotvec(grip.turn.eased) * by).as_rotvec()
            eased *= min(1.0, MOST_EASED_RAD / max(float(np.linalg.norm(eased)), 1e-9))
            x, y, z = (float(angle) for angle in eased)
            out.append(self.gripping.grip(grip.hold, replace(grip.turn, eased=(x, y, z))))
        return self.gripping.with_companions(out)

    def _missed(self, grips: list[Grip], group: list[Hold], enough: float) -> Miss:
        """How far the key postures of some holds are missed, in units of what is allowed.

        No further than is enough to be worse than another grip. A hand that does not come to the
        surface of the thing has no grip.
        """
        loose = max(grips, key=lambda grip: grip.missed_m)
        if not loose.touches:
            return Miss(1.0 + loose.missed_m / REACH_M, _beside(loose))
        solver, worst = self._solver(), Miss()
        for frame in self.key_frames(group):
            goal = self._follow(solver, grips, frame)
            metres, radians = solver.missed(goal)
            ratio = max(metres / REACH_M, radians / REACH_RAD)
            if ratio > worst.ratio:
                worst = Miss(ratio, self._sentence(group, frame, metres, radians))
            pair = self.deepest_cut(solver.posture, grips, frame)
            if pair and -pair.distance_m / CUT_M > worst.ratio:
                depth, sides = -pair.distance_m, _sides(group)
                worst = Miss(
                    depth / CUT_M,
                    f"while the {sides} hand has {group[0].thing!r} at "
                    f"{self.source.times[frame]:.2f} s, {pair.part} is {1e3 * depth:.0f} mm inside "
                    f"{pair.thing!r}",
                    pair.thing == group[0].thing,
                )
            if ratio > enough:
                break
        return worst

    def key_postures(
        self,
    ) -> tuple[dict[int, Float[np.ndarray, "posture"]], Float[np.ndarray, "posture"]]:
        """The posture at each key frame with the chosen grips, and the one of standing at ease."""
        solver, out = self._solver(), {}
        for frame in self.key_frames(list(self.source.holds)):
            self._follow(solver, list(self.grips), frame)
            out[frame] = solver.posture
        return out, solver.rest

    def _solver(self) -> Solver:
        place = (*self.scene.place, self.scene.floor_m)
        return Solver(self.new.human, place, self.scene.heading, (self.clear,))

    def _follow(self, solver: Solver, grips: list[Grip], frame: int) -> Targets:
        """Reach for the goals of a key frame; a second time where limbs are inside something.

        From wherever the body was before, the way there may lead through things.
        """
        goal = self.targets(grips, frame)
        self.clear.active = False
        solver.follow(goal, most=KEY_ITERATIONS)
        if self.deepest_cut(solver.posture, grips, frame):
            self.clear.active = True
            self.clear.place({name: vectors(path[frame]) for name, path in self.things.items()})
            solver.follow(goal, most=KEY_ITERATIONS)
        return goal

    def targets(self, grips: list[Grip], frame: int) -> Targets:
        """Where palms, head and gaze are to be at a frame."""
        palms = {
            grip.hold.side: vectors(
                self.things[grip.hold.thing][frame] * grip.pose * self.new.palms[grip.hold.side]
            )
            for grip in grips
            if grip.hold.first <= frame <= grip.hold.last
        }
        firm, head = dict.fromkeys(palms, 1.0), vectors(self.head[frame])
        return Targets(palms, firm, head, float(self.firmness[frame]), self.looks[frame])

    def _sentence(self, group: list[Hold], frame: int, metres: float, radians: float) -> str:
        at_s = self.source.times[frame]
        return (
            f"the {_sides(group)} hand cannot follow {group[0].thing!r} at {at_s:.2f} s: "
            f"it misses by {metres * 1000:.0f} mm and {np.degrees(radians):.0f} degrees"
        )

    def deepest_cut(
        self, posture: Float[np.ndarray, "posture"], grips: list[Grip], frame: int
    ) -> Pair | None:
        """The part of the body that is deepest inside a thing, but for hands in what they hold."""
        around = self.gripping.around
        around.pose(posture, {name: path[frame] for name, path in self.things.items()})
        held = {(g.hold.side, g.hold.thing) for g in grips}
        pairs = [p for p in around.near() if not _holds_it(p, held) and p.distance_m < 0.0]
        return min(pairs, default=None)

    def key_frames(self, group: list[Hold]) -> list[int]:
        """The frames at which reach is tried in some holds."""
        first, last = min(h.first for h in group), max(h.last for h in group)
        if self.only:
            return sorted(frame for frame in self.only if first <= frame <= last)
        keys = {int(frame) for frame in np.linspace(first, last, KEYS)}
        keys |= {frame for frame in self.watched if first <= frame <= last}
        for goals in self.goals.values():
            keys |= {goal.frame for goal in goals if first <= goal.frame <= last}
        return sorted(keys)


def _beside(grip: Grip) -> str:
    if grip.beside:
        both = f"{grip.hold.thing!r} together with {grip.beside!r}"
        if grip.beyond_m > 0.0:
            return (
                f"the {grip.hold.side} hand is too small to hold {both}: the middle of one of "
                f"them is {1e3 * grip.beyond_m:.0f} mm past its edge"
            )
        where = "off" if grip.gap_m > 0.0 else "inside"
        return (
            f"the {grip.hold.side} hand cannot hold {both}: where it touches {grip.beside!r} it is "
            f"{1e3 * abs(grip.gap_m):.0f} mm {where} {grip.hold.thing!r}"
        )
    where = "beside" if grip.gap_m > 0.0 else "inside"
    return (
        f"the {grip.hold.side} hand would be {where} {grip.hold.thing!r} and not on its surface, "
        f"though moved by up to {1e3 * OUT_M:.0f} mm along its palm: it has to be recorded nearer, "
        "or its palm faces elsewhere, which [hand.SIDE] with --assume states"
    )


def _sides(group: list[Hold]) -> str:
    return " and ".join(sorted({hold.side for hold in group}))


def _holds_it(pair: Pair, held: set[tuple[str, str]]) -> bool:
    side, _, part = pair.part.partition("_")
    return part in (*HAND_SEGMENTS, "thumb") and (side, pair.thing) in held


def check_stance(scene: Scene, human: Human) -> None:
    """Whoever stands at ease stands in nothing."""
    around = Surroundings(human, scene)
    solver = Solver(human, (*scene.place, scene.floor_m), scene.heading)
    around.pose(solver.rest, {name: thing.pose for name, thing in scene.things.items()})
    for pair in around.near():
        if pair.distance_m < 0.0:
            raise PlanError(
                f"standing at ({scene.place[0]:.2f}, {scene.place[1]:.2f}) m the performer's "
                f"{pair.part} is {-pair.distance_m * 1000:.0f} mm inside {pair.thing!r}; stand "
                "further back, or put it elsewhere"
            )


def check_companions(source: Source, scene: Scene, human: Human) -> None:
    """What a hand takes together stands beside each other, about as near as it did.

    Raises:
        PlanError: It stands farther apart, or inside each other.
    """
    for companion in source.companions:
        names = companion.hold.thing, companion.lead.thing
        before, now = (things_apart(where, names, human) for where in (source.scene, scene))
        said = f"{names[0]!r} stands {{}} {names[1]!r}, with which the {companion.hold.side} hand "
        larger = [where.thing(names[1]).size.max() for where in (scene, source.scene)]
        if now > before * max(larger[0] / larger[1], 1.0) + APART_M:
            told = said.format(f"{1e3 * now:.0f} mm from")
            if now >= NEAR_M:
                told = said.format(f"{1e3 * NEAR_M:.0f} mm or more from")
            raise PlanError(f"{told}takes it; it stood {1e3 * before:.0f} mm from it: put it so")
        if now < -CUT_M:
            raise PlanError(
                said.format(f"{-1e3 * now:.0f} mm inside") + "takes it: put it farther away"
            )


def _groups(holds: tuple[Hold, ...]) -> list[list[Hold]]:
    """Holds of one thing that overlap, in order of time."""
    out: list[list[Hold]] = []
    for hold in holds:
        for group in out:
            same = group[0].thing == hold.thing
            if same and any(o.first <= hold.last and hold.first <= o.last for o in group):
                group.append(hold)
                break
        else:
            out.append([hold])
    return out
