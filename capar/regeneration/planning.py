"""Planning: key postures that show what grips miss, and where everything is at every frame."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.body.human import Human
from capar.body.recording import HAND_SEGMENTS
from capar.model.capture import TagType
from capar.model.facts import LookingAt
from capar.regeneration.body_frames import BodyFrames, body_frames, head_path
from capar.regeneration.collisions import ClearTask, Pair
from capar.regeneration.forces import first_guess, flights
from capar.regeneration.goals import Goal, object_goals
from capar.regeneration.grips import LOOSE_M, OUT_M, Grip, Gripping, Turn
from capar.regeneration.holds import led_holds
from capar.regeneration.paths import Care, ObjectPaths, hand_paths, object_paths
from capar.regeneration.scenes import Scene
from capar.regeneration.solving import Solver, Targets, vectors
from capar.regeneration.sources import Hold, Meeting, Source
from capar.regeneration.styles import Detour, Style, smoothed

FAR_M = 3.0  # Distance of the point looked at where nothing is [m].

SHIFT_S, SETTLE_S, EVENT_S = 0.3, 0.45, 0.3
"""How long a shift of gaze takes, how long the head takes to be firmly where it is to be, and how
long before and after an event a hand may be led more firmly [s]."""

REST_S, REST_M, REST_SHARE = 0.5, 0.02, 0.5
"""A hand that stays so near [m] for so long [s] rests, and how firmly it is kept there [1]."""

REACH_M, REACH_RAD = 0.0009, float(np.radians(0.9))
"""A hand that misses a goal by more cannot reach it: a little less than the gates allow."""

CUT_M = 0.001  # How deep a part of the body may be inside an object [m].

KEYS, KEY_ITERATIONS = 6, 40
"""Key postures in a hold, besides those at goals, and iterations for each [1]."""

GAINED_M = 0.09
"""Nearer to the body no turn of a grip brings the palm [m] (estimate: 42 mm on a mug)."""

FREELY = 0.003
"""Share of its weight that a palm's turning has where it is sought how the body would turn it."""

ADJUSTED_M = 0.005  # An adjustment of a grip that is reported [m].


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


def _firmness(
    source: Source, care: Care, events: Collection[int]
) -> dict[str, Float[np.ndarray, "frames"]]:
    """How firmly each hand is led [1]: in holds, more at events, less at rest when a body leans."""
    out = {}
    half = max(round(0.5 * REST_S * source.rate_hz), 1)
    mean = np.ones(2 * half + 1) / (2 * half + 1)
    for side, hand in source.hands.items():
        holds = [hold for hold in source.holds if hold.side == side]
        edges = {frame for hold in holds for frame in (hold.first, hold.last)}
        instants = [Hold(side, "", frame, frame) for frame in sorted(edges.union(events))]
        firm = around(source, holds, care.firm_s)
        firm *= 1.0 + (care.weight - 1.0) * around(source, instants, EVENT_S)
        padded = np.pad(hand.path.translation, ((half, half), (0, 0)), mode="edge")
        windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1, axis=0)
        still = (np.ptp(windows, axis=2).max(axis=1) < REST_M).astype(float)
        rests = np.convolve(np.pad(still, half, mode="edge"), mean, mode="valid")
        out[side] = np.maximum(firm, REST_SHARE * rests)
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
                part = slice(fact.first, fact.last + 1)
                points[part] = things[fact.object][part].apply(thing.shape.bounds.mean(axis=0))
    return smoothed(points, max(round(SHIFT_S * source.rate_hz) | 1, 3) // 2)


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
        paths: ObjectPaths | None = None,
    ) -> None:
        self.source, self.scene, self.style = source, scene, style
        self.old, self.new = body_frames(source.human, source.scene), body_frames(human, scene)
        if paths is None:
            goals = object_goals(source, scene, self.old, self.new, style.force)
            paths = object_paths(source, scene, goals, human, style)
        self.goals, self.notes = paths.goals, list(paths.notes)
        self.things = first_guess(source, scene, paths.paths)
        self.head = head_path(source, self.old, self.new)
        self.firmness = around(source, source.meetings, SETTLE_S)
        self.looks = looks(source, self.things, self.head)
        self.gripping = Gripping(source, scene, self.old, self.new)
        self.clear = ClearTask(self.gripping.around, source.met, source.hands)
        self.grips: tuple[Grip, ...] = ()
        self.firm = 1.0
        """How firmly hands are led in key postures, 1 being usual in a hold [1]."""

        self.postures = 0
        """How many key postures were tried."""

    def solver(self) -> Solver:
        """The body at ease, whose limbs are kept out of objects."""
        place = (*self.scene.place, self.scene.floor_m)
        return Solver(self.new.human, place, self.scene.heading, (self.clear,))

    def beyond(self) -> str:
        """What a freely turning palm misses by more than any grip gains; empty if nothing."""
        for hold in led_holds(self.source.holds, self.source.co_held):
            grips, solver = self.gripping.grips([hold], Turn()), self.solver()
            solver.turning = FREELY
            for frame in self.key_frames([hold]):
                goal = self.targets(grips, frame)
                solver.follow(goal, most=KEY_ITERATIONS)
                self.postures += 1
                missed_m, _ = solver.missed(goal)
                if missed_m > GAINED_M:
                    throws = [one for one in self.source.throws if one.thing == hold.thing]
                    thrown = any((frame, hold.side) == (one.first, one.side) for one in throws)
                    caught = any((frame, hold.side) == (one.last, one.catcher) for one in throws)
                    verb = "throw" if thrown else "catch" if caught else "follow"
                    return (
                        f"the {hold.side} hand cannot {verb} {hold.thing!r} at "
                        f"{self.source.times[frame]:.2f} s: however it is turned, it misses by "
                        f"{1e3 * missed_m:.0f} mm"
                    )
        return ""

    def missed(self, grips: list[Grip], group: list[Hold], enough: float) -> Miss:
        """How far the key postures of some holds are missed, in units of what is allowed.

        No further than is enough to be worse than another grip. A hand that does not come to the
        surface of the object has no grip.
        """
        loose = max(grips, key=lambda grip: grip.missed_m)
        if loose.missed_m > LOOSE_M:
            return Miss(1.0 + loose.missed_m / REACH_M, _why_loose(loose))
        solver, worst = self.solver(), Miss()
        sides, thing = " and ".join(sorted({hold.side for hold in group})), group[0].thing
        for frame in self.key_frames(group):
            metres, radians = solver.missed(self.follow(solver, grips, frame))
            ratio = max(metres / REACH_M, radians / REACH_RAD)
            at = f"{thing!r} at {self.source.times[frame]:.2f} s"
            if ratio > worst.ratio:
                by = f"{metres * 1000:.0f} mm and {np.degrees(radians):.0f} degrees"
                worst = Miss(ratio, f"the {sides} hand cannot follow {at}: it misses by {by}")
            pair = self._deepest_cut(solver, grips, frame)
            if pair and -pair.distance_m / CUT_M > worst.ratio:
                where = f"{pair.part} is {-1e3 * pair.distance_m:.0f} mm inside {pair.thing!r}"
                sentence = f"while the {sides} hand has {at}, {where}"
                worst = Miss(-pair.distance_m / CUT_M, sentence, pair.thing == thing)
            if ratio > enough:
                break
        return worst

    def follow(self, solver: Solver, grips: list[Grip], frame: int) -> Targets:
        """Reach for the goals of a key frame; a second time where limbs are inside something.

        From wherever the body was before, the way there may lead through objects.
        """
        goal = self.targets(grips, frame)
        self.postures += 1
        self.clear.active = False
        solver.follow(goal, most=KEY_ITERATIONS)
        if self._deepest_cut(solver, grips, frame):
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
        firm, head = dict.fromkeys(palms, self.firm), vectors(self.head[frame])
        return Targets(palms, firm, head, float(self.firmness[frame]), self.looks[frame])

    def _deepest_cut(self, solver: Solver, grips: list[Grip], frame: int) -> Pair | None:
        """The part of the body deepest inside an object, but for hands in what they hold."""
        around = self.gripping.around
        around.pose(solver.posture, {name: path[frame] for name, path in self.things.items()})
        hands = (*HAND_SEGMENTS, "thumb")
        held = {(f"{g.hold.side}_{part}", g.hold.thing) for g in grips for part in hands}
        cuts = (pair for pair in around.near() if pair.distance_m < 0.0)
        return min((pair for pair in cuts if (pair.part, pair.thing) not in held), default=None)

    def key_frames(self, group: Sequence[Hold]) -> list[int]:
        """The frames at which reach is tried in some holds."""
        first, last = min(h.first for h in group), max(h.last for h in group)
        keys = {int(frame) for frame in np.linspace(first, last, KEYS)}
        for goals in self.goals.values():
            keys |= {goal.frame for goal in goals if first <= goal.frame <= last}
        return sorted(keys)


def _why_loose(grip: Grip) -> str:
    hand, thing = f"the {grip.hold.side} hand", repr(grip.hold.thing)
    where = "off" if grip.gap_m > 0.0 else "inside"
    if grip.beside:
        why = f"is {1e3 * abs(grip.gap_m):.0f} mm {where} {thing} where it touches {grip.beside!r}"
        if grip.beyond_m > 0.0:
            why = f"ends {1e3 * grip.beyond_m:.0f} mm before the middle of one of them"
        return f"{hand} is too small to hold {thing} together with {grip.beside!r}: it {why}"
    return (
        f"{hand} would be {where} {thing} and not on its surface, though moved by up to "
        f"{1e3 * OUT_M:.0f} mm along its palm: record it nearer, or state where its palm faces, "
        "[hand.SIDE] with --assume"
    )


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


def led(draft: Draft, care: Care) -> Plan:
    """The plan of a draft with grips, and with the paths of free hands, so careful."""
    source, scene = draft.source, draft.scene
    held = {grip.hold: grip.pose for grip in draft.grips}
    hands, detours = hand_paths(
        source, scene, draft.old, draft.new, held, draft.things, care=care, style=draft.style
    )
    humans, kind = (source.human, draft.new.human), draft.style.force
    things, hands, flown = flights(source, scene, humans, draft.things, hands, kind)
    events = {goal.frame for several in draft.goals.values() for goal in several}
    reasons = [
        f"{name!r} at {source.times[goal.frame]:.2f} s: {goal.reason}"
        for name, several in draft.goals.items()
        for goal in several
    ]
    notes = (*source.notes, *_changes(draft.grips), *reasons, *draft.notes, *flown)
    return Plan(
        source, scene, draft.new.human, draft.new, draft.goals, draft.grips, detours, hands,
        draft.style, _firmness(source, care, events), things, draft.head, draft.firmness,
        draft.looks, notes,
    )  # fmt: skip


def _changes(grips: tuple[Grip, ...]) -> list[str]:
    """How each grip differs from the recorded one, in words."""
    out = []
    for grip in (one for one in grips if not one.beside):
        turn, out_m = grip.turn, grip.out_m if abs(grip.out_m) > ADJUSTED_M else 0.0
        rows = (
            (1e3 * turn.drawn_m, "{:.0f} mm back along its fingers"),
            (1e3 * out_m, "{:+.0f} mm off its surface"),
            (1e3 * round(grip.raised_m, 3), "{:.0f} mm higher"),
            (np.degrees(turn.yaw), "{:.0f} degrees about it"),
            (np.degrees(turn.pitch), "{:.0f} degrees about the palm's normal"),
            (np.degrees(turn.tilt), "{:.0f} degrees across the palm"),
        )
        changes = [text.format(value) for value, text in rows if value]
        if changes:
            hold = grip.hold
            out.append(
                f"the {hold.side} hand's grip on {hold.thing!r} is changed: {', '.join(changes)}"
            )
    return out
