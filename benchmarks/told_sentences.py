"""Whether timed descriptions of real recordings agree with the captures, step by step.

Run by hand: ``PYTHONPATH=tests python benchmarks/told_sentences.py [--kept FOLDER] [TAKE ...]``
with ``CAPAR_DATA``. A take is a place that ``capar observe`` takes: ``omomo_intermimic:NAME``.

Each told step is compared with the numbers of the capture alone (``tests/told_checks.py``), which
know of no rules, contacts or segments: when a thing rises, comes to rest, turns and how far; when
the head sinks and rises; when feet swing, and whether they come nearer; which hand is at the thing.
A time may be off by 0.3 s. Printed are the steps that something contradicts, and how many steps and
comparisons there were. Observing all takes needs about half an hour; with a folder, captures and
observations are kept there and read again the next time.
"""

import argparse
import os
import pickle
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from told_checks import Numbers, checked

from capar.model.capture import Capture
from capar.model.observation import Observation
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from capar.pipelines.observation import observe_measured
from capar.pipelines.trials import trial_of
from extractors.measure import measure
from kb.language.describe import describe
from kb.language.realisation import alike, nouns
from kb.lexicon.english import noun, ordinal

ROOT = Path(__file__).parents[1]
DEMO = ROOT / "capar" / "demo" / "drink_from_mug"
CARRIED = (
    *(f"sub2_largetable_{number:03d}" for number in (0, 1, 2, 3, 4, 5, 7, 8, 9)),
    *(f"sub2_woodchair_{number:03d}" for number in range(7)),
)
REACHED = (
    *("BackLow01", "ForwardHigh01", "ForwardLow01", "ForwardMediumMid01", "Left30Low01"),
    *("Left60MediumNear01", "Right120Low01", "Right30MediumMid01"),
)
PACKED = (1, 2, 17, 23, 30, 34, 39, 40, 45, 48, 50, 52, 62, 64, 76, 78)
TAKES = (
    "demo",
    "hand_embodiment_pillow",
    "pyomeca_box_lift",
    *(f"manipnet:{name}" for name in ("cube_med2", "cup1", "mug1")),
    *(f"bimacs_optitrack:take{number}" for number in range(10)),
    *(f"omomo_intermimic/hands.toml:{name}" for name in CARRIED),
    "omomo_intermimic/largebox_hands.toml:sub3_largebox_003",
    *(f"omomo_intermimic:{name}" for name in CARRIED),
    "omomo_intermimic/largebox.toml:sub3_largebox_003",
    *(f"smartbody_mocap_reaching:Reach{name}" for name in REACHED),
    "boxed_vr",
    *(f"boxed_vr/scenes.toml:p{number}_s1" for number in PACKED),
)


MOVED_M = 0.1
"""A thing that is so far [m] from where it was at first has begun to move."""


def observed(take: str, kept: Path | None) -> tuple[Observation, Capture]:
    """What was understood of a take, and its capture."""
    name = take.replace("/", ".").replace(":", ".")
    files = [] if kept is None else [kept / f"{name}.{what}" for what in ("pickle", "capture")]
    if files and all(file.exists() for file in files):
        observation, capture = (pickle.loads(file.read_bytes()) for file in files)
        return observation, capture
    capture = trial_of(DEMO if take == "demo" else ROOT / "examples" / take)
    observation = observe_measured(capture, measure(capture))
    for file, value in zip(files, (observation, capture), strict=bool(files)):
        file.write_bytes(pickle.dumps(value))
    return observation, capture


def in_order(called: Mapping[str, str], numbers: Numbers) -> dict[str, str]:
    """Things that are alike by how they are spoken of: in the order in which they begin to move."""
    found: dict[str, str] = {}
    begins = {}
    for name in called:
        places = numbers.middle(name)
        seen = places[~np.isnan(places).any(axis=1)]
        begins[name] = int(np.argmax(np.linalg.norm(places - seen[0], axis=1) > MOVED_M))
    for name in sorted(called, key=lambda name: begins[name] or len(numbers.times)):
        count = sum(called[other] == called[name] for other in found.values()) + 1
        found[f"{ordinal(count)} {called[name]}" if count > 1 else called[name]] = name
    return found


def main() -> None:
    """Check the takes."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("takes", nargs="*", metavar="TAKE")
    parser.add_argument("--kept", type=Path, help="folder of captures and observations")
    given = parser.parse_args()
    if "CAPAR_DATA" not in os.environ:
        parser.error("CAPAR_DATA names no folder of recordings")
    words = primitive_words(primitive_files())
    steps = compared = contradicted = unchecked = 0
    for take in given.takes or TAKES:
        observation, capture = observed(take, given.kept)
        called = nouns(observation.objects)
        things = {
            noun(called.get(thing.name, thing.name)): thing.name for thing in observation.objects
        }
        things |= in_order(alike(observation.objects), Numbers(capture))
        text = describe(observation, timed=True, words=words)
        for found in checked(text, capture, things):
            steps += 1
            compared += found.compared
            unchecked += not found.compared
            contradicted += bool(found.wrong)
            if found.wrong:
                spans = ", ".join(f"{start:.2f}-{end:.2f} s" for start, end in found.claim.spans)
                print(f"{take}: {found.claim.said} ({spans}): {'; '.join(found.wrong)}")
    print(f"{steps} told steps, {compared} comparisons, {unchecked} steps without any")
    print(f"{contradicted} steps are contradicted")


if __name__ == "__main__":
    main()
