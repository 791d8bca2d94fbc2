"""What a timed telling says of places and times, against the capture itself: numbers, no rules."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float
from told_claims import Claim, claims

from capar.model.capture import Capture, Sensor, TagObject
from capar.model.geometry import rotations

SLACK_S = 0.3
"""A told time may be so far [s] from what is measured: people tell it no more closely."""

BEGUN, DONE = 0.1, 0.9
"""Before a told start at most this share of the way is done, after a told end at least this one."""

NEAR_M = 0.3
"""A hand that has a thing is no further than this [m] from it: markers sit up to 0.16 m off."""

FLOOR_M = 0.03
"""What is stated to be lower than this [m] is the floor of a box, whose rim is not known."""

GOES_MPS, UNTOLD_M = 0.1, 0.1
"""What goes faster than this [m/s], and so far on end [m], is seen to go."""

STEP_M, FALLEN_M, RISEN_M = 0.2, 0.02, 0.03
"""What walks, comes down and rises goes so far at least [m]."""


@dataclass(frozen=True)
class Checked:
    """What was compared of a claim, and what contradicts it."""

    claim: Claim
    compared: int
    wrong: tuple[str, ...]


@dataclass
class Numbers:
    """Bodies of a capture over time, by name: places, ways of turning, heights."""

    capture: Capture
    times: Float[np.ndarray, "frames"] = field(init=False)
    _surfaces: dict[str, np.ndarray] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        """Take the times."""
        self.times = self.capture.times

    def streams(self) -> Mapping[str, Sensor | TagObject]:
        """Every body by its name; a hand also by what it is called."""
        found: dict[str, Sensor | TagObject] = {}
        found.update((thing.name, thing) for thing in self.capture.objects)
        found.update((sensor.name, sensor) for sensor in self.capture.sensors)
        for sensor in self.capture.sensors:
            if sensor.end_effector == "hand":
                found[f"{sensor.side} hand"] = sensor
            found.setdefault(sensor.end_effector, sensor)
        return found

    def surface(self, name: str) -> Float[np.ndarray, "frames vertices 3"]:
        """World places of some vertices of a body, or of its origin [m]."""
        if name not in self._surfaces:
            body = self.streams()[name]
            stream, shape = body.stream, body.shape
            corners = np.zeros((1, 3))
            if shape is not None:
                step = max(len(shape.vertices) // 150, 1)
                corners = np.asarray(shape.vertices)[::step]
            known = ~np.isnan(stream.positions).any(axis=1)
            out = np.full((len(stream.positions), len(corners), 3), np.nan)
            turned = rotations(stream.orientations[known]).as_matrix()
            out[known] = np.einsum("fij,vj->fvi", turned, corners)
            out[known] += stream.positions[known][:, None]
            self._surfaces[name] = out
        return self._surfaces[name]

    def middle(self, name: str) -> Float[np.ndarray, "frames 3"]:
        """Where the middle of a body is [m]."""
        surface = self.surface(name)
        return 0.5 * (surface.min(axis=1) + surface.max(axis=1))

    def origin(self, name: str) -> Float[np.ndarray, "frames 3"]:
        """Where the origin of a body is [m]."""
        return np.asarray(self.streams()[name].stream.positions)

    def lowest(self, name: str) -> Float[np.ndarray, "frames"]:
        """How high its lowest part is [m]."""
        return self.surface(name)[..., 2].min(axis=1)

    def spin(self, name: str) -> Float[np.ndarray, "frames"]:
        """How far it has turned about the vertical [rad]."""
        orientations = self.streams()[name].stream.orientations
        known = np.flatnonzero(~np.isnan(orientations).any(axis=1))
        turned = rotations(orientations[known])
        steps = (turned[1:] * turned[:-1].inv()).as_rotvec()[:, 2]
        return np.interp(np.arange(len(orientations)), known, np.r_[0.0, np.cumsum(steps)])

    def turned(self, name: str) -> Float[np.ndarray, "frames"]:
        """How far it has turned along its way, about any axis [rad]."""
        orientations = self.streams()[name].stream.orientations
        known = np.flatnonzero(~np.isnan(orientations).any(axis=1))
        turned = rotations(orientations[known])
        steps = (turned[1:] * turned[:-1].inv()).magnitude()
        return np.interp(np.arange(len(orientations)), known, np.r_[0.0, np.cumsum(steps)])

    def up(self, name: str) -> Float[np.ndarray, "frames"]:
        """How far it leans from how it stood at first [rad]."""
        orientations = self.streams()[name].stream.orientations
        known = ~np.isnan(orientations).any(axis=1)
        out = np.full(len(orientations), np.nan)
        turned = rotations(orientations[known])
        axis = turned[:1].inv().apply([[0.0, 0.0, 1.0]])[0]
        out[known] = np.arccos(np.clip(turned.apply(axis)[:, 2], -1.0, 1.0))
        return out

    def turned_to(self, name: str, start_s: float, end_s: float) -> Float[np.ndarray, "frames"]:
        """The share of how it is turned from a time to another that is done in each frame [1].

        By whole orientations: what leans yet has not got there.
        """
        stream = self.streams()[name].stream  # type: ignore[attr-defined]
        known = ~np.isnan(stream.orientations).any(axis=1)
        turned = rotations(stream.orientations[known])
        first, last = (int(np.argmin(np.abs(self.times[known] - at))) for at in (start_s, end_s))
        left = (turned[last].inv() * turned).magnitude()
        out = np.full(len(known), np.nan)
        out[known] = 1.0 - left / max(float(left[first]), 1e-6)
        return out

    def apart(self, one: str, other: str) -> Float[np.ndarray, "frames"]:
        """How far the nearest parts of two bodies are apart at most [m]."""
        first, second = self.surface(one)[:, ::3], self.surface(other)[:, ::3]
        return np.array(
            [
                np.linalg.norm(a[:, None] - b[None], axis=2).min()
                for a, b in zip(first, second, strict=True)
            ]
        )

    def at(self, values: np.ndarray, time_s: float) -> np.ndarray:
        """The values in the frame nearest to a time."""
        return values[int(np.argmin(np.abs(self.times - time_s)))]

    def during(self, values: np.ndarray, start_s: float, end_s: float) -> np.ndarray:
        """The values of the frames of a time in which the body was seen."""
        found = values[(self.times >= start_s - 1e-6) & (self.times <= end_s + 1e-6)]
        return found[~np.isnan(found).any(axis=tuple(range(1, found.ndim)))]


Check = Callable[[Claim, Numbers], Iterator[tuple[str, bool]]]


def _progress(values: np.ndarray, start: float, end: float) -> np.ndarray:
    return (values - start) / (end - start if end != start else np.inf)


def _ends(
    numbers: Numbers, done: np.ndarray, claim: Claim, *, start: bool = True, end: bool = True
) -> Iterator[tuple[str, bool]]:
    """Whether a way, of which a share is done in each frame, begins and ends as it is told."""
    a, b = claim.start_s, claim.end_s
    if start:
        before, after = numbers.at(done, a - SLACK_S), numbers.at(done, a + SLACK_S)
        yield f"start: {before:.0%} done {SLACK_S} s before", not before > BEGUN
        yield f"start: {after:.1%} done {SLACK_S} s after", not after < 0.01
    if end:
        before, after = numbers.at(done, b - SLACK_S), numbers.at(done, b + SLACK_S)
        yield f"end: {after:.0%} done {SLACK_S} s after", not after < DONE
        yield f"end: {before:.1%} done {SLACK_S} s before", not before > 0.99


def _held(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    """Whether the hands are at the thing."""
    for side in claim.hands:
        name = f"{side} hand"
        if not claim.thing or name not in numbers.streams():
            continue
        apart = numbers.during(numbers.apart(name, claim.thing), claim.start_s, claim.end_s)
        if len(apart):
            far_m = float(np.median(apart))
            yield f"{name} {far_m:.2f} m from {claim.thing}", far_m < NEAR_M


def _lifted(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    heights = numbers.middle(claim.thing)[:, 2]
    before = numbers.during(heights, claim.start_s - 0.6, claim.start_s)
    after = numbers.during(heights, claim.start_s, claim.end_s + SLACK_S)
    if len(before) and len(after):
        rise_m = float(after.max() - before[0])
        yield f"rises by {rise_m:.2f} m", rise_m > RISEN_M
        late = float(numbers.at(heights, claim.start_s) - before.min())
        yield f"{late:.2f} m up at the start", late < max(0.3 * rise_m, 0.05)
        soon = float(numbers.at(heights, claim.start_s + SLACK_S) - before.min())
        yield f"{soon:.3f} m up {SLACK_S} s after the start", soon > 0.003
    yield from _held(claim, numbers)


def _put(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    places = numbers.middle(claim.thing)
    a, b = claim.start_s, claim.end_s
    after = numbers.during(places, b + SLACK_S, b + SLACK_S + 0.4)
    if len(after) > 2:
        gone_m = float(np.linalg.norm(after - after[0], axis=1).max())
        yield f"goes {gone_m:.2f} m after the end", gone_m < 0.06
    moving = numbers.during(places, b - SLACK_S, b + 0.1)
    if len(moving) > 2:
        gone_m = float(np.linalg.norm(moving - moving[-1], axis=1).max())
        yield f"goes {gone_m:.3f} m before the end", gone_m > 0.004
    during = numbers.during(places, a, b)
    if len(during) > 2:
        way_m = float(np.linalg.norm(during - during[-1], axis=1).max())
        yield f"goes {way_m:.2f} m", way_m > FALLEN_M
    if "its place" in claim.said:
        home_m = float(np.linalg.norm((numbers.at(places, b) - places[0])[:2]))
        yield f"{home_m:.2f} m from where it was", home_m < 0.25
    if claim.goal:
        yield from _at_goal(claim, numbers)
    yield from _held(replace(claim, spans=((a, max(b - SLACK_S, a)),)), numbers)


def _at_goal(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    """Whether the thing is over the goal at the end."""
    places = numbers.during(numbers.middle(claim.thing), claim.end_s - 0.5, claim.end_s + 0.5)
    corners = numbers.surface(claim.goal)
    corners = corners[~np.isnan(corners).any(axis=(1, 2))][0]
    if not len(places):
        return
    low, high = corners.min(axis=0), corners.max(axis=0)
    if len(corners) == 1:
        low, high = low - 0.3, high + 0.3
    place = places[-1]
    over = bool(((place > low - 0.05) & (place < high + 0.05))[:2].all())
    yield f"over the {claim.goal}", over
    if " in " in claim.said and high[2] - low[2] > FLOOR_M:
        yield f"below the rim of the {claim.goal}", bool(place[2] < high[2] + 0.1)


def _carried(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    places = numbers.during(numbers.middle(claim.thing), claim.start_s, claim.end_s)
    low = numbers.lowest(claim.thing)
    way_m = float(np.linalg.norm((places - places[0])[:, :2], axis=1).max())
    yield f"carried over {way_m:.2f} m", way_m > STEP_M
    off_m = float(np.median(numbers.during(low, claim.start_s, claim.end_s))) - float(
        np.nanmin(low)
    )
    yield f"{off_m:.2f} m off the floor", off_m > 0.01
    if " at a tilt" in claim.said:
        lean = float(np.median(numbers.during(numbers.up(claim.thing), claim.start_s, claim.end_s)))
        yield f"leans {np.degrees(lean):.0f} degrees", 0.35 < lean < 2.4
    yield from _held(claim, numbers)


def _slid(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    places, low = numbers.middle(claim.thing), numbers.lowest(claim.thing)
    own = numbers.during(places, claim.start_s, claim.end_s)
    way_m = float(np.linalg.norm((own - own[0])[:, :2], axis=1).max())
    yield f"goes {way_m:.2f} m", way_m > FALLEN_M / 2.0
    if "along the floor" in claim.said:
        off_m = float(np.quantile(numbers.during(low, claim.start_s, claim.end_s), 0.9))
        yield f"lowest part {off_m - float(np.nanmin(low)):.2f} m up", off_m - np.nanmin(low) < 0.06
    done = _way_done(numbers, places, claim)
    yield from _ends(numbers, done, claim)
    if claim.said.startswith("pull") and claim.hands:
        ahead = _ahead_m(claim, numbers, places)
        yield f"hands {ahead:.2f} m ahead", ahead > 0.0
    yield from _held(claim, numbers)


def _way_done(numbers: Numbers, places: np.ndarray, claim: Claim) -> np.ndarray:
    """The share of its path that a body has done in each frame, of a time about the claim."""
    steps = np.r_[0.0, np.linalg.norm(np.nan_to_num(np.diff(places, axis=0)), axis=1)]
    path = np.cumsum(steps)
    first = float(numbers.at(path, claim.start_s - 0.6))
    last = float(numbers.at(path, claim.end_s + 0.6))
    return _progress(path, first, max(last, first + 1e-6))


def _ahead_m(claim: Claim, numbers: Numbers, places: np.ndarray) -> float:
    own = numbers.during(places, claim.start_s, claim.end_s)[:, :2]
    way = own[-1] - own[0]
    leads = [
        np.median(
            (
                numbers.during(numbers.origin(f"{side} hand"), claim.start_s, claim.end_s)[:, :2]
                - own
            )
            @ way
        )
        for side in claim.hands
    ]
    return float(min(leads) / max(np.linalg.norm(way), 1e-6))


def _turned(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    if "upside down" in claim.said or "upright" in claim.said:
        lean = numbers.up(claim.thing)
        a, b = (float(numbers.at(lean, time_s)) for time_s in (claim.start_s, claim.end_s))
        over = "upside down" in claim.said
        yield (
            f"leans {np.degrees(a):.0f} to {np.degrees(b):.0f} degrees",
            (a < 0.9 and b > 2.2) if over else b < 0.9 < a,
        )
        final = float(numbers.at(lean, claim.end_s + 0.5))
        done = _progress(lean, a, b if over else min(b, final))
        yield from _ends(numbers, done, claim, end=False)
        return
    if "from side to side" in claim.said:
        ways = np.degrees(numbers.during(numbers.spin(claim.thing), claim.start_s, claim.end_s))
        yield f"turns over {np.ptp(ways):.0f} degrees", float(np.ptp(ways)) > 60.0
        yield from _held_up(claim, numbers)
        return
    aside = " about" in claim.said and "a quarter" not in claim.said
    if aside or "bit by bit" in claim.said:
        turned = numbers.turned(claim.thing)
        way = float(numbers.at(turned, claim.end_s) - numbers.at(turned, claim.start_s))
        yield f"turns by {np.degrees(way):.0f} degrees", way > 1.0
        yield from _held(claim, numbers)
        return
    spin = numbers.spin(claim.thing)
    first, last = numbers.at(spin, claim.start_s - 0.6), numbers.at(spin, claim.end_s + 0.6)
    net = float(last - first)
    lower, upper = (
        (45, 135)
        if "a quarter" in claim.said
        else (110, 250)
        if "around" in claim.said
        else (25, 75)
    )
    yield f"turned by {np.degrees(net):.0f} degrees", lower < abs(np.degrees(net)) < upper
    if claim.timed:
        done = _progress(spin, float(first), float(last))
        whole = numbers.turned_to(claim.thing, claim.start_s - 0.6, claim.end_s + 0.6)
        stays = np.minimum(done, 2.0 - done)
        before = float(np.fmin(numbers.at(stays, claim.end_s - SLACK_S),
                               numbers.at(whole, claim.end_s - SLACK_S)))  # fmt: skip
        after = float(numbers.at(stays, claim.end_s + SLACK_S))
        yield from _ends(numbers, done, claim, end=False)
        yield f"end: {after:.0%} done {SLACK_S} s after", not after < DONE
        yield f"end: {before:.1%} done {SLACK_S} s before", not before > 0.99
    yield from _held(claim, numbers)


def _left_turned(steps: Sequence[Checked], numbers: Numbers) -> Iterator[tuple[int, str]]:
    """Turns after which a thing turns on, with no further step of it told: by place in the text."""
    for place, step in enumerate(steps):
        claim = step.claim
        turned = re.match(r"turn(?:ed|ing) .*(?:around|quarter)", claim.said) and claim.timed
        own = [other.claim for other in steps if other.claim.thing == claim.thing]
        if not turned or any(other.end_s > claim.end_s + SLACK_S for other in own):
            continue
        done = numbers.turned_to(claim.thing, claim.start_s - 0.6, float(numbers.times[-1]))
        after = float(numbers.at(done, claim.end_s + SLACK_S))
        if after < DONE:
            yield place, f"{after:.0%} of the whole turn done {SLACK_S} s after the end"


def _untold(steps: Sequence[Checked], numbers: Numbers) -> Iterator[tuple[int, str]]:
    """Times in which a thing goes, and no step of it is told: by place of the last step of it."""
    for thing in {step.claim.thing for step in steps} & set(numbers.streams()):
        own = [place for place, step in enumerate(steps) if step.claim.thing == thing]
        tools = [step.claim for step in steps if step.claim.said.startswith("stirred")]
        if getattr(numbers.streams()[thing], "tag", "") != "mobile":
            continue
        places = numbers.middle(thing)
        ways = np.r_[0.0, np.linalg.norm(np.nan_to_num(np.diff(places, axis=0)), axis=1)]
        for claim in (*(steps[place].claim for place in own), *tools):
            for start_s, end_s in claim.spans:
                near = (numbers.times > start_s - SLACK_S) & (numbers.times < end_s + SLACK_S)
                ways[near] = 0.0
        speeds = ways / np.gradient(numbers.times)
        going = np.flatnonzero(np.diff(np.r_[0, (speeds > GOES_MPS).astype(int), 0]))
        for first, after in zip(going[::2], going[1::2], strict=True):
            way_m = float(ways[first:after].sum())
            if way_m > UNTOLD_M:
                spoken = f"{numbers.times[first]:.2f} to {numbers.times[after - 1]:.2f} s"
                yield own[-1], f"{thing} goes {way_m:.2f} m from {spoken}, untold"


def _bent(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    heights = numbers.origin("head")[:, 2]
    a, b = claim.start_s, claim.end_s
    rises = claim.said.startswith(("straight", "stood", "began"))
    sign = 1.0 if rises else -1.0
    fall_m = sign * float(numbers.at(heights, b) - numbers.at(heights, a))
    yield f"head goes {fall_m:.2f} m", fall_m > 0.2
    about = numbers.during(heights, a - 0.5, b + 0.5)
    first, last = (about.min(), about.max()) if rises else (about.max(), about.min())
    begins = "began" in claim.said
    opens = a > float(numbers.times[0]) + 0.01
    done = _progress(heights, float(first), float(last))
    if "crouch" in claim.said:
        hips = numbers.origin("pelvis")[:, 2]
        about = numbers.during(hips, a - 0.5, b + 0.5)
        knees = _progress(hips, float(about.max()), float(about.min()))
        begun = min(float(numbers.at(each, a - SLACK_S)) for each in (done, knees))
        yield f"start: {begun:.0%} done {SLACK_S} s before", not (opens and begun > BEGUN)
        opens = False
    yield from _ends(numbers, done, claim, start=opens, end=not begins)
    if "crouch" in claim.said or claim.said.startswith("stood"):
        pelvis = numbers.origin("pelvis")[:, 2]
        down_m = sign * float(numbers.at(pelvis, b) - numbers.at(pelvis, a))
        yield f"pelvis goes {down_m:.2f} m", down_m > 0.15


def _walked(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    feet = [name for name in numbers.streams() if name.endswith("_ankle")]
    a, b = claim.start_s, claim.end_s
    ways = []
    for foot in feet:
        places = numbers.origin(foot)[:, :2]
        ways.append(float(np.linalg.norm(numbers.at(places, b) - numbers.at(places, a))))
    several = claim.said.startswith("walked")
    yield f"feet go {ways}", sum(way > 0.17 for way in ways) >= (2 if several else 1)
    things = [
        name for name, body in numbers.streams().items() if getattr(body, "tag", "") == "mobile"
    ]
    thing = claim.thing or things[0]
    pelvis, there = numbers.origin("pelvis")[:, :2], numbers.middle(thing)[:, :2]
    mean = np.mean([numbers.origin(foot)[:, :2] for foot in feet], axis=0)
    far = np.linalg.norm(mean - there, axis=1)
    nears_m = float(numbers.at(far, a) - numbers.at(far, b))
    if " up to " in claim.said:
        yield f"comes {nears_m:.2f} m nearer", nears_m > 0.1
    if "away" in claim.said:
        yield f"comes {nears_m:.2f} m nearer", nears_m < -0.08
    if "around" in claim.said:
        offset = numbers.during(pelvis - there, a, b)
        swept = np.unwrap(np.arctan2(offset[:, 1], offset[:, 0]))
        degrees = abs(np.degrees(swept[-1] - swept[0]))
        yield f"goes {degrees:.0f} degrees about it", degrees > 60
    yield from _swings(claim, numbers, feet)


def _swings(claim: Claim, numbers: Numbers, feet: Sequence[str]) -> Iterator[tuple[str, bool]]:
    """Whether feet are on their way near a told start and a told end."""
    a, b = claim.start_s, claim.end_s
    step_s = float(np.median(np.diff(numbers.times)))
    for time_s, what in ((a, "start"), (b, "end")):
        speeds = []
        for foot in feet:
            speed = np.linalg.norm(np.gradient(numbers.origin(foot)[:, :2], step_s, axis=0), axis=1)
            near = numbers.during(speed, time_s - SLACK_S, time_s + SLACK_S)
            speeds.append(float(near.max()) if len(near) else 0.0)
        yield f"foot at {max(speeds):.2f} m/s about its {what}", max(speeds) > 0.3


def _stirred(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    tool = next((name for name in numbers.streams() if name == "whisk"), "")
    if not tool or not claim.goal:
        return
    offset = numbers.middle(tool) - numbers.middle(claim.goal)
    for start_s, end_s in claim.spans:
        own = numbers.during(offset, start_s, end_s)
        if len(own) < 5:
            continue
        far = float(np.median(np.linalg.norm(own[:, :2], axis=1)))
        yield f"{tool} {far:.2f} m beside the middle of the {claim.goal}", far < 0.2
        path = float(np.linalg.norm(np.diff(own, axis=0), axis=1).sum())
        yield f"{tool} goes at {path / (end_s - start_s):.2f} m/s", path / (end_s - start_s) > 0.05
    yield from _held(replace(claim, thing=tool), numbers)


def _poured(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    lean = numbers.up(claim.thing)
    own = numbers.during(lean, claim.start_s, claim.end_s)
    if len(own):
        yield f"leans {np.degrees(own.max()):.0f} degrees", own.max() > 1.0
    outside = [
        numbers.during(lean, start_s, end_s)
        for start_s, end_s in (
            (claim.start_s - 1.5, claim.start_s - SLACK_S),
            (claim.end_s + SLACK_S, claim.end_s + 1.5),
        )
    ]
    for part in outside:
        if len(part):
            tipped = float((part > 1.75).mean())
            yield f"tipped for {tipped:.0%} of the time beside", tipped < 0.3
    yield from _held(claim, numbers)


def _steadied(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    places = numbers.during(numbers.middle(claim.thing), claim.start_s, claim.end_s)
    strays_m = (
        float(np.linalg.norm(places - places.mean(axis=0), axis=1).max()) if len(places) else 0.0
    )
    yield f"strays {strays_m:.2f} m", strays_m < 0.12
    yield from _held(claim, numbers)


def _taken(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    places = numbers.middle(claim.thing)
    before = numbers.during(places, claim.start_s - 1.0, claim.start_s - SLACK_S)
    if len(before) > 2:
        gone_m = float(np.linalg.norm(before - before[-1], axis=1).max())
        yield f"goes {gone_m:.3f} m before the start", gone_m < 0.03
    own = numbers.during(places, claim.start_s, claim.end_s)
    if len(own) > 2:
        way_m = float(np.linalg.norm(own - own[0], axis=1).max())
        yield f"goes {way_m:.2f} m", way_m > 0.05
    if claim.goal or "from the table" in claim.said:
        yield from _stood(claim, numbers)
    soon = numbers.during(places, claim.start_s, claim.start_s + 2.0 * SLACK_S)
    if len(soon) > 2:
        way_m = float(np.linalg.norm(soon - soon[0], axis=1).max())
        yield f"goes {way_m:.3f} m soon after the start", way_m > 0.005
    yield from _held(claim, numbers)


def _stood(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    """Whether the thing stood on the table before it was taken."""
    top_m = float(np.nanmax(numbers.surface("table")[..., 2]))
    before = numbers.during(numbers.lowest(claim.thing), claim.start_s - 1.0, claim.start_s)
    if len(before):
        above_m = float(before[0]) - top_m
        yield f"{above_m:.2f} m above the table", abs(above_m) < 0.15


def _waited(text: str, steps: Sequence[Checked]) -> Iterator[str]:
    """Pauses that are told otherwise than the times of the steps say."""
    spans = [step.claim for step in steps if step.claim.timed]
    for told in re.finditer(r"About (\d+) s later, [^()]*\((\d+\.\d+)", text):
        start_s = float(told[2])
        before = [claim.end_s for claim in spans if claim.start_s < start_s]
        lasted_s = start_s - max(before)
        if abs(lasted_s - float(told[1])) > 0.51:
            yield f"{told[1]} s told, {lasted_s:.1f} s between the steps"


def _reached(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    if not claim.hands:
        return
    hand = numbers.origin(f"{claim.hands[0]} hand")
    a, b = claim.start_s, claim.end_s
    own = numbers.during(hand, a, b)
    way_m = float(np.linalg.norm(own[-1] - own[0]))
    yield f"hand goes {way_m:.2f} m", way_m > STEP_M
    lifted = claim.said.startswith(("reached", "leaned"))
    first = numbers.at(hand, a - 0.4 if lifted else a)
    last = numbers.at(hand, b)
    done = ((hand - first) @ (last - first)) / float((last - first) @ (last - first))
    if lifted:
        yield from _ends(numbers, done, claim)
    else:
        after = float(numbers.at(done, b + SLACK_S))
        yield f"{after:.0%} back {SLACK_S} s after the end", after > DONE
    rise_m = float(own[-1, 2] - own[0, 2])
    if lifted and " up" in claim.said:
        yield f"hand rises {rise_m:.2f} m", rise_m > 0.1
    if "lowered" in claim.said:
        yield f"hand rises {rise_m:.2f} m", rise_m < -0.1
    facing = _facing(numbers, a)
    if lifted and facing is not None:
        yield from _direction(claim, own[-1] - own[0], facing)


def _facing(numbers: Numbers, time_s: float) -> np.ndarray | None:
    """Where the body faces over the ground: across the line between hanging hands."""
    names = ("left hand", "right hand")
    if not all(name in numbers.streams() for name in names):
        return None
    left, right = (numbers.at(numbers.origin(name), numbers.times[0])[:2] for name in names)
    across = right - left
    return np.array([-across[1], across[0]]) / np.linalg.norm(across)


def _direction(claim: Claim, way: np.ndarray, facing: np.ndarray) -> Iterator[tuple[str, bool]]:
    right = np.array([facing[1], -facing[0]])
    ahead, aside = float(way[:2] @ facing), float(way[:2] @ right)
    said = claim.said
    for word, part in (
        ("forward", ahead),
        ("backward", -ahead),
        ("to the left", -aside),
        ("to the right", aside),
    ):
        if re.search(rf"\b{word}\b", said.replace("with the right hand", "")):
            yield f"{word}: {part:.2f} m", part > 0.05


def _held_up(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    if "overhead" in claim.said:
        above = numbers.middle(claim.thing)[:, 2] - numbers.origin("head")[:, 2]
        own = float(np.median(numbers.during(above, claim.start_s, claim.end_s)))
        yield f"{own:.2f} m above the head", own > 0.0
    if "upside down" in claim.said:
        lean = numbers.during(
            numbers.up(claim.thing), claim.start_s + SLACK_S, claim.end_s - SLACK_S
        )
        yield f"leans {np.degrees(lean.min()):.0f} degrees at least", lean.min() > 2.0
    yield from _held(claim, numbers)


def _handed(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    for side in ("left", "right"):
        apart = numbers.during(
            numbers.apart(f"{side} hand", claim.thing), claim.start_s, claim.end_s
        )
        yield f"{side} hand {apart.min():.3f} m away", apart.min() < 0.05


def _up_and_down(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    heights = numbers.during(numbers.middle(claim.thing)[:, 2], claim.start_s, claim.end_s)
    yield f"heights over {np.ptp(heights):.2f} m", np.ptp(heights) > 0.05
    yield from _held(claim, numbers)


def _touched(claim: Claim, numbers: Numbers) -> Iterator[tuple[str, bool]]:
    apart = numbers.during(
        numbers.apart(f"{claim.hands[0]} hand", claim.thing), claim.start_s, claim.end_s
    )
    yield f"{apart.min():.3f} m at its nearest", apart.min() < 0.05


CHECKS: tuple[tuple[str, Check], ...] = (
    (r"^turned? .*|^turning .*", _turned),
    (r"^lifted .* to the mouth", _lifted),
    (r"^lifted ", _lifted),
    (r"^moved .* up and down", _up_and_down),
    (r"^lowered the hand|^brought the hand", _reached),
    (r"^(put|lowered) ", _put),
    (r"^carried ", _carried),
    (r"^(pulled|slid|pushed) .* off ", _taken),
    (r"^(pulled|slid|pushed|shifted|moved) ", _slid),
    (r"^straightened up again", _reached),
    (r"^(bent|crouched|straightened|stood|began to straighten)", _bent),
    (r"^(walked|stepped|took a step)", _walked),
    (r"^stirred ", _stirred),
    (r"^poured ", _poured),
    (r"^steadied ", _steadied),
    (r"^took ", _taken),
    (r"^(reached|leaned and reached) ", _reached),
    (r"^held ", _held_up),
    (r"^handed ", _handed),
    (r"^touched ", _touched),
)
"""How each kind of step is checked, by how its words begin."""


def checked(text: str, capture: Capture, nouns: Mapping[str, str]) -> list[Checked]:
    """Each told step with what was compared, and what contradicts it.

    Args:
        text: A timed telling.
        capture: What it tells of.
        nouns: Objects by how they are spoken of.
    """
    numbers = Numbers(capture)
    out = []
    for claim in claims(text, nouns):
        check = next((own for words, own in CHECKS if re.match(words, claim.said)), None)
        beyond = claim.end_s > float(numbers.times[-1]) + 0.01
        results = list(check(claim, numbers)) if check and not beyond else []
        results += [("goes on beyond the recording", False)] if beyond else []
        wrong = tuple(what for what, holds in results if not holds)
        out.append(Checked(claim, len(results), wrong))
    for place, what in (*_left_turned(out, numbers), *_untold(out, numbers)):
        out[place] = replace(out[place], wrong=(*out[place].wrong, what))
    pauses = tuple(_waited(text, out))
    return [replace(out[0], wrong=(*out[0].wrong, *pauses)), *out[1:]] if pauses else out
