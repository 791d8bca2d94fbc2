"""Is the performer whose style was borrowed found again from the regenerated motion alone?

Thesis 5.4 asked six people. Here some performers do one reach each six times; their styles are
measured and fixed. Then bodies of other sizes, in drawn scenes, borrow the style of a seventh or
later trial, and the nearest of the performers by the measured style of the motion is named: by the
plain distance, and by one that weights what performing changes less. That one is measured on other
performers, the development half, before; none of them is in the test.

Run as ``PYTHONPATH=. python benchmarks/performer_styles.py [TRIALS [RATIO ...]]``: five virtual
performers, five others for development. With ``--real NPZ_FOLDER`` the performers' usual ways are
the reaches of ``smartbody_mocap_reaching``, every second one by name for development, the others
for the test; with ``--all`` the test is of all of them besides. The ratio 0 takes them as they are.
Virtual performers reach for a box on a table, real ones for a target in free air; ``--setting``
states another (``table``, ``free``). ``--develop`` leaves out the test: of two draws of the
development half, each is told by what the other teaches.
"""

import argparse
from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float
from reach_settings import SIDE, Setting, draft, source
from scipy.spatial.transform import RigidTransform

from capar.regeneration.hand_paths import Care
from capar.regeneration.motions import perform_plan
from capar.regeneration.path_mapping import STRAIGHT
from capar.regeneration.planning import led
from capar.regeneration.style_distances import (
    StyleMetric,
    WayStyle,
    between_distance,
    nearest_between,
    nearest_performer,
    style_distance,
    style_metric,
    way_style,
    within_distance,
)
from capar.regeneration.styles import Style, borrowed_style

SEED, DEVELOPMENT_SEED = 54, 155
DEVELOPMENT_RATIO = 3.0
PERFORMERS, TRIALS = 5, 6
AGENTS, SCENES = ("man", "woman", "child"), 4
RATIOS = (0.0, 3.0, 2.0, 1.5, 1.25, 1.0)

WITHIN = np.array([0.012, 0.008, 0.012, 0.008, 0.02, 0.015])
"""How much one performer's trials vary: bumps to the side and upwards, once and twice a way [m],
and twists of the timing [1]."""

Ways = Sequence[Float[np.ndarray, "frames 3"]]


def reach(setting: Setting) -> int:
    """The frame at which the hand arrives."""
    return source(setting).holds[0].first


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


def usual_ways(setting: Setting, real: Sequence[Path]) -> Ways:
    """What the performers' ways have in common: the recorded reach, or a real one of each."""
    own = source(setting).hands[SIDE].path.translation[: reach(setting) + 1]
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

    def __init__(
        self, ratio: float, real: Sequence[Path], setting: Setting, seed: int = SEED
    ) -> None:
        self.setting, self.asked = setting, ratio
        self.ways, self.real = usual_ways(setting, real), bool(real)
        self.names = [path.stem for path in real] or [f"performer_{n}" for n in range(PERFORMERS)]
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
            name: [way_style(self.way(who, noise)) for noise in self.noise[who]]
            for who, name in enumerate(self.names)
        }

    @property
    def ratio(self) -> float:
        """Mean distance between performers over that within."""
        trials = self._trials()
        return between_distance(trials) / within_distance(trials)


def borrowed(way: np.ndarray, setting: Setting) -> Style:
    """The style of a trial in which the hand came that way."""
    own = source(setting)
    track = own.hands[SIDE]
    spots = np.array(track.path.translation)
    spots[: len(way)] = way
    path = RigidTransform.from_components(spots, track.path.rotation)
    hands = {**own.hands, SIDE: replace(track, path=path)}
    return borrowed_style(own, replace(own, hands=hands))


@dataclass(frozen=True, eq=False)
class Borrowed:
    """A style that was borrowed, and what came of it."""

    who: str
    agent: str
    scene: int
    given: WayStyle
    planned: WayStyle
    made: WayStyle
    detour_m: float
    """How far the way was led around something [m]."""


def regenerated(way: np.ndarray, who: str, agent: str, scene: int, setting: Setting) -> Borrowed:
    """The motion of another body that borrowed a style."""
    own = copy(draft(setting, agent, scene))
    own.style = borrowed(way, setting)
    motion = perform_plan(led(own, Care()))
    plan = motion.plan
    palm = plan.human.sites(motion.postures, [f"{SIDE}_palm"])[f"{SIDE}_palm"][0]
    planned = (plan.hands[SIDE] * plan.frames.palms[SIDE]).translation
    last = reach(setting) + 1
    came, made = (way_style(spots[:last]) for spots in (planned, palm))
    around = plan.detours.get((SIDE, 0), STRAIGHT)
    return Borrowed(who, agent, scene, way_style(way), came, made, around.size)


def performances(performers: Performers, count: int) -> list[Borrowed]:
    """Further trials, each borrowed by a body in a scene: every performer by all bodies in turn."""
    out = []
    for number in range(count):
        turn, who = divmod(number, performers.count)
        way = performers.way(who, performers.rng.normal(size=len(WITHIN)))
        agent = AGENTS[(2 * turn + who) % len(AGENTS)]
        scene = 1 + (who + turn // len(AGENTS)) % SCENES
        out.append(regenerated(way, performers.names[who], agent, scene, performers.setting))
    return out


Changed = Sequence[tuple[WayStyle, WayStyle]]


def changed(done: Sequence[Borrowed]) -> Changed:
    """What performing made of each style."""
    return [(one.given, one.made) for one in done]


HEADINGS = (
    "asked ratio  within  between  ratio  nearest pair  given ways, weighted  plain, weighted  "
    "changed by  of it performing  led around"
)


def report(performers: Performers, done: Sequence[Borrowed], learnt_change: Changed) -> None:
    """Print who was found, and who was taken for whom."""
    trials = performers.trials
    metric: StyleMetric = style_metric(trials, learnt_change)
    given, made = [one.given for one in done], [one.made for one in done]
    alone, plain = ([nearest_performer(style, trials) for style in some] for some in (given, made))
    known, weighted = (
        [metric.nearest_performer(style, trials) for style in some] for some in (given, made)
    )
    right = [
        sum(name == one.who for name, one in zip(names, done, strict=True))
        for names in (alone, known, plain, weighted)
    ]
    within, between = (d(trials) for d in (within_distance, between_distance))
    lost = np.mean([style_distance(one.given, one.made) for one in done])
    solved = np.mean([style_distance(one.planned, one.made) for one in done])
    around = sum(one.detour_m > 0.0 for one in done)
    print(
        f"{performers.asked:11.2f}  {within:6.3f}  {between:7.3f}  {between / within:5.2f}  "
        f"{nearest_between(trials) / within:12.2f}  {right[0]:10d}  {right[1]:8d}  "
        f"{right[2]:5d}  {right[3]:8d}  {lost:10.2f}  {solved:16.2f}  {around:10d} of {len(done)}",
        flush=True,
    )
    for one, name, nearest in zip(done, weighted, alone, strict=True):
        if name != one.who:
            own = np.mean([style_distance(one.given, trial) for trial in trials[one.who]])
            print(
                f"    {one.who} taken for {name}: {one.agent} in scene {one.scene}, changed by "
                f"{style_distance(one.given, one.made):.2f}, led around by "
                f"{1e3 * one.detour_m:.0f} mm, its given way {own:.2f} from its own and nearest to "
                f"{nearest}",
                flush=True,
            )


def develop(count: int, ratios: Sequence[float], real: Sequence[Path], setting: Setting) -> None:
    """Two draws of the development half, each told by what the other teaches."""
    for ratio in ratios:
        seeds = (DEVELOPMENT_SEED, DEVELOPMENT_SEED + 1)
        draws = [Performers(ratio, real, setting, seed) for seed in seeds]
        done = [performances(performers, count) for performers in draws]
        for performers, own, other in zip(draws, done, done[::-1], strict=True):
            report(performers, own, changed(other))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("trials", nargs="?", type=int, default=60)
    parser.add_argument("ratios", nargs="*", type=float, default=RATIOS)
    parser.add_argument("--real", type=Path)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--develop", action="store_true")
    parser.add_argument("--setting", type=Setting, choices=list(Setting))
    asked = parser.parse_args()
    files = sorted(asked.real.glob("*.npz")) if asked.real else []
    setting = asked.setting or (Setting.FREE if files else Setting.TABLE)
    print(HEADINGS)
    if asked.develop:
        develop(asked.trials, asked.ratios, files[0::2], setting)
        return
    learnt = Performers(DEVELOPMENT_RATIO, files[0::2], setting, DEVELOPMENT_SEED)
    learnt_change = changed(performances(learnt, asked.trials))
    for tested in [files[1::2], files] if asked.all else [files[1::2]]:
        for ratio in asked.ratios:
            performers = Performers(ratio, tested, setting)
            report(performers, performances(performers, asked.trials), learnt_change)


if __name__ == "__main__":
    main()
