"""How long planning and inverse kinematics of a regeneration take, on one core.

Run as ``PYTHONPATH=.:tests OPENBLAS_NUM_THREADS=1 python benchmarks/regeneration_speed.py``.
"""

import hashlib
import time
from itertools import pairwise

from capar.body.scripted_actions import action_capture
from capar.pipelines.round_trips import body, numbered_scene, observed_source
from capar.regeneration.motion import perform_plan
from capar.regeneration.paths import Care
from capar.regeneration.planning import led, reachable
from capar.regeneration.quality import quality

RATE_HZ = 100.0
TRIPS = (("drink", "child", 2), ("pour", "woman", 1))
"""Action, agent, and number of the drawn scene."""


def timed(action: str, agent: str, number: int) -> str:
    """What one regeneration takes in seconds of processor time."""
    source = observed_source(action_capture(action, rate_hz=RATE_HZ))
    human, scene = body(agent, source), numbered_scene(source, number, 7)
    marks = [time.process_time()]
    draft = reachable(source, scene, human)
    marks.append(time.process_time())
    plan = led(draft, Care())
    marks.append(time.process_time())
    motion = perform_plan(plan)
    marks.append(time.process_time())
    verdict = quality(motion)
    marks.append(time.process_time())
    again = perform_plan(led(reachable(source, scene, human), Care()))
    same = hashlib.sha256(motion.postures.tobytes()).digest()
    repeated = hashlib.sha256(again.postures.tobytes()).digest()
    goals, ways, moving, verifying = (b - a for a, b in pairwise(marks))
    lasts = float(source.times[-1])
    return (
        f"{action} by the {agent}, {lasts:.1f} s at {RATE_HZ:.0f} Hz: "
        f"planning {goals + ways:.1f} s (goals and grips {goals:.1f}, ways of hands {ways:.1f}), "
        f"motion {moving:.1f} s, {lasts / moving:.1f} x real time, "
        f"verifying {verifying:.1f} s; failed: {', '.join(verdict.failed) or 'no gate'}; "
        f"{'the same' if same == repeated else 'OTHER'} bytes again"
    )


if __name__ == "__main__":
    for trip in TRIPS:
        print(timed(*trip), flush=True)
