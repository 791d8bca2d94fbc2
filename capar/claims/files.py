"""Files of claims about captures, ``*.motion.toml``: read, and judged capture by capture."""

import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cache
from glob import glob
from pathlib import Path

from capar.claims.motion_claims import Verdict, judge
from capar.claims.names import Names, names_of
from capar.model.errors import CaparError, FileError
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from capar_rules.authoring.user_rules import user_rules
from capar_rules.engine.profiles import DEFAULT, Profile
from capar_rules.lint.admission import admitted_profile
from extractors.readers.bundle.capture_toml import read_capture, takes

SUFFIX = ".motion.toml"

_EXAMPLE = (
    'Write captures = ["drink_*"] and, for each claim, [[expect]] with '
    'that = "right_hand MoveObjTo(mug, head)".'
)


@dataclass(frozen=True)
class MotionTest:
    """Claims, and the captures that they are made of."""

    path: Path
    captures: tuple[str, ...]
    """Folders, or files, each with ``:TAKE`` where one of several takes is meant."""

    claims: tuple[str, ...]
    profile: str
    rules: Path | None


def read_motion_test(path: Path) -> MotionTest:
    """Read a file of claims.

    Raises:
        FileError: It cannot be read, says something unknown, or names no capture that there is.
    """
    content = _content(path)
    unknown = sorted(set(content) - {"captures", "expect", "profile", "rules"})
    if unknown:
        raise FileError(path, f"unknown key {unknown[0]!r}.", _EXAMPLE)
    patterns = content.get("captures", [])
    patterns = [patterns] if isinstance(patterns, str) else patterns
    expected = content.get("expect", [])
    if not isinstance(patterns, list) or not all(isinstance(each, str) for each in patterns):
        raise FileError(path, "captures is no list of patterns.", _EXAMPLE)
    if not isinstance(expected, list) or not expected:
        raise FileError(path, "it expects nothing.", _EXAMPLE)
    claims = [each.get("that") if isinstance(each, dict) else None for each in expected]
    if not all(isinstance(each, str) for each in claims):
        raise FileError(path, 'an [[expect]] has no that = "...".', _EXAMPLE)
    rules = content.get("rules")
    return MotionTest(
        path,
        tuple(dict.fromkeys(_captures(path, patterns))),
        tuple(str(each) for each in claims),
        str(content.get("profile", DEFAULT)),
        path.parent / str(rules) if rules else None,
    )


def run_motion_test(
    test: MotionTest, *, rules: Path | None = None, actionary: str | None = None
) -> Iterator[Verdict]:
    """Judge every claim of every capture; what cannot be judged is reported with the rest.

    Args:
        test: The claims and captures.
        rules: Folder of the project's rules, where the test names none itself.
        actionary: An Actionary whose rules count too; None for CAPAR_ACTIONARY's.

    Raises:
        CaparError: The rules have a fault, or there is no such profile.
    """
    files = user_rules(test.rules or rules, actionary=actionary)
    base = _base(test.profile, files)
    for capture in test.captures:
        for claim in test.claims:
            yield _verdict(claim, capture, base)


def _verdict(claim: str, capture: str, base: Profile) -> Verdict:
    name = Path(capture).name
    try:
        seen, names = _observed(capture, base)
        name = seen.capture
        return judge(claim, seen, names=names)
    except (CaparError, OSError) as error:
        return Verdict(claim, name, holds=False, found="", mistake=str(error))


@cache
def _base(name: str, added: tuple[Path, ...]) -> Profile:
    return admitted_profile(name, added=added)


@cache
def _observed(capture: str, base: Profile) -> tuple[Observation, Names]:
    trial = read_capture(capture)
    looking = (
        each.name
        for each in trial.sensors
        if each in trial.attending or each.end_effector == "head"
    )
    seen = observe(trial, rules=base)
    return seen, names_of(seen, rules=base, sensors=looking)


def _content(path: Path) -> dict[str, object]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror}.", _EXAMPLE) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise FileError(path, f"is no TOML: {error}.", _EXAMPLE) from None


def _captures(path: Path, patterns: Sequence[str]) -> Iterator[str]:
    for pattern in patterns:
        found = [str(each) for each in _places(path.parent, pattern)]
        if not found and ":" in pattern:
            found = _takes(path, pattern)
        if not found:
            raise FileError(path, f"no capture matches {pattern!r}.", _EXAMPLE)
        yield from found


def _places(folder: Path, pattern: str) -> list[Path]:
    """Captures that a pattern means, from that folder on or, absolute, from the root."""
    # Path.glob refuses absolute patterns.
    found = glob(pattern, root_dir=folder, recursive=True, include_hidden=True)  # noqa: PTH207
    return [folder / each for each in sorted(found) if _is_capture(folder / each)]


def _takes(path: Path, pattern: str) -> list[str]:
    """The takes that FOLDER:TAKE or FOLDER:* means, folders sorted, takes as they are declared.

    Raises:
        FileError: There are such folders, and none has such a take.
        CaparError: A capture.toml cannot be read.
    """
    stem, _, wanted = pattern.rpartition(":")
    folders = _places(path.parent, stem)
    known = [(each, take) for each in folders for take in takes(each)]
    found = [f"{each}:{take}" for each, take in known if fnmatchcase(take, wanted)]
    if folders and not found:
        names = ", ".join(dict.fromkeys(take for _, take in known))
        there = f"Its takes are: {names}." if names else "It is one capture without takes."
        raise FileError(path, f"no take matches {pattern!r}.", there)
    return found


def _is_capture(path: Path) -> bool:
    if path.is_file():
        return path.suffix == ".toml" and not path.name.endswith(SUFFIX)
    return (path / "capture.toml").is_file()
