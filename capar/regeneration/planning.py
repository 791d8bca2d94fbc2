"""Planning: grips that reach the goals, remedies where none does, and the planned paths."""

import itertools
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human
from capar.body.recording import HAND_SEGMENTS
from capar.model.capture import TagType
from capar.model.facts import LookingAt
from capar.regeneration.body_frames import BodyFrames, body_frames, head_path
from capar.regeneration.collisions import NEAR_M, ClearTask, Pair, Surroundings, things_apart
from capar.regeneration.forces import first_guess, flight_notes, flights
from capar.regeneration.goals import Goal, object_goals
from capar.regeneration.grips import OUT_M, Grip, Gripping, Turn, drawn_turns, turns
from capar.regeneration.holds import led_holds
from capar.regeneration.paths import Care, ObjectPaths, hand_paths, object_paths
from capar.regeneration.scenes import (
    PlanError,
    Scene,
    mobile,
    moved,
    raised,
    resized_with,
    taken_with,
)
from capar.regeneration.solving import Solver, Targets, vectors
from capar.regeneration.sources import Hold, Meeting, Source
from capar.regeneration.styles import Detour, Style, own_style

FAR_M = 3.0
"""Distance of the point looked at where nothing is [m]."""

SHIFT_S = 0.3
"""How long a shift of gaze takes [s]."""

EVENT_S = 0.3
"""How long before and after an event a hand may be led more firmly [s]."""

REST_S = 0.5
"""Over so long it is seen whether a hand rests [s]."""

REST_M, REST_SHARE = 0.02, 0.5
"""A hand that stays so near for a while rests [m], and how firmly it is kept there [1]."""


def grasps(
    source: Source, firm_s: float, events: Collection[int] = (), weight: float = 1.0
) -> dict[str, Float[np.ndarray, "frames"]]:
    """How firmly each hand is led [1]: in holds, and less so at rest beside a body that leans.

    Args:
        source: The recorded performance.
        firm_s: How long before a hold the hand is led more and more firmly [s].
        events: Frames at which objects are taken, let go, and have to be somewhere.
        weight: How firmly it is led in holds at these frames; 1 at others [1].
    """
    out = {}
    for side, hand in source.hands.items():
        holds = [hold for hold in source.holds if hold.side == side]
        firm = around(source, holds, firm_s)
        edges = {frame for hold in holds for frame in (hold.first, hold.last)}
        instants = [Hold(side, "", frame, frame) for frame in sorted(edges.union(events))]
        firm *= 1.0 + (weight - 1.0) * around(source, instants, EVENT_S)
        out[side] = np.maximum(firm, REST_SHARE * _rests(source, hand.path.translation))
    return out


def _rests(source: Source, spots: Float[np.ndarray, "frames 3"]) -> Float[np.ndarray, "frames"]:
    """One where something hardly moves for a while, smoothly falling to zero beside that."""
    half = max(round(0.5 * REST_S * source.rate_hz), 1)
    padded = np.pad(spots, ((half, half), (0, 0)), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1, axis=0)
    still = (np.ptp(windows, axis=2).max(axis=1) < REST_M).astype(float)
    mean = np.ones(2 * half + 1) / (2 * half + 1)
    smooth = np.convolve(np.pad(still, half, mode="edge"), mean, mode="valid")
    return np.asarray(smooth)


def around(
    source: Source, spans: Sequence[Hold | Meeting], settle_s: float
) -> Float[np.ndarray, "frames"]:
    """One during some spans, smoothly falling to zero on both sides of each."""
    out = np.zeros(len(source.times))
    for span in spans:
        start, end = source.times[span.first], source.times[span.last]
        away = np.maximum(np.maximum(start - source.times, source.times - end), 0.0)
        share = np.clip(1.0 - away / settle_s, 0.0, 1.0)
        out = np.maximum(out, share**3 * (10.0 - 15.0 * share + 6.0 * share**2))
    return out


def looks(
    source: Source, things: Mapping[str, RigidTransform], head: RigidTransform
) -> Float[np.ndarray, "frames 3"]:
    """The point looked at: an object that was looked at, else ahead along the line of sight."""
    points = head.translation + FAR_M * head.rotation.apply([1.0, 0.0, 0.0])
    for fact in source.observation.facts:
        if isinstance(fact, LookingAt) and fact.object in things:
            thing = source.scene.thing(fact.object)
            if thing.tag is TagType.MOBILE:
                middle = 0.5 * thing.shape.bounds.sum(axis=0)
                part = slice(fact.first, fact.last + 1)
                points[part] = things[fact.object][part].apply(middle)
    width = max(round(SHIFT_S * source.rate_hz) | 1, 3)
    window = np.hanning(width + 2)[1:-1]
    padded = np.pad(points, ((width // 2, width // 2), (0, 0)), mode="edge")
    columns = [np.convolve(c, window / window.sum(), mode="valid") for c in padded.T]
    return np.stack(columns, axis=1)


REACH_M, REACH_RAD = 0.0009, float(np.radians(0.9))
"""A hand that misses a goal by more cannot reach it: a little less than the gates allow."""

CUT_M = 0.001
"""How deep a part of the body may be inside an object [m]."""

PRESSED_M = 0.025
"""An arm that is no deeper inside what it holds presses against it: flesh gives path and the
mannequin does not. It is a last resort, reported, and fails the gate of penetration [m]."""

APART_M = 0.02
"""Objects that a hand takes together are no more than this farther apart than they were [m]."""

KEYS = 6
"""Key postures in a hold, besides those at goals."""

KEY_ITERATIONS = 40
MOST_TURNS = 24
"""Turns of a grip that are tried."""

GAINED_M = 0.09
"""Nearer to the body no turn of a grip brings the palm [m] (estimate: 42 mm on a mug)."""

FREELY = 0.003
"""Share of its weight that a palm's turning has where it is sought how the body would turn it."""

MOST_EASED_RAD = 1.05
"""So far a grip is turned at most as the body would take it [rad]."""

ROUNDS = 4
"""So often a grip is turned as the body would take it: each time the hand touches elsewhere [1]."""

SETTLE_S = 0.45
"""How long the head takes to be firmly where it is to be [s]."""


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
        ways: ObjectPaths | None = None,
    ) -> None:
        self.source, self.scene = source, scene
        self.old = body_frames(source.human, source.scene)
        self.new = body_frames(human, scene)
        if ways is None:
            goals = object_goals(source, scene, self.old, self.new, style.force)
            ways = object_paths(source, scene, goals, human, style)
        self.goals, self.things, self.told = ways.goals, ways.paths, list(ways.told)
        self.things = first_guess(source, scene, self.things)
        self.head = head_path(source, self.old, self.new)
        self.firmness = around(source, source.meetings, SETTLE_S)
        self.looks = looks(source, self.things, self.head)
        self.gripping = Gripping(source, scene, self.old, self.new)
        self.clear = ClearTask(self.gripping.around, source.met)
        self.grips: tuple[Grip, ...] = ()
        self.pressed: list[str] = []
        self.style = style

    def beyond(self) -> str:
        """What a freely turning palm misses by more than any grip gains; empty if nothing."""
        for hold in led_holds(self.source.holds, self.source.co_held):
            grips, solver = self._gripped([hold], Turn()), self._solver()
            solver.turning = FREELY
            for frame in self.key_frames([hold]):
                goal = self.targets(grips, frame)
                solver.follow(goal, most=KEY_ITERATIONS)
                missed_m = solver.missed(goal)[0]
                if missed_m > GAINED_M:
                    return (
                        f"the {hold.side} hand cannot {self._verb(hold, frame)} {hold.thing!r} at "
                        f"{self.source.times[frame]:.2f} s: however it is turned, it misses by "
                        f"{1e3 * missed_m:.0f} mm"
                    )
        return ""

    def _verb(self, hold: Hold, frame: int) -> str:
        """What a hand does at a frame with what it holds."""
        throws = [toss for toss in self.source.throws if toss.thing == hold.thing]
        if any((frame, hold.side) == (toss.first, toss.side) for toss in throws):
            return "throw"
        caught = any((frame, hold.side) == (toss.last, toss.catcher) for toss in throws)
        return "catch" if caught else "follow"

    def reachable_grips(self, most: int = MOST_TURNS) -> tuple[list[Grip], str | None]:
        """A grip for every hold, and what is missed if one has none that reaches.

        The first of these that reaches: ``most`` turns of the recorded grip, the smallest first;
        drawn back along the fingers, where the forearm is inside the object; turned as the body
        would take the object. The latter two only if all turns are tried. Where an arm presses
        against what it holds whatever the grip, that is in ``pressed``.
        """
        chosen: list[Grip] = []
        for group in _groups(led_holds(self.source.holds, self.source.co_held)):
            usual = list(turns(self.scene.thing(group[0].thing)))[:most]
            miss, grips = self._best_grips(chosen, group, usual)
            if miss.ratio > 1.0 and miss.cuts and most == MOST_TURNS:
                found = self._best_grips(chosen, group, list(drawn_turns()))
                miss, grips = min((miss, grips), found, key=lambda tried: tried[0].ratio)
            if miss.ratio > 1.0 and most == MOST_TURNS:
                found = self._eased_grips(chosen, group, miss, grips)
                miss, grips = min((miss, grips), found, key=lambda tried: tried[0].ratio)
            chosen += grips
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
        """Grips turned as the body itself would take the object; the best ones that were tried."""
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
        return self.gripping.with_co_held([self.gripping.grip(hold, turn) for hold in group])

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
        return self.gripping.with_co_held(out)

    def _missed(self, grips: list[Grip], group: list[Hold], enough: float) -> Miss:
        """How far the key postures of some holds are missed, in units of what is allowed.

        No further than is enough to be worse than another grip. A hand that does not come to the
        surface of the object has no grip.
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

        From wherever the body was before, the way there may lead through objects.
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
        """The part of the body deepest inside an object, but for hands in what they hold."""
        around = self.gripping.around
        around.pose(posture, {name: path[frame] for name, path in self.things.items()})
        held = {(g.hold.side, g.hold.thing) for g in grips}
        pairs = [p for p in around.near() if not _holds_it(p, held) and p.distance_m < 0.0]
        return min(pairs, default=None)

    def key_frames(self, group: list[Hold]) -> list[int]:
        """The frames at which reach is tried in some holds."""
        first, last = min(h.first for h in group), max(h.last for h in group)
        keys = {int(frame) for frame in np.linspace(first, last, KEYS)}
        for goals in self.goals.values():
            keys |= {goal.frame for goal in goals if first <= goal.frame <= last}
        return sorted(keys)


def _beside(grip: Grip) -> str:
    hand, thing = f"the {grip.hold.side} hand", repr(grip.hold.thing)
    where = "off" if grip.gap_m > 0.0 else "inside"
    if grip.beyond_m > 0.0:
        return (
            f"{hand} is too small to hold {thing} together with {grip.beside!r}: the middle of one "
            f"of them is {1e3 * grip.beyond_m:.0f} mm past its edge"
        )
    if grip.beside:
        return (
            f"{hand} cannot hold {thing} together with {grip.beside!r}: where it touches that, it "
            f"is {1e3 * abs(grip.gap_m):.0f} mm {where} {thing}"
        )
    return (
        f"{hand} would be {where} {thing} and not on its surface, though moved by up to "
        f"{1e3 * OUT_M:.0f} mm along its palm: record it nearer, or state where its palm faces, "
        "[hand.SIDE] with --assume"
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


def check_co_held(source: Source, scene: Scene, human: Human) -> None:
    """What a hand takes together stands beside each other, about as near as it did.

    Raises:
        PlanError: It stands farther apart, or inside each other.
    """
    for companion in source.co_held:
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
    """Holds of one object that overlap, in order of time."""
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


FEW_TURNS = 6
"""Turns of a grip that are tried where another place or a remedy is sought [1]."""

MOST_CHANGES = 24
"""So many remedies are tried at most [1]."""

STEPS_M = (
    (0.05, 0.0), (-0.05, 0.0), (0.1, 0.0), (-0.1, 0.0), (0.0, -0.1), (0.0, 0.1),
    (0.1, -0.1), (0.1, 0.1), (-0.1, -0.1), (-0.1, 0.1), (0.2, 0.0), (-0.2, 0.0),
)  # fmt: skip
"""Places that are tried, from the given one ahead and to the left [m]."""

NEARER_M = (0.05, 0.1, 0.15, 0.2, 0.3)
HIGHER_M = (0.1, -0.1, 0.2, -0.2, 0.4, -0.4)
DRAWN_M = (0.1, 0.2, 0.3)
"""Remedies that are tried where something is out of reach [m]: standing, fixed objects, others."""

SMALLER = 0.7
"""Likewise the size of what can be moved [1]."""

TALLER_M = 0.02
"""A recorded body that is so much taller is tried, too [m]."""

ADJUSTED_M = 0.005
"""An adjustment of a grip that is reported [m]."""


@dataclass(frozen=True, eq=False)
class Plan:
    """Where hands, objects, head and gaze are to be at every frame."""

    source: Source
    scene: Scene
    human: Human
    frames: BodyFrames
    goals: Mapping[str, list[Goal]]
    grips: tuple[Grip, ...]
    detours: Mapping[tuple[str, int], Detour]
    """By side and the free interval's first frame."""

    hands: Mapping[str, RigidTransform]
    """``T_world_hand`` by side at every frame, the frame on the hand."""

    style: Style
    grasps: Mapping[str, Float[np.ndarray, "frames"]]
    """How firmly each hand is kept there [1], 1 being usual in a hold."""

    things: Mapping[str, RigidTransform]
    head: RigidTransform
    firmness: Float[np.ndarray, "frames"]
    looks: Float[np.ndarray, "frames 3"]
    notes: tuple[str, ...]

    def targets(self) -> list[Targets]:
        """Where everything is to be at each frame."""
        palms = {s: vectors(path * self.frames.palms[s]) for s, path in self.hands.items()}
        head = vectors(self.head)
        return [
            Targets(
                {side: rows[frame] for side, rows in palms.items()},
                {side: float(firm[frame]) for side, firm in self.grasps.items()},
                head[frame],
                float(self.firmness[frame]),
                self.looks[frame],
            )
            for frame in range(len(head))
        ]


def reachable(
    source: Source,
    scene: Scene,
    human: Human,
    style: Style | None = None,
) -> Draft:
    """Goals, and grips that reach them, from where it stands or, unless it stays, from nearby.

    Raises:
        PlanError: Something is out of reach or cannot be put down; the message says what would
            help.
    """
    style = style or own_style(source)
    check_co_held(source, scene, human)
    pressed: Draft | None = None
    try:
        found = _draft(source, scene, human, style)
        if not found.pressed:
            return found
        pressed, why = found, found.pressed[0]
    except PlanError as error:
        why = str(error)
    for ahead_m, aside_m in () if scene.stays else STEPS_M:
        nearby = beside(scene, ahead_m, aside_m)
        if is_possible(source, nearby, human):
            found = _draft(source, nearby, human, style)
            place = f"{ahead_m:+.2f} m ahead and {aside_m:+.2f} m to its left"
            found.told.append(f"stands {place} of the given place, since there {why}")
            return found
    if pressed:
        pressed.told += [f"whatever the grip, {told}" for told in pressed.pressed]
        return pressed
    raise PlanError(f"{why}; {_remedy(source, scene, human)}")


def why_unreachable(source: Source, scene: Scene, human: Human, style: Style) -> str | None:
    """Why a body does not come to every goal from just there; None where it does."""
    try:
        found = _draft(source, scene, human, style)
    except PlanError as error:
        return str(error)
    return found.pressed[0] if found.pressed else None


def is_possible(source: Source, scene: Scene, human: Human, most: int = FEW_TURNS) -> bool:
    """Whether a body comes to every goal from just there, with few turns of its grips tried."""
    try:
        check_stance(scene, human)
        draft = Draft(source, scene, human, own_style(source))
        if draft.beyond():
            return False
        return draft.reachable_grips(most)[1] is None and not draft.pressed
    except PlanError:
        return False


def led(draft: Draft, care: Care) -> Plan:
    """A plan with the paths of free hands, so careful."""
    source, scene = draft.source, draft.scene
    held = {grip.hold: grip.pose for grip in draft.grips}
    hands, detours = hand_paths(
        source, scene, draft.old, draft.new, held, draft.things, care=care, style=draft.style
    )
    humans, kind = (source.human, draft.new.human), draft.style.force
    things, hands, launched = flights(source, scene, humans, draft.things, hands, kind)
    events = {goal.frame for several in draft.goals.values() for goal in several}
    firm = grasps(source, care.firm_s, events, care.weight)
    return Plan(
        source, scene, draft.new.human, draft.new, draft.goals, draft.grips, detours, hands,
        draft.style, firm, things, draft.head, draft.firmness, draft.looks,
        (*_notes(source, draft.grips, draft.goals), *draft.told, *flight_notes(source, launched)),
    )  # fmt: skip


def _draft(source: Source, scene: Scene, human: Human, style: Style) -> Draft:
    check_stance(scene, human)
    draft = Draft(source, scene, human, style)
    grips, out_of_reach = draft.reachable_grips(1)
    if out_of_reach is not None or draft.pressed:
        if missed := draft.beyond():
            raise PlanError(missed)
        draft.pressed.clear()
        grips, out_of_reach = draft.reachable_grips()
    if out_of_reach is not None:
        raise PlanError(out_of_reach)
    draft.grips = tuple(grips)
    return draft


def beside(scene: Scene, ahead_m: float, aside_m: float) -> Scene:
    """The scene with the performer standing so far ahead and to the left of there [m]."""
    ahead = np.array([np.cos(scene.heading), np.sin(scene.heading)])
    left = np.array([-ahead[1], ahead[0]])
    x, y = np.asarray(scene.place) + ahead_m * ahead + aside_m * left
    return replace(scene, place=(float(x), float(y)))


def _remedy(source: Source, scene: Scene, human: Human) -> str:
    """What would make it possible."""
    for words, changed, body in itertools.islice(_remedies(source, scene, human), MOST_CHANGES):
        if is_possible(source, changed, body):
            return f"{words} would do"
    return "no other height, size, nearer place or recorded body that was tried would do"


def _remedies(source: Source, scene: Scene, human: Human) -> Iterator[tuple[str, Scene, Human]]:
    """What may help, in words, and the scene and the body with it."""
    fixed = [name for name, thing in scene.things.items() if thing.tag is TagType.FIXED]
    levels = {
        f"{name!r} {abs(by_m):.1f} m {'higher' if by_m > 0 else 'lower'}": raised(scene, name, by_m)
        for name in fixed
        for by_m in HIGHER_M
    }
    for by_m in NEARER_M if scene.stays else ():
        yield f"standing {by_m:.2f} m further ahead", beside(scene, by_m, 0.0), human
    for words, level in levels.items():
        yield words, level, human
    nearer = "what can be moved {:.1f} m nearer to the performer"
    for by_m in DRAWN_M:
        yield nearer.format(by_m), _drawn_nearer(scene, by_m), human
    for name in mobile(scene):
        words = " and ".join(repr(one) for one in (name, *taken_with(scene, name)))
        smaller = resized_with(scene, name, SMALLER)
        yield f"{words} of {SMALLER:.1f} times the size", smaller, human
    recorded_m, own_m = (body.measures["stature"] for body in (source.human, human))
    if recorded_m > own_m + TALLER_M:
        yield f"a body as tall as the recorded one, {recorded_m:.2f} m,", scene, source.human
    for words, level in levels.items():
        both = f"{words} and {nearer.format(DRAWN_M[1])}"
        yield both, _drawn_nearer(level, DRAWN_M[1]), human


def _drawn_nearer(scene: Scene, by_m: float) -> Scene:
    """The scene with what can be moved nearer to where the performer stands."""
    for name in mobile(scene):
        thing = scene.thing(name)
        x, y, z = thing.place
        back = (x - by_m * np.cos(scene.heading), y - by_m * np.sin(scene.heading), z)
        scene = moved(scene, name, back, thing.heading)
    return scene


def _notes(
    source: Source, grips: tuple[Grip, ...], goals: Mapping[str, list[Goal]]
) -> tuple[str, ...]:
    out = list(source.notes)
    for grip in (one for one in grips if not one.beside):
        turn, rows = grip.turn, list[tuple[float, str]]()
        rows.append((1e3 * turn.drawn_m, "{:.0f} mm back along its fingers"))
        if abs(grip.out_m) > ADJUSTED_M:
            rows.append((1e3 * grip.out_m, "{:+.0f} mm off its surface"))
        rows.append((1e3 * round(grip.raised_m, 3), "{:.0f} mm higher"))
        angles = (turn.yaw, turn.pitch, turn.tilt, float(np.linalg.norm(turn.eased)))
        names = ("about it", "about the palm's normal", "across the palm", "as the body takes it")
        rows += [
            (float(np.degrees(angle)), f"{{:.0f}} degrees {name}")
            for angle, name in zip(angles, names, strict=True)
        ]
        changes = [text.format(value) for value, text in rows if value]
        if changes:
            hold = grip.hold
            out.append(
                f"the {hold.side} hand's grip on {hold.thing!r} is changed: {', '.join(changes)}"
            )
    for name, several in goals.items():
        out += [f"{name!r} at {source.times[g.frame]:.2f} s: {g.reason}" for g in several]
    return tuple(out)
