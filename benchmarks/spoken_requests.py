"""Twenty requests in words, performed or refused: which came out as they should.

``python benchmarks/spoken_requests.py [--agent man] [--folder FOLDER] [--first 20]``: recordings of
the five actions that the requests were written for are made and observed in FOLDER, unless they are
there; without FOLDER in a temporary one.
"""

import argparse
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from spoken_worlds import RATE_HZ, Spoken, spoken, understood, world

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.recording import truth_of, write_bundle
from capar.body.scripted_actions import action_capture, performed
from capar.model.errors import CaparError
from capar.pipelines.observation import observe
from capar.pipelines.recordings import Recording, stored_recordings
from capar.pipelines.spoken_requests import after, perform
from kb import Actionary


def recordings(folder: Path, requests: list[Spoken]) -> tuple[Recording, ...]:
    """Recordings of the virtual man that requests are served by, in an Actionary."""
    recorded = sorted({name for each in requests for names in each.performs for name in names})
    with Actionary.open(folder / "actionary") as words:
        known = {stored.name for stored in words.observations()}
        for action in recorded:
            if action not in known:
                made = truth_of(performed(action, rate_hz=RATE_HZ))
                write_bundle(action_capture(action, rate_hz=RATE_HZ), made, folder / action)
                words.add(observe(folder / action))
        return stored_recordings(words, folder)[0]


def understanding(each: Spoken, known: tuple[Recording, ...]) -> tuple[bool, str]:
    """Whether the right recordings are chosen, or it is refused for the right reason."""
    try:
        chosen = understood(each, known)
    except CaparError as error:
        why = getattr(error, "why", "kind")
        return bool(each.refused) and why == each.refused, f"refused ({why}): {error}"
    served = [choice.recording.name for choice in chosen for _ in choice.requests]
    right = len(served) == len(each.performs) and all(
        name in names for name, names in zip(served, each.performs, strict=True)
    )
    return right, f"chosen: {', then '.join(served)}"


def performing(each: Spoken, known: tuple[Recording, ...], agent: str) -> tuple[bool, str]:
    """Whether it is performed, or refused as impossible where it should be; and how well."""
    told: list[str] = []
    try:
        place = world(each.world)
        for choice in understood(each, known):
            made = perform(choice, place, Human.of(ready_made(agent)))
            place = after(made, place)
            told.append(", ".join(made.quality.failed) or "every gate")
    except CaparError as error:
        why = getattr(error, "why", "kind")
        return why == each.refused, f"refused ({why}): {error}"
    return not each.refused, f"performed: {'; '.join(told)}"


def run(requests: list[Spoken], known: tuple[Recording, ...], agent: str) -> None:
    """First what is understood of every request, then the performances."""
    rows = {request: understanding(request, known) for request in requests}
    for each, (good, told) in rows.items():
        print(f"{'yes' if good else 'NO ':3}  {each.say!r} in {each.world}: {told}", flush=True)
    print(f"{sum(good for good, _ in rows.values())} of {len(rows)} understood as they should be")
    right = 0
    for each, (understood_right, told) in rows.items():
        good = understood_right
        if told.startswith("chosen"):
            began = time.process_time()
            done_right, done = performing(each, known, agent)
            good = done_right and (understood_right or bool(each.refused))
            seconds = time.process_time() - began
            print(
                f"{'yes' if good else 'NO ':3} {seconds:5.1f} s  {each.say!r}: {done}", flush=True
            )
        right += good
    print(f"{right} of {len(rows)} as they should be")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--agent", default="man", help="who performs: man, woman or child")
    parser.add_argument("--folder", type=Path, help="of the recordings")
    parser.add_argument("--first", type=int, default=20, help="how many requests")
    asked = parser.parse_args()
    requests = spoken()[: asked.first]
    with tempfile.TemporaryDirectory() as made:
        run(requests, recordings(asked.folder or Path(made), requests), asked.agent)


if __name__ == "__main__":
    main()
