"""Efforts: four parameters of manner with which a recorded action is performed."""

import itertools
import tomllib
from collections.abc import Collection, Iterable
from dataclasses import dataclass, fields, replace
from functools import cache
from importlib import resources

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation, Slerp

from capar.body.human import Human
from capar.model.errors import CaparError, UnknownNameError
from capar.regeneration.body_frames import body_frames
from capar.regeneration.goals import object_goals
from capar.regeneration.motion import Motion
from capar.regeneration.quality import Quality, failures
from capar.regeneration.scenes import PlanError, Scene
from capar.regeneration.search import regenerate
from capar.regeneration.sources import Source
from capar.regeneration.styles import SHORT_M, Kind, Style, arc_shares, paced, retimed, smoothed

POLES = {
    "time": ("sustained", "sudden"),
    "weight": ("light", "strong"),
    "space": ("indirect", "direct"),
    "flow": ("free", "bound"),
}
"""The pole at -1 and the one at +1 of each parameter."""


@dataclass(frozen=True, slots=True)
class Effort:
    """How something is done, compared with how it was recorded: 0 is as recorded.

    D. Chi, M. Costa, L. Zhao and N. Badler, The EMOTE model for effort and shape (SIGGRAPH 2000).
    """

    time: float = 0.0
    """From sustained (-1) to sudden (1)."""

    weight: float = 0.0
    """From light (-1) to strong (1)."""

    space: float = 0.0
    """From indirect (-1) to direct (1)."""

    flow: float = 0.0
    """From free (-1) to bound (1)."""

    def __post_init__(self) -> None:
        """Check that every parameter is between its poles."""
        for name, value in self.values.items():
            if not -1.0 <= value <= 1.0:
                low, high = POLES[name]
                raise CaparError(
                    f"effort {name} = {value:g}; it is from -1 ({low}) to 1 ({high}), 0 being as "
                    "recorded"
                )

    @property
    def values(self) -> dict[str, float]:
        """By parameter."""
        return {field.name: float(getattr(self, field.name)) for field in fields(self)}

    def scaled(self, share: float) -> "Effort":
        """The same manner, less of it."""
        return Effort(**{name: share * value for name, value in self.values.items()})

    def __str__(self) -> str:
        """The parameters, as a user would state them."""
        return ", ".join(f"{name} {value:+.2f}" for name, value in self.values.items())


def read_effort(text: str) -> Effort:
    """An effort from ``time=0.6,weight=-0.3`` or the names of poles, ``sudden=0.6,light=0.3``.

    Raises:
        UnknownNameError: There is no such parameter or pole.
        CaparError: A value is no number or beyond a pole, or a parameter is stated twice.
    """
    signs = {parameter: (parameter, 1.0) for parameter in POLES}
    for parameter, (low, high) in POLES.items():
        signs |= {low: (parameter, -1.0), high: (parameter, 1.0)}
    out, stated = Effort(), set()
    for part in filter(None, (item.strip() for item in text.split(","))):
        name, _, said = (word.strip() for word in part.partition("="))
        if name.lower() not in signs:
            raise UnknownNameError("effort", name.lower(), list(signs))
        parameter, sign = signs[name.lower()]
        try:
            value = sign * float(said)
        except ValueError:
            raise CaparError(
                f"--effort {part!r}: {name} needs a number from -1 to 1, as in {name}=0.5"
            ) from None
        if parameter in stated:
            raise CaparError(f"--effort states {parameter} twice; state it once")
        stated.add(parameter)
        out = replace(out, **{parameter: value})
    if not stated:
        raise CaparError("--effort states nothing; as in --effort time=0.6,weight=-0.3")
    return out


@cache
def adverbs() -> dict[str, Effort]:
    """The effort of each adverb of the table ``adverbs.toml``."""
    text = resources.files(__package__).joinpath("adverbs.toml").read_text("utf-8")
    return {word: Effort(**row) for word, row in tomllib.loads(text).items()}


def effort_of_words(words: Iterable[str]) -> Effort | None:
    """The effort that some words ask for together, no further than to a pole; None if none does."""
    found = [adverbs()[word].values for word in words if word in adverbs()]
    sums = {name: sum(values[name] for values in found) for name in POLES}
    return Effort(**{n: max(-1.0, min(1.0, v)) for n, v in sums.items()}) if found else None


def told_of_words(words: Iterable[str], *, stated: bool) -> list[str]:
    """What is reported of the effect of some words."""
    return [
        f"{word!r} asks for the effort {adverbs()[word]}"
        if word in adverbs() and not stated
        else f"{word!r} has no effect"
        + (", since an effort is stated" if word in adverbs() else "")
        for word in words
    ]


SLOW = 0.05
"""Speeds below this share of the highest one are scaled alike, so that noise is not raised [1]."""

SKEW = 1.5  # Weight tilts the speeds by this power of e from the first frame to the last one [1].
PAUSE = 0.12  # Bound flow pauses for so long at an end of a interval [1, of its time].

OVERSHOOT, SETTLES = 0.08, 0.3
"""Free flow goes so far beyond a free end [1, of the path], for so long [1, of the time]."""

BULGE, LIFT = 0.15, 0.08
"""Indirect space leads so far aside, light weight so high half-way [1, of the straight path]."""

WIDER = 0.5  # Indirect space enlarges by so much what deviates from the straight path already [1].


def timed(
    shares: Float[np.ndarray, "frames"], time: float, weight: float
) -> Float[np.ndarray, "frames"]:
    """Shares of the path, from 0 to 1, with the speeds of another effort.

    Speeds are raised to the power 2^time, so that the highest over the mean grows with time
    (sudden), and tilted by exp(SKEW * weight) towards the end, so that weight (strong) goes on
    accelerating for longer and light weight eases in.
    """
    speeds = np.diff(shares)
    peak = float(speeds.max())
    middle = (np.arange(len(speeds)) + 0.5) / len(speeds)
    rate = np.maximum(speeds / peak, SLOW) ** (2.0**time - 1.0)
    rate = rate * np.exp(SKEW * weight * (middle - 0.5))
    covered = np.concatenate([[0.0], np.cumsum(speeds * rate)])
    return np.asarray(covered / covered[-1])


def paused(
    shares: Float[np.ndarray, "frames"], flow: float, ends: tuple[bool, bool]
) -> Float[np.ndarray, "frames"]:
    """Shares of the path with the pauses of bound flow."""
    before, after = (PAUSE * max(flow, 0.0) * may for may in ends)
    time = np.linspace(0.0, 1.0, len(shares))
    inner = np.clip((time - before) / (1.0 - before - after), 0.0, 1.0)
    return np.interp(inner, time, shares)


def overshot(frames: int, flow: float) -> tuple[Float[np.ndarray, "frames"], ...]:
    """When the path is gone, and what is gone beyond its end, with free flow.

    Returns:
        The share of the recorded time at each frame, and the added share of the path.
    """
    free = max(-flow, 0.0)
    time = np.linspace(0.0, 1.0, frames)
    arrival = 1.0 - SETTLES * free
    gone = np.minimum(time / arrival, 1.0)
    late = np.clip((time - arrival + SETTLES * free) / (2.0 * SETTLES * max(free, 1e-9)), 0.0, 1.0)
    return gone, OVERSHOOT * free * np.sin(np.pi * late) ** 2


def shaped(
    spots: Float[np.ndarray, "frames 3"],
    space: float,
    weight: float,
    free: Float[np.ndarray, "frames"],
) -> Float[np.ndarray, "frames 3"]:
    """A path between the same ends, more or less direct, higher or lower.

    Direct space takes what deviates from the straight way out of it. Indirect space enlarges that
    and bulges aside: to the side on which the path becomes longer, so that, a length being convex
    in what is added, more indirect is never shorter.

    Args:
        spots: The path [m].
        space: From indirect to direct.
        weight: From light to strong.
        free: How far each frame may be moved [1].
    """
    chord = spots[-1] - spots[0]
    length = float(np.linalg.norm(chord))
    along = (spots - spots[0]) @ chord / length**2
    aside = spots - spots[0] - np.outer(along, chord)
    moves = np.diff(spots, axis=0)
    steps = np.linalg.norm(moves, axis=1)
    share = np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
    bump = 16.0 * share**2 * (1.0 - share) ** 2
    out = -max(space, 0.0) * aside
    if space < 0.0:
        across = np.array([-chord[1], chord[0], 0.0])  # level; to the left where it goes up
        size = float(np.linalg.norm(across))
        across = across / size if size > 1e-9 else np.array([0.0, 1.0, 0.0])

        def lengthens(added: Float[np.ndarray, "frames 3"]) -> float:
            more = np.einsum("ij,ij->i", moves, np.diff(added, axis=0))
            return float(np.sum(more / np.maximum(steps, 1e-12)))

        bulge = length * BULGE * np.outer(bump, across)
        out = -space * max((WIDER * aside + bulge, WIDER * aside - bulge), key=lengthens)
    out = out - weight * LIFT * length * np.outer(bump, [0.0, 0.0, 1.0])
    return np.asarray(spots + free[:, None] * out)


ARM_M = 0.1  # A turn of one radian counts as so long a path [m].

SLOWLY = 0.1
"""A step's border parts the path of a hand slower than this share of its highest speed [1]."""

OFF_M = 0.05
"""An object that is so far above where it is taken and put down may go another way [m]."""

ROUND_S = 0.15
"""Free flow rounds the path over so long on both sides of a border between steps [s]."""


def with_effort(style: Style, source: Source, effort: Effort) -> Style:
    """The style with another effort; events keep their frames and places.

    Between events the speeds along each path are reshaped by time, weight and bound flow, and the
    shape of paths in free air by space, weight and free flow. How long everything takes is not
    changed here.
    """
    hands, things = dict(style.hands), dict(style.things)
    borders = {side: _borders(source, side) for side in source.hands}
    for side, path in style.hands.items():
        holds = [hold for hold in source.holds if hold.side == side]
        firsts, lasts = {hold.first for hold in holds}, {hold.last for hold in holds}
        events = {0, len(source.times) - 1, *firsts, *lasts}
        hands[side] = _rounded(path, source, events, effort.flow)
        for first, last in itertools.pairwise(sorted(events | borders[side])):
            if not any(hold.first <= first and last <= hold.last for hold in holds):
                pauses = first not in lasts, last not in firsts
                ends_free = not any(hold.first >= last for hold in holds)
                free = np.ones(last + 1 - first)
                hands[side] = _reshaped(
                    hands[side], first, effort, free, pauses=pauses, ends_free=ends_free
                )
    recorded = body_frames(source.human, source.scene)
    for name, goals in object_goals(source, source.scene, recorded, recorded).items():
        events = {goal.frame for goal in goals}
        first, last = min(events), max(events)
        path, heights = style.things[name], style.things[name].translation[:, 2]
        # It stays on what bears it, and goes another way the freer the higher it is above that.
        rise = np.clip((heights - max(heights[first], heights[last])) / OFF_M - 0.2, 0.0, 1.0)
        free = rise**2 * (3.0 - 2.0 * rise)
        path = _rounded(path, source, events, effort.flow)
        acting = {hold.side for hold in source.holds if hold.thing == name}
        inner = {b for side in acting for b in borders[side] if first < b < last}
        for start, end in itertools.pairwise(sorted(events | inner)):
            path = _reshaped(path, start, effort, free[start : end + 1])
        things[name] = path
    return replace(style, hands=hands, things=things)


def _borders(source: Source, side: str) -> set[int]:
    """Frames between steps of a hand at which it is slow."""
    hand = source.hands[side]
    steps = np.linalg.norm(np.diff(hand.path.translation, axis=0), axis=1)
    slow = SLOWLY * float(steps.max())
    ends = {part.last for part in source.observation.segments if part.ee == hand.sensor}
    return {frame for frame in ends if 0 < frame < len(steps) and steps[frame - 1] < slow}


def _reshaped(
    whole: RigidTransform,
    first: int,
    effort: Effort,
    free: Float[np.ndarray, "part"],
    *,
    pauses: tuple[bool, bool] = (True, True),
    ends_free: bool = False,
) -> RigidTransform:
    """A path with another effort from a frame on; as it is where that part is too short.

    Args:
        whole: The path.
        first: Where the part begins.
        effort: The effort.
        free: How far each of the part's frames may go another way [1].
        pauses: Whether it may be paused at its start and at its end: nothing is let go or taken.
        ends_free: Whether nothing is held in its last frame, nor taken then or later.
    """
    part = slice(first, first + len(free))
    path = whole[part]
    gone = np.linalg.norm(np.diff(path.translation, axis=0), axis=1)
    turned = (path[1:].rotation * path[:-1].rotation.inv()).magnitude()
    length = np.concatenate([[0.0], np.cumsum(np.hypot(gone, ARM_M * turned) + 1e-9)])
    if length[-1] < SHORT_M or len(path) < 4:
        return whole
    frames = np.arange(len(path), dtype=float)
    shares = timed(length / length[-1], effort.time, effort.weight)
    shares = paused(shares, effort.flow, pauses)
    chord = path.translation[-1] - path.translation[0]
    far, beyond = float(np.linalg.norm(chord)) >= SHORT_M, np.zeros(len(path))
    if ends_free and far:
        share, beyond = overshot(len(path), effort.flow)
        shares = np.interp(share, frames / frames[-1], shares)
    at = np.interp(shares, length / length[-1], frames)
    spots = np.stack([np.interp(at, frames, column) for column in path.translation.T], axis=1)
    if far:
        made = shaped(spots, effort.space, effort.weight, np.interp(at, frames, free))
        spots = retimed(made, arc_shares(spots)) + np.outer(beyond, chord)
    places, turns = whole.translation.copy(), whole.rotation.as_quat(canonical=False)
    places[part], turns[part] = spots, Slerp(frames, path.rotation)(at).as_quat()
    return RigidTransform.from_components(places, Rotation.from_quat(turns))


def _rounded(
    path: RigidTransform, source: Source, pinned: Collection[int], flow: float
) -> RigidTransform:
    """A path that flows through the borders between steps where nothing has to be anywhere."""
    half = round(ROUND_S * source.rate_hz * max(-flow, 0.0))
    if half < 1 or len(path) < 4:
        return path
    frames = np.arange(len(path))
    near = np.min([np.abs(frames - frame) for frame in pinned], axis=0)
    inside = (frames >= min(pinned)) & (frames <= max(pinned))
    share = np.clip(near / (4.0 * half), 0.0, 1.0) * inside
    share = share**2 * (3.0 - 2.0 * share)
    off = smoothed(path.translation, half) - path.translation
    return RigidTransform.from_components(path.translation + share[:, None] * off, path.rotation)


SHARES = (1.0, 0.75, 0.5, 0.25, 0.0)  # Shares of the effort that are tried [1].

DOUBLINGS = 0.5
"""A sudden performance is so many times halved in its time, a sustained one doubled [1]."""


@dataclass(frozen=True)
class EffortReport:
    """What effort was asked for, and what of it was performed."""

    asked: Effort
    performed: Effort
    why: str = ""
    """What did not allow more."""

    def __str__(self) -> str:
        """For people, in a line or two."""
        lines = [f"effort asked for: {self.asked}"]
        if self.why:
            lines.append(f"effort performed: {self.performed}, since with more {self.why}")
        return "\n".join(lines)


def regenerate_in_manner(
    source: Source,
    human: Human,
    scene: Scene,
    style: Style,
    *,
    effort: Effort | None,
    duration_s: float | None = None,
) -> tuple[Motion, Quality, EffortReport | None]:
    """Perform in a certain time [s], with an effort or the largest share of it that is possible.

    Without a duration it takes as long as recorded, or as long as the effort of time asks for.

    Raises:
        PlanError: It is impossible without any effort, too, or an effort has no meaning there.
    """
    if effort is None:
        source = paced(source, duration_s) if duration_s else source
        return *regenerate(source, human, scene, style), None
    check_effort(source, style, effort)
    found: list[tuple[Motion, Quality, float]] = []
    reasons: list[str] = []
    refused: PlanError | None = None
    for share in SHARES:
        part = effort.scaled(share)
        lasts_s = float(source.times[-1] - source.times[0]) * 2.0 ** (-DOUBLINGS * part.time)
        try:
            timed = paced(source, duration_s or lasts_s)
            motion, quality = regenerate(timed, human, scene, with_effort(style, timed, part))
        except PlanError as error:
            refused = error
            reasons.append(str(error))
            continue
        found.append((motion, quality, share))
        if quality.passed:
            break
        reasons.append(failures(quality))
    if not found:
        assert refused is not None
        raise refused
    motion, quality, share = min(found, key=lambda made: (len(made[1].failed), -made[2]))
    why = reasons[SHARES.index(share) - 1] if share < 1.0 else ""
    return motion, quality, EffortReport(effort, effort.scaled(share), why)


def check_effort(source: Source, style: Style, effort: Effort) -> None:
    """Whether an effort can have its effect there.

    Raises:
        PlanError: It cannot; the message says what would do.
    """
    set_going = [(launch.frame, launch.thing) for launch in source.releases]
    set_going += [(toss.first, toss.thing) for toss in source.throws]
    if set_going:
        frame, thing = min(set_going)
        raise PlanError(
            f"an effort would change the speed at which {thing!r} is struck or let go at "
            f"{source.times[frame]:.2f} s; --force says what is kept of that: leave out "
            "--effort, or the adverb"
        )
    if style.kind is Kind.EVEN:
        raise PlanError(
            "style 'even' has its own speeds and straight ways, on which an effort has no effect; "
            "--style path or frame would do"
        )
    if style.kind is Kind.VEL and effort.space:
        raise PlanError(
            "style 'vel' goes straight, so that space has no effect; --style path or frame would do"
        )
