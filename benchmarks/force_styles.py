"""Restitution and damping recovered from noisy captures, and what three bodies make of a blow.

A virtual man strikes a crate with a restitution of 0.3, 0.5 or 0.7 and a damping of 3 /s; each
place is recorded at 60 Hz with the noise of a MotionStar. Run as
``PYTHONPATH=.:tests python benchmarks/force_styles.py [SEEDS]``.
"""

import sys
from dataclasses import replace

import numpy as np
from virtual_bodies.striking import let_go, struck

from capar.pipelines.observation import observe
from capar.pipelines.round_trips import body, observed_source, round_trips
from capar.regeneration.forces import ForceKind
from capar.regeneration.search import regenerate
from capar.regeneration.styles import own_style

NOISE_M = 0.0015
DAMPING = 3.0
AGENTS = ("man", "woman", "child")


def recovered(seeds: int) -> None:
    print(f"recovered at {1e3 * NOISE_M:g} mm of noise, {seeds} seeds: mean, worst error, found")
    for true in (0.3, 0.5, 0.7):
        forces = [
            force
            for seed in range(seeds)
            for force in observe(struck(restitution=true, noise_m=NOISE_M, seed=seed)).forces
        ]
        es = np.array([force.restitution for force in forces])
        slowing = np.array([force.damping_per_s for force in forces])
        print(
            f"restitution {true}: {es.mean():.3f}, {np.abs(es - true).max():.3f}; "
            f"damping {DAMPING}: {slowing.mean():.3f}, {np.abs(slowing - DAMPING).max():.3f}; "
            f"{len(forces)} of {seeds}",
            flush=True,
        )


def performed() -> None:
    source = observed_source(struck())
    print("a blow at a crate that goes 1.20 m/s and 0.40 m in the recording")
    for kind in ForceKind:
        for agent in AGENTS:
            style = replace(own_style(source), force=kind)
            motion, found = regenerate(source, body(agent, source), None, style)
            (launch,) = source.launches
            path = motion.plan.things[launch.thing].translation[launch.frame :]
            pace = np.linalg.norm(path[1] - path[0]) * source.rate_hz
            print(
                f"{kind:8} {agent:6} crate {pace:.2f} m/s, {np.linalg.norm(path[-1] - path[0]):.3f}"
                f" m; {', '.join(found.failed) or 'every gate'}",
                flush=True,
            )


def trips() -> None:
    print("round trips: same PAR, every gate")
    for name, capture in (
        ("hit", struck()), ("push", let_go("slide")), ("throw", let_go("carry")),
    ):  # fmt: skip
        for trip in round_trips(observed_source(capture), AGENTS):
            good = trip.quality is not None and trip.quality.passed
            print(f"{name:6} {trip.agent:6} {trip.same_par} {good} {trip.refused}", flush=True)


if __name__ == "__main__":
    recovered(int(sys.argv[1]) if len(sys.argv) > 1 else 10)
    performed()
    trips()
