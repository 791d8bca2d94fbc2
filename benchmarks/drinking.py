"""Man, woman and child drink from a mug in five scenes each, and are observed by both profiles.

Bodies perform, a tracker records, contact and rules name: the steps should be the same for all.

Run as ``PYTHONPATH=.:tests python benchmarks/drinking.py [NOISE_MM [RATE_HZ]]``.
"""

import sys
import time

from virtual_bodies.drinking import AGENTS, PROFILES, SCENES, drinking, steps_of

from capar.body.performing import PerformanceError
from capar.pipelines.observation import observe


def row(who: str, number: int, noise_mm: float, rate_hz: float) -> dict[str, tuple[str, ...]]:
    """Perform once and print a line for each profile; the steps by profile."""
    began = time.process_time()
    try:
        capture = drinking(who, number, noise_m=noise_mm / 1e3, rate_hz=rate_hz)
    except PerformanceError as error:
        print(f"{who:6} {number} not performed: {error}", flush=True)
        return dict.fromkeys(PROFILES, ("not performed",))
    made_s = time.process_time() - began
    out = {}
    for profile in PROFILES:
        out[profile] = steps_of(observe(capture, rules=profile))
        print(f"{who:6} {number} {made_s:5.1f} s {profile:8} {', '.join(out[profile])}", flush=True)
    return out


def main() -> None:
    noise_mm = float(sys.argv[1]) if len(sys.argv) > 1 else 0.0
    rate_hz = float(sys.argv[2]) if len(sys.argv) > 2 else 60.0
    found = [row(who, n, noise_mm, rate_hz) for who in AGENTS for n in range(len(SCENES))]
    for profile in PROFILES:
        kinds: dict[tuple[str, ...], int] = {}
        for trial in found:
            kinds[trial[profile]] = kinds.get(trial[profile], 0) + 1
        for steps, count in sorted(kinds.items(), key=lambda kind: -kind[1]):
            print(f"{profile}: {count} of {len(found)}: {', '.join(steps)}")


if __name__ == "__main__":
    main()
