"""How the new hand lies on the new object: the same points touch, turned as little as may be."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.recording import HAND_SEGMENTS
from capar.body.scenes import Thing
from capar.body.shapes import segment_surface
from capar.model.capture import Sensor, Shape
from capar.regeneration.body_frames import BodyFrames
from capar.regeneration.collisions import Surroundings
from capar.regeneration.goals import TOUCH_M, touching_shift
from capar.regeneration.holds import led_holds
from capar.regeneration.scenes import Scene
from capar.regeneration.solving import Solver
from capar.regeneration.sources import Hold, Source, contact_points

YAWS = (0.0, 0.2, -0.2, 0.4, -0.4, 0.6, -0.6, 0.8, -0.8, 1.05, -1.05)
"""Turns about the axis of a round object that are tried, outwards positive [rad]."""

PITCHES = (0.0, 0.15, -0.15, 0.3, -0.3, 0.5, -0.5)
"""Turns about the normal of the palm that are tried [rad]."""

TILTS = (0.0, -0.1, 0.1, -0.2, 0.2, 0.3)
"""Turns across the palm, fingers to the object positive, that are tried [rad]."""

DRAWN_M = (0.03, 0.06, 0.09, 0.12)
"""How far a hand is drawn back along its fingers, so that its forearm leaves the object;
each also tilted [m]."""

DRAWN_TILTS = (0.0, -0.2, 0.2)
"""Turns across the palm that are tried with it [rad]."""

PITCH_WEIGHT, TILT_WEIGHT = 2.0, 4.0
"""How much worse these turns are than one about a round object [1]."""

OUT_M = 0.1
"""How far a recorded hand is brought to the surface of what it holds at most [m]."""

LOOSE_M = 0.003
"""A hand that is then farther off its surface or deeper inside does not take it [m]."""

CLEAR_M = 0.014
"""How far a hand stays above what the object stands on, if it did so before [m]."""

ROUND_SHARE = 0.02
"""Largest deviation of a round object's radius [1]."""


@dataclass(frozen=True)
class Turn:
    """How far a grip is turned from the recorded one."""

    yaw: float = 0.0
    """About the axis of a round object [rad]."""

    pitch: float = 0.0
    """About the normal of the palm [rad]."""

    tilt: float = 0.0
    """Across the palm, the fingers towards the object [rad]."""

    drawn_m: float = 0.0
    """How far the hand is drawn back along its fingers [m]."""

    eased: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """How it is turned besides, as the body itself would take it: about and as far as this in the
    frame on the hand [rad]."""

    @property
    def size(self) -> float:
        """How much worse than none it is [rad]."""
        return abs(self.yaw) + PITCH_WEIGHT * abs(self.pitch) + TILT_WEIGHT * abs(self.tilt)


@dataclass(frozen=True, eq=False)
class Grip:
    """Where a hand lies on an object."""

    hold: Hold
    pose: RigidTransform
    """``T_thing_hand``, the frame on the hand."""

    turn: Turn
    raised_m: float
    """How far it was raised to stay clear of what the object stands on [m]."""

    out_m: float = 0.0
    """How far it was moved off the object so that it just touches; negative towards it [m]."""

    gap_m: float = 0.0
    """How far the hand is from the object then, negative inside: none where it touches [m]."""

    beside: str = ""
    """By which other object the hand is led that it holds besides; empty where it is this one."""

    beyond_m: float = 0.0
    """How far the middle of either of two objects that are held together is past the edge of the
    hand [m]."""

    @property
    def missed_m(self) -> float:
        """How much too far the hand is from where it would hold the object [m]."""
        return max(abs(self.gap_m), LOOSE_M + self.beyond_m if self.beyond_m > 0.0 else 0.0)

    @property
    def touches(self) -> bool:
        """Whether the hand came to the surface of the object, or was too far from it or inside."""
        return self.missed_m <= LOOSE_M


def turns(thing: Thing) -> Iterator[Turn]:
    """The turns to try on an object, the smallest first."""
    yaws = YAWS if is_round(thing.shape) else YAWS[:1]
    found = [Turn(yaw, pitch) for yaw in yaws for pitch in PITCHES]
    found += [Turn(0.0, pitch, tilt) for pitch in PITCHES for tilt in TILTS[1:]]
    yield from sorted(found, key=lambda each: each.size)


def drawn_turns() -> Iterator[Turn]:
    """What is tried where an arm would be inside what its hand takes: nearer the fingertips."""
    yield from (Turn(tilt=tilt, drawn_m=drawn_m) for drawn_m in DRAWN_M for tilt in DRAWN_TILTS)


def is_round(shape: Shape) -> bool:
    """Whether a shape's outline from above is a circle about its z axis."""
    hull = trimesh.convex.convex_hull(np.array(shape.vertices))
    radii = np.linalg.norm(hull.vertices[:, :2], axis=1)
    outer = radii[radii > 0.5 * radii.max()]
    return len(outer) >= 16 and bool(np.ptp(outer) < ROUND_SHARE * radii.max())


class Gripping:
    """Grips of one body on the objects of one scene."""

    def __init__(self, source: Source, scene: Scene, old: BodyFrames, new: BodyFrames) -> None:
        self.source, self.scene, self.old, self.new = source, scene, old, new
        self.around = Surroundings(new.human, scene)
        self.posture = Solver(new.human, (*scene.place, scene.floor_m), scene.heading).rest
        holds = led_holds(source.holds, source.co_held)
        self.recorded = {hold: self._recorded(hold) for hold in holds}

    def grip(self, hold: Hold, turn: Turn) -> Grip:
        """The recorded grip in the new measures, turned, touching, and clear of the support."""
        relative, on_hand, on_thing = self.recorded[hold]
        before = self.source.scene.thing(hold.thing)
        after = self.scene.thing(hold.thing)
        track = self.source.hands[hold.side]
        point = on_hand * self.new.hands[hold.side].extents / track.frame.extents
        spot = on_thing * after.size / np.maximum(before.size, 1e-9)
        gap = relative.apply(on_hand) - on_thing
        eased = Rotation.from_rotvec(turn.eased)
        turned = relative.rotation * Rotation.from_euler("ZY", [turn.pitch, turn.tilt]) * eased
        pose = RigidTransform.from_components(spot + gap - turned.apply(point), turned)
        if is_round(after.shape):
            pose = RigidTransform.from_rotation(self._about(hold, turn)) * pose
        pose = pose * RigidTransform.from_translation([-turn.drawn_m, 0.0, 0.0])
        raised = self._raise(hold, pose)
        pose = RigidTransform.from_translation([0.0, 0.0, raised]) * pose
        out, gap = self._out(hold, pose)
        pose = pose * RigidTransform.from_translation([0.0, 0.0, -out])
        return Grip(hold, pose, turn, raised, out, gap)

    def with_co_held(self, grips: list[Grip]) -> list[Grip]:
        """The same, with how these hands lie on what they hold besides."""
        return [*grips, *(one for grip in grips for one in self._co_held(grip))]

    def _co_held(self, grip: Grip) -> Iterator[Grip]:
        for companion in self.source.co_held:
            if companion.lead == grip.hold:
                hold = companion.hold
                seat = self._seat(hold.thing, grip.hold.thing)
                pose = seat.inv() * grip.pose
                gap = self._gap(hold, pose, 0.0) - TOUCH_M
                beyond = self._beyond(grip, seat, hold.thing)
                yield replace(
                    grip, hold=hold, pose=pose, gap_m=gap, beside=grip.hold.thing, beyond_m=beyond
                )

    def _seat(self, name: str, lead: str) -> RigidTransform:
        """``T_lead_thing`` as they stand."""
        return self.scene.thing(lead).pose.inv() * self.scene.thing(name).pose

    def _beyond(self, grip: Grip, seat: RigidTransform, name: str) -> float:
        """How far the middle of either object is past the edge of the hand [m].

        Along the line on which they lie beside each other, in the plane of the palm.
        """
        local, lead = grip.pose.inv(), self.scene.thing(grip.hold.thing)
        middle = local.apply(seat.apply(self.scene.thing(name).shape.bounds.mean(axis=0)))
        first = local.apply(lead.shape.bounds.mean(axis=0))
        along = (middle - first) * [1.0, 1.0, 0.0]
        along /= max(float(np.linalg.norm(along)), 1e-9)
        own = np.array(self._hand(grip.hold.side).vertices) @ along
        return float(max(middle @ along - own.max(), own.min() - first @ along))

    def _recorded(
        self, hold: Hold
    ) -> tuple[RigidTransform, Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
        """``T_thing_hand`` and the middle of the contact on the hand's frame and on the object."""
        track = self.source.hands[hold.side]
        part = slice(hold.first, hold.last + 1)
        poses = self.source.paths[hold.thing][part].inv() * track.path[part]
        spot = np.median(poses.translation, axis=0)
        relative = RigidTransform.from_components(spot, poses.rotation.mean())
        sensor = self.source.capture.sensor(track.sensor)
        hand = _hand_shape(sensor, track.frame.pose)
        shape = self.source.scene.thing(hold.thing).shape
        on_hand, on_thing = contact_points(hand, shape, relative.inv())
        return relative, on_hand, on_thing

    def _about(self, hold: Hold, turn: Turn) -> Rotation:
        """A round object is gripped as seen from where the performer faces."""
        old, new = self.source.scene, self.scene
        facing = (new.heading - new.thing(hold.thing).heading) - (
            old.heading - old.thing(hold.thing).heading
        )
        outwards = -turn.yaw if hold.side == "right" else turn.yaw
        return Rotation.from_euler("z", facing + outwards)

    def _raise(self, hold: Hold, pose: RigidTransform) -> float:
        """How much higher the hand has to be to stay clear of what the object stands on [m]."""
        if not self.scene.support(hold.thing):
            return 0.0
        track = self.source.hands[hold.side]
        sensor = self.source.capture.sensor(track.sensor)
        shape = _hand_shape(sensor, track.frame.pose)
        before = self._above(self.source.scene, hold, self.recorded[hold][0], shape)
        own = self._hand(hold.side)
        return max(0.0, min(CLEAR_M, before) - self._above(self.scene, hold, pose, own))

    def _hand(self, side: str) -> Shape:
        """The new hand's surface in the frame on it."""
        names = tuple(f"{side}_{each}" for each in HAND_SEGMENTS)
        surface = segment_surface(self.new.human.measures, names, f"{side}_hand")
        local = self.new.hands[side].pose.inv().apply(np.array(surface.vertices))
        return Shape(local, np.array(surface.faces))

    def _above(self, scene: Scene, hold: Hold, pose: RigidTransform, hand: Shape) -> float:
        low = scene.thing(hold.thing).shape.bounds[0, 2]
        return float(pose.apply(np.array(hand.vertices))[:, 2].min() - low)

    def _out(self, hold: Hold, pose: RigidTransform) -> tuple[float, float]:
        """How far against its palm a hand is moved until it touches, and what gap is left [m]."""
        beside = [one.hold for one in self.source.co_held if one.lead == hold]
        along = [(hold, RigidTransform.identity())]
        along += [(one, self._seat(one.thing, hold.thing).inv()) for one in beside]

        def apart(by_m: float) -> float:
            return min(self._gap(one, seat * pose, by_m) for one, seat in along)

        out = touching_shift(apart, OUT_M)
        return out, self._gap(hold, pose, out) - TOUCH_M

    def _gap(self, hold: Hold, pose: RigidTransform, by_m: float) -> float:
        """How far a hand is from an object when it is moved so far against its palm [m]."""
        names = [f"{hold.side}_{each}" for each in HAND_SEGMENTS]
        away = pose * RigidTransform.from_translation([0.0, 0.0, -by_m])
        self.around.pose(self.posture, {hold.thing: self.new.rest[hold.side] * away.inv()})
        found = (p.distance_m for p in self.around.near(names) if p.thing == hold.thing)
        return min(found, default=1.0)


def _hand_shape(sensor: Sensor, frame: RigidTransform) -> Shape:
    """The recorded hand's surface in the frame on it."""
    assert sensor.shape is not None  # checked when the source was made
    return Shape(frame.inv().apply(np.array(sensor.shape.vertices)), np.array(sensor.shape.faces))
