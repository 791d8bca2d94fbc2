"""From a recorded performance to what another body is to do in another scene."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.body.human import Human
from capar.body.recording import HAND_SEGMENTS
from capar.model.capture import TagType
from capar.regeneration import attending
from capar.regeneration.body_frames import BodyFrames, body_frames, head_path
from capar.regeneration.collisions import Pair, Surroundings
from capar.regeneration.errors import PlanError
from capar.regeneration.grips import Grip, Gripping, Turn, turns
from capar.regeneration.hand_paths import hand_paths
from capar.regeneration.path_mapping import Detour
from capar.regeneration.scenes import Scene, raised
from capar.regeneration.solving import Solver, Targets
from capar.regeneration.sources import Hold, Source
from capar.regeneration.thing_paths import Goal, thing_goals, thing_paths

REACH_M, REACH_RAD = 0.0009, float(np.radians(0.9))
"""A hand that misses a goal by more cannot reach it: a little less than the gates allow."""

CUT_M = 0.001
"""How deep a part of the body may be inside a thing [m]."""

KEYS = 6
"""Key postures in a hold, besides those at goals."""

KEY_ITERATIONS = 40
MOST_TURNS = 90
"""Turns of a grip that are tried."""

FEW_TURNS = 6
"""Likewise where a remedy is sought."""

SETTLE_S = 0.45
"""How long the head takes to be firmly where it is to be [s]."""

NEARER_M = (0.05, 0.1, 0.15, 0.2, 0.3)
HIGHER_M = (0.1, -0.1, 0.2, -0.2)
"""Remedies that are tried where something is out of reach [m]."""


@dataclass(frozen=True, eq=False)
class Plan:
    """Where hands, things, head and gaze are to be at every frame."""

    source: Source
    scene: Scene
    human: Human
    frames: BodyFrames
    goals: Mapping[str, list[Goal]]
    grips: tuple[Grip, ...]
    detours: Mapping[tuple[str, int], Detour]
    """By side and the free stretch's first frame."""

    hands: Mapping[str, RigidTransform]
    """``T_world_hand`` by side at every frame, the frame on the hand."""

    grasps: Mapping[str, Float[np.ndarray, "frames"]]
    """How firmly each hand is kept there [1]."""

    things: Mapping[str, RigidTransform]
    head: RigidTransform
    firmness: Float[np.ndarray, "frames"]
    looks: Float[np.ndarray, "frames 3"]
    notes: tuple[str, ...]

    def targets(self, frame: int) -> Targets:
        """Where everything is to be at a frame."""
        palms = {s: path[frame] * self.frames.palms[s] for s, path in self.hands.items()}
        grasps = {side: float(firm[frame]) for side, firm in self.grasps.items()}
        return Targets(
            palms, grasps, self.head[frame], float(self.firmness[frame]), self.looks[frame]
        )


def plan(source: Source, scene: Scene, human: Human, *, margin_m: float = 0.012) -> Plan:
    """Decide what a body is to do, before anything moves.

    Args:
        source: The recorded performance.
        scene: Where it is performed.
        human: Who performs.
        margin_m: How far free hands keep from what they do not touch [m].

    Raises:
        PlanError: Something is out of reach or cannot be put down; the message says what would
            help.
    """
    _check_stance(scene, human)
    draft = _Draft(source, scene, human)
    grips, missed = draft.reachable_grips()
    if missed is not None:
        raise PlanError(f"{missed}; {_remedy(source, scene, human)}")
    held = {grip.hold: grip.pose for grip in grips}
    hands, detours = hand_paths(
        source, scene, draft.old, draft.new, held, draft.things, margin_m=margin_m
    )
    return Plan(
        source, scene, human, draft.new, draft.goals, tuple(grips), detours, hands,
        attending.grasps(source), draft.things, draft.head, draft.firmness, draft.looks,
        _notes(source, grips, draft.goals),
    )  # fmt: skip


class _Draft:
    """A plan whose grips are still open."""

    def __init__(self, source: Source, scene: Scene, human: Human) -> None:
        self.source, self.scene = source, scene
        self.old = body_frames(source.human, source.scene)
        self.new = body_frames(human, scene)
        self.goals = thing_goals(source, scene, self.old, self.new)
        self.things = thing_paths(source, scene, self.goals)
        self.head = head_path(source, self.old, self.new)
        self.firmness = attending.around(source, source.meetings, SETTLE_S)
        self.looks = attending.looks(source, self.things, self.head)
        self.gripping = Gripping(source, scene, self.old, self.new)

    def reachable_grips(self, most: int = MOST_TURNS) -> tuple[list[Grip], str | None]:
        """A grip for every hold with the least turn that reaches; what is missed if none does."""
        chosen: list[Grip] = []
        for group in _groups(self.source.holds):
            best, found = None, False
            options = turns(self.scene.thing(group[0].thing))
            for turn in list(options)[:most]:
                grips = [self.gripping.grip(hold, turn) for hold in group]
                enough = np.inf if best is None else max(best[0][0], 1.0)
                miss = self._missed(chosen + grips, group, enough)
                if best is None or miss[0] < best[0][0]:
                    best = (miss, grips)
                if miss[0] <= 1.0:
                    found = True
                    break
            assert best is not None
            chosen += best[1]
            if not found:
                return chosen, best[0][1]
        return chosen, None

    def _missed(self, grips: list[Grip], group: list[Hold], enough: float) -> tuple[float, str]:
        """How far the key postures of some holds are missed, in units of what is allowed.

        No further than is enough to be worse than another grip.
        """
        solver = Solver(self.new.human, (*self.scene.place, self.scene.floor_m), self.scene.heading)
        worst = (0.0, "")
        for frame in self._keys(group):
            palms = {
                grip.hold.side: self.things[grip.hold.thing][frame]
                * grip.pose
                * self.new.palms[grip.hold.side]
                for grip in grips
                if grip.hold.first <= frame <= grip.hold.last
            }
            firm = dict.fromkeys(palms, 1.0)
            goal = Targets(
                palms, firm, self.head[frame], float(self.firmness[frame]), self.looks[frame]
            )
            solver.follow(goal, most=KEY_ITERATIONS)
            metres, radians = solver.missed(goal)
            ratio = max(metres / REACH_M, radians / REACH_RAD)
            if ratio > worst[0]:
                worst = (ratio, self._sentence(group, frame, metres, radians))
            pair = self._cut(solver, grips, frame)
            if pair and -pair.distance_m / CUT_M > worst[0]:
                depth, sides = -pair.distance_m, _sides(group)
                worst = (
                    depth / CUT_M,
                    f"while the {sides} hand has {group[0].thing!r} at "
                    f"{self.source.times[frame]:.2f} s, {pair.part} is {1e3 * depth:.0f} mm inside "
                    f"{pair.thing!r}",
                )
            if ratio > enough:
                break
        return worst

    def _sentence(self, group: list[Hold], frame: int, metres: float, radians: float) -> str:
        at_s = self.source.times[frame]
        return (
            f"the {_sides(group)} hand cannot follow {group[0].thing!r} at {at_s:.2f} s: "
            f"it misses by {metres * 1000:.0f} mm and {np.degrees(radians):.0f} degrees"
        )

    def _cut(self, solver: Solver, grips: list[Grip], frame: int) -> Pair | None:
        """The part of the body that is deepest inside a thing, but for hands in what they hold."""
        around = self.gripping.around
        around.pose(solver.posture, {name: path[frame] for name, path in self.things.items()})
        held = {(g.hold.side, g.hold.thing) for g in grips}
        pairs = [p for p in around.near() if not _holds_it(p, held) and p.distance_m < 0.0]
        return min(pairs, default=None)

    def _keys(self, group: list[Hold]) -> list[int]:
        first, last = min(h.first for h in group), max(h.last for h in group)
        keys = {int(each) for each in np.linspace(first, last, KEYS)}
        for goals in self.goals.values():
            keys |= {goal.frame for goal in goals if first <= goal.frame <= last}
        return sorted(keys)


def _sides(group: list[Hold]) -> str:
    return " and ".join(sorted({hold.side for hold in group}))


def _holds_it(pair: Pair, held: set[tuple[str, str]]) -> bool:
    side, _, part = pair.part.partition("_")
    return part in (*HAND_SEGMENTS, "thumb") and (side, pair.thing) in held


def _check_stance(scene: Scene, human: Human) -> None:
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


def _remedy(source: Source, scene: Scene, human: Human) -> str:
    """What would make it possible."""
    ahead = np.array([np.cos(scene.heading), np.sin(scene.heading)])
    for by_m in NEARER_M:
        x, y = np.asarray(scene.place) + by_m * ahead
        if _possible(source, replace(scene, place=(float(x), float(y))), human):
            return f"standing {by_m:.2f} m further ahead would do"
    for name in [n for n, t in scene.things.items() if t.tag is TagType.FIXED]:
        for by_m in HIGHER_M:
            if _possible(source, raised(scene, name, by_m), human):
                way = "higher" if by_m > 0 else "lower"
                return f"{name!r} {abs(by_m):.1f} m {way} would do"
    return "a larger body, or things nearer to it, would do"


def _possible(source: Source, scene: Scene, human: Human) -> bool:
    try:
        _check_stance(scene, human)
        return _Draft(source, scene, human).reachable_grips(FEW_TURNS)[1] is None
    except PlanError:
        return False


def _notes(source: Source, grips: list[Grip], goals: Mapping[str, list[Goal]]) -> tuple[str, ...]:
    out = list(source.notes)
    for grip in grips:
        if grip.turn != Turn():
            out.append(
                f"the {grip.hold.side} hand's grip on {grip.hold.thing!r} is turned by "
                f"{np.degrees(grip.turn.yaw):.0f} degrees about it, "
                f"{np.degrees(grip.turn.pitch):.0f} degrees about the palm's normal and "
                f"{np.degrees(grip.turn.tilt):.0f} degrees across the palm"
            )
        if grip.raised_m > 0.0005:
            higher = f"{grip.raised_m * 1000:.0f} mm higher"
            out.append(
                f"the {grip.hold.side} hand takes {grip.hold.thing!r} {higher}, to stay clear of "
                "what it stands on"
            )
    for name, several in goals.items():
        out += [f"{name!r} at {source.times[g.frame]:.2f} s: {g.reason}" for g in several]
    return tuple(out)
