"""Is the performer whose style was borrowed found again from the regenerated motion alone?

Thesis 5.4 asked six people. Here some performers do one reach each six times; their styles are
measured and fixed. Then bodies of other sizes, in drawn scenes, borrow the style of a seventh or
later trial, and the nearest of the performers by the measured style of the motion is named: by the
plain distance, and by one that weights what performing changes less. That one is measured on other
performers, the development half, before; none of them is in the test.

Run as ``PYTHONPATH=. python benchmarks/performer_styles.py [TRIALS [RATIO ...]]``: five virtual
performers, five others for development. With ``--real NPZ_FOLDER`` the performers' usual ways are
the reaches of ``smartbody_mocap_reaching``, every second one by name for development, the others
for the test; with ``--all`` the test is of all of them. The ratio 0 takes them as they are.
"""

import sys
from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.body.scripted_actions import action_capture
from capar.pipelines.round_trips import body, observed_source
from capar.regeneration.drafts import Draft
from capar.regeneration.hand_paths import Care
from capar.regeneration.motions import perform_plan
from capar.regeneration.planning import led, reachable
from capar.regeneration.scene_files import drawn_scene
from capar.regeneration.sources import Source
from capar.regeneration.style_distances import (
    StyleMetric,
    WayStyle,
    between_distance,
    nearest_between,
    nearest_performer,
    style_metric,
    way_style,
    within_distance,
)
from capar.regeneration.styles import Style, borrowed_style

SEED, DEVELOPMENT_SEED = 54, 155
DEVELOPMENT_RATIO = 3.0
RATE_HZ = 20.0
PERFORMERS, TRIALS = 5, 6
AGENTS, SCENES = ("man", "woman", "child"), 4
RATIOS = (3.0, 2.0, 1.5, 1.25, 1.0)
SIDE = "right"

WITHIN = np.array([0.012, 0.008, 0.012, 0.008, 0.02, 0.015])
"""How much one performer's trials vary: bumps to the side and upwards, once and twice a way [m],
and twists of the timing [1]."""

Ways = Sequence[Float[np.ndarray, "frames 3"]]


@cache
def source() -> Source:
    return observed_source(action_capture("touch", rate_hz=RATE_HZ))


def reach() -> int:
    """The frame at which the hand arrives."""
    return source().holds[0].first


def bent(way: np.ndarray, parameters: np.ndarray) -> np.ndarray:
    """A way with bumps to the side and upwards, covered with another timing."""
    s = np.linspace(0.0, 1.0, len(way))
    twist = parameters[4] * np.sin(np.pi * s) + parameters[5] * np.sin(2.0 * np.pi * s)
    warped = np.maximum.accumulate(np.clip(s + twist * s * (1.0 - s) * 4.0, 0.0, 1.0))
    places = np.stack([np.interp(warped, s, column) for column in way.T], axis=1)
    chord = way[-1] - way[0]
    left = np.array([-chord[1], chord[0], 0.0]) / np.hypot(*chord[:2])
    once, twice = np.sin(np.pi * warped), np.sin(2.0 * np.pi * warped)
    side = parameters[0] * once + parameters[1] * twice
    # Upwards only: the way leads over a table.
    up = np.abs(parameters[2]) * once + np.abs(parameters[3]) * twice**2
    return np.asarray(places + np.outer(side, left) + np.outer(up, [0.0, 0.0, 1.0]))


def usual_ways(real: Sequence[Path]) -> Ways:
    """What the performers' ways have in common: the recorded reach, or a real one of each."""
    own = source().hands[SIDE].path.translation[: reach() + 1]
    return [real_way(path, own) for path in real] or [own] * PERFORMERS


def real_way(path: Path, own: np.ndarray) -> np.ndarray:
    """A real wrist's way to its apex, turned to where the virtual one goes, at its frames."""
    held = np.load(path)
    names = [str(name) for name in held["joint_names"]]
    wrist = held["pos_m"][:, names.index("JtWristRt")][:, [2, 0, 1]]
    clock, apex = held["t"], float(held["apex_time"])
    at = np.linspace(clock[0], apex, len(own))
    way = np.stack([np.interp(at, clock, column) for column in wrist.T], axis=1)
    one, two = way[-1] - way[0], own[-1] - own[0]
    angle = np.arctan2(two[1], two[0]) - np.arctan2(one[1], one[0])
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    way[:, :2] = (way[:, :2] - way[0, :2]) @ turn.T
    s = np.linspace(0.0, 1.0, len(own))[:, None]
    aside = way - way[0] - s * (way[-1] - way[0])
    return np.asarray(own[0] + s * two + aside)


class Performers:
    """Performers, so far apart as is asked for, and their six trials."""

    def __init__(self, ratio: float, real: Sequence[Path], seed: int = SEED) -> None:
        self.ways, self.real = usual_ways(real), bool(real)
        self.count = len(self.ways)
        self.rng = np.random.default_rng([seed, round(100 * ratio), self.real])
        self.own = self.rng.normal(size=(self.count, len(WITHIN)))
        self.noise = self.rng.normal(size=(self.count, TRIALS, len(WITHIN)))
        self.mean = np.mean(self.ways, axis=0)
        self.spread = 0.0
        if ratio <= 0.0:
            self.spread = 1.0
            self.trials = self._trials()
            return
        low, high = 0.0, 30.0
        for _ in range(30):  # the spread that gives the ratio, before anything is regenerated
            self.spread = 0.5 * (low + high)
            low, high = (self.spread, high) if self.ratio < ratio else (low, self.spread)
        self.trials = self._trials()

    def way(self, who: int, noise: np.ndarray) -> np.ndarray:
        """One trial: the performer's own way, as far from the others' as the spread has it."""
        usual = self.mean + self.spread * (self.ways[who] - self.mean)
        own = 0.0 if self.real else self.spread * self.own[who]
        return bent(usual, (own + noise) * WITHIN)

    def _trials(self) -> dict[str, list[WayStyle]]:
        return {
            f"performer_{who}": [way_style(self.way(who, noise)) for noise in self.noise[who]]
            for who in range(self.count)
        }

    @property
    def ratio(self) -> float:
        """Mean distance between performers over that within."""
        trials = self._trials()
        return between_distance(trials) / within_distance(trials)


@cache
def draft(agent: str, scene: int) -> Draft:
    """What is decided whatever the style is."""
    place = drawn_scene(source().scene, np.random.default_rng([SEED, scene]))
    return reachable(source(), place, body(agent, source()))


def borrowed(way: np.ndarray) -> Style:
    """The style of a trial in which the hand came that way."""
    track = source().hands[SIDE]
    spots = np.array(track.path.translation)
    spots[: len(way)] = way
    path = RigidTransform.from_components(spots, track.path.rotation)
    hands = {**source().hands, SIDE: replace(track, path=path)}
    return borrowed_style(source(), replace(source(), hands=hands))


def regenerated(way: np.ndarray, agent: str, scene: int) -> WayStyle:
    """The style of the motion of another body that borrowed a style."""
    made = copy(draft(agent, scene))
    made.style = borrowed(way)
    motion = perform_plan(led(made, Care()))
    palm = motion.plan.human.sites(motion.postures, [f"{SIDE}_palm"])[f"{SIDE}_palm"][0]
    return way_style(palm[: reach() + 1])


@dataclass(frozen=True, eq=False)
class Borrowed:
    """A style that was borrowed, and what came of it."""

    who: str
    given: WayStyle
    made: WayStyle


def performances(performers: Performers, count: int) -> list[Borrowed]:
    """Further trials, each borrowed by a body in a scene; all of both meet every performer."""
    out = []
    for number in range(count):
        who = number % performers.count
        way = performers.way(who, performers.rng.normal(size=len(WITHIN)))
        turn = number // performers.count  # so that no body or scene belongs to a performer
        agent = AGENTS[(number + turn) % len(AGENTS)]
        made = regenerated(way, agent, 1 + (number + turn // len(AGENTS)) % SCENES)
        out.append(Borrowed(f"performer_{who}", way_style(way), made))
    return out


def developed(count: int, real: Sequence[Path]) -> list[tuple[WayStyle, WayStyle]]:
    """What performing changes of the styles of the performers of the development half."""
    performers = Performers(DEVELOPMENT_RATIO, real, DEVELOPMENT_SEED)
    return [(one.given, one.made) for one in performances(performers, count)]


def report(
    ratios: Sequence[float],
    count: int,
    real: Sequence[Path],
    changed: Sequence[tuple[WayStyle, WayStyle]],
) -> None:
    print("asked ratio  within  between  ratio  nearest pair  given ways  plain  weighted")
    for ratio in ratios:
        performers = Performers(ratio, real)
        trials = performers.trials
        metric: StyleMetric = style_metric(trials, changed)
        done = performances(performers, count)
        right = (
            sum(nearest_performer(one.given, trials) == one.who for one in done),
            sum(nearest_performer(one.made, trials) == one.who for one in done),
            sum(metric.nearest_performer(one.made, trials) == one.who for one in done),
        )
        within, between = (d(trials) for d in (within_distance, between_distance))
        print(
            f"{ratio:11.2f}  {within:6.3f}  {between:7.3f}  {between / within:5.2f}  "
            f"{nearest_between(trials) / within:12.2f}  {right[0]:10d}  {right[1]:5d}  "
            f"{right[2]:8d} of {count}",
            flush=True,
        )


def main(arguments: list[str]) -> None:
    whole = "--all" in arguments
    arguments = [word for word in arguments if word != "--all"]
    learnt: list[Path] = []
    tested: list[Path] = []
    if "--real" in arguments:
        at = arguments.index("--real")
        files = sorted(Path(arguments[at + 1]).glob("*.npz"))
        learnt, tested = files[0::2], files if whole else files[1::2]
        del arguments[at : at + 2]
    count = int(arguments[0]) if arguments else 60
    changed = developed(count, learnt)
    report([float(ratio) for ratio in arguments[1:]] or RATIOS, count, tested, changed)


if __name__ == "__main__":
    main(sys.argv[1:])
