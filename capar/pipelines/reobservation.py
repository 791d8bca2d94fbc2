"""What was observed of a capture, observed again by other rules from the very same files."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

from capar.model.capture import Capture
from capar.model.errors import FileError
from capar.model.facts import Fact
from capar.model.observation import Observation
from capar.pipelines.observation import observe_measured
from capar_rules.borders.deflicker import steady
from capar_rules.engine.profiles import Profile
from extractors.measure import measure
from extractors.readers.bundle.capture_toml import read_capture, takes
from kb.findings import Stored


def observe_again(
    files: Sequence[tuple[str, str]],
    known: Stored,
    measured: tuple[Fact, ...],
    rules: Profile,
    places: Sequence[Path],
) -> Observation:
    """The observation of the same files by other rules.

    Args:
        files: Path and SHA-256 of each file that it was made from.
        known: The observation as it is stored.
        measured: What was measured then; its flicker is resolved again only if it was then.
        rules: The rules that are to name its segments.
        places: Folders below which the files are.

    Raises:
        FileError: The files are not there, or have changed.
    """
    digests = sorted(digest for _, digest in files)
    for place in places:
        for path in sorted(place.rglob("*.toml")):
            if path.is_file() and sha256(path.read_bytes()).hexdigest() in digests:
                for trial in _trials(path, known.name):
                    if sorted(each.sha256 for each in trial.sources) == digests:
                        return _again(trial, known, measured, rules)
    searched = ", ".join(map(str, places))
    raise FileError(
        files[0][0] if files else known.name,
        f"and the other files from which {known.name!r} was observed are not below {searched}, or "
        "have changed; nothing was renamed.",
        "Name the folder that holds them with --captures, or observe and add it again.",
    )


def _again(
    trial: Capture, known: Stored, measured: tuple[Fact, ...], rules: Profile
) -> Observation:
    """A capture observed again, its flicker resolved if it was in what was measured then."""
    found = measure(trial)
    steadied = rules.steady
    for other in (rules.steady, not rules.steady):
        facts_then = steady(found.facts) if other else found.facts
        if set(facts_then) == set(measured):
            steadied = other
            break
    return observe_measured(trial, found, rules=replace(rules, steady=steadied), name=known.action)


def _trials(path: Path, name: str) -> Iterator[Capture]:
    """The captures that a file describes and that may bear a name: of its takes, or the one."""
    known = takes(path)
    # A capture is called after its take, so that the others need not be read.
    named = sorted((each for each in known if each in name), key=lambda each: (-len(each), each))
    for place in [f"{path}:{each}" for each in named] if known else [path]:
        trial = read_capture(place)
        if trial.name == name:
            yield trial
