"""Things that were carried in recordings of others, performed by other bodies and observed again.

Run as ``CAPAR_DATA=DATA PYTHONPATH=.:tests python benchmarks/recorded_carries.py [CLIP ...]
[--agents AGENT ...] [--output FOLDER]``. Of each clip the part is performed that its file
``assumed.toml`` in ``examples`` states; a child has the scene of ``child.scene.toml``. The clips of
``omomo_intermimic`` are those in which a thing is wholly off the floor for half a second.
With ``--output`` the capture of each motion is written, so that it can be looked at.
"""

import argparse
import time
from collections.abc import Iterator
from pathlib import Path

from capar.pipelines.round_trips import Trip, body, observed_source, round_trip
from capar.regeneration.captures import capture_of, write_motion
from capar.regeneration.completing import read_completion
from capar.regeneration.errors import PlanError
from capar.regeneration.scene_files import read_scene

EXAMPLES = Path(__file__).parents[1] / "examples"
OMOMO = EXAMPLES / "omomo_intermimic"
PLACES = {
    "box_lift": (str(EXAMPLES / "pyomeca_box_lift"), EXAMPLES / "pyomeca_box_lift"),
    **{
        clip: (f"{OMOMO}/{capture}.toml:{clip}", OMOMO / clip)
        for clip, capture in {
            "sub2_largetable_003": "hands",
            "sub2_largetable_004": "hands",
            "sub2_largetable_005": "hands",
            "sub2_largetable_007": "hands",
            "sub2_largetable_008": "hands",
            "sub2_woodchair_000": "hands",
            "sub2_woodchair_001": "hands",
            "sub2_woodchair_002": "hands",
            "sub2_woodchair_005": "hands",
            "sub2_woodchair_006": "hands",
            "sub3_largebox_003": "largebox_hands",
        }.items()
    },
}
"""By clip: the capture, and how the paths of what is stated of it begin."""


def stated(clip: str, what: str) -> Path:
    """The file that states something of a clip: ``assumed`` or ``child.scene``."""
    place = PLACES[clip][1]
    return place / f"{what}.toml" if place.is_dir() else place.with_name(f"{clip}.{what}.toml")


def tried(clip: str, agent: str) -> tuple[Trip, float]:
    """One clip performed by one body, and the processor's time that it took [s]."""
    began = time.process_time()
    try:
        source = observed_source(PLACES[clip][0], read_completion(stated(clip, "assumed")))
    except PlanError as error:
        refused = Trip(agent, 0, str(error), None, False, False, False, "", None)
        return refused, time.process_time() - began
    changed = stated(clip, "child.scene")
    other = agent == "child" and changed.exists()
    scene = read_scene(changed, source.scene) if other else source.scene
    trip = round_trip(source, agent, body(agent, source), 0, scene)
    return trip, time.process_time() - began


def lines(clip: str, trip: Trip) -> Iterator[str]:
    """A trip for readers."""
    if trip.quality is None or trip.motion is None:
        yield f"{clip} {trip.agent}: not performed: {trip.refused}"
        return
    same = (trip.same_par, trip.same_contacts, trip.same_relations)
    words = ", ".join(
        f"{'the same' if held else 'OTHER'} {name}"
        for name, held in zip(("PAR", "contacts", "relations"), same, strict=True)
    )
    yield f"{clip} {trip.agent}: {words}; failed: {', '.join(trip.quality.failed) or 'no gate'}"
    if trip.names:
        yield f"    observed: {trip.names}"
    times = trip.motion.plan.source.times
    for gate in trip.quality.gates:
        at = f" at {times[gate.frame]:.2f} s" if gate.frame >= 0 else ""
        yield f"    {gate.name} {gate.value:.2f} {gate.unit} {gate.bodies}{at}"
    for note in trip.motion.plan.notes:
        if "grip" in note or "takes" in note or "stands" in note:
            yield f"    note: {note}"


def main() -> None:
    """Perform what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("clips", nargs="*", metavar="CLIP", help=", ".join(PLACES))
    parser.add_argument("--agents", nargs="+", default=["woman", "child"])
    parser.add_argument("--output", type=Path, help="folder to which captures are written")
    asked = parser.parse_args()
    for clip in asked.clips or PLACES:
        for agent in asked.agents:
            trip, seconds = tried(clip, agent)
            print("\n".join(lines(clip, trip)), f"\n    {seconds:.0f} s", flush=True)
            if asked.output and trip.motion:
                made = capture_of(trip.motion, name=clip, agent=agent)
                write_motion(trip.motion, made, asked.output / f"{clip}_{agent}")


if __name__ == "__main__":
    main()
