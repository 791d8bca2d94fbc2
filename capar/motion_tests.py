"""Files of claims about captures, ``*.motion.toml``: read, and judged capture by capture."""

import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from capar.claims import ClaimError, Verdict, judge
from capar.model.errors import FileError
from capar.model.observation import Observation
from capar.observe import observe
from capar_rules.profiles import DEFAULT, profile
from capar_rules.teaching import user_rules

SUFFIX = ".motion.toml"

_EXAMPLE = (
    'Write captures = ["drink_*"] and, for each claim, [[expect]] with '
    'that = "right_hand MoveObjTo(mug, head)".'
)


@dataclass(frozen=True)
class MotionTest:
    """Claims, and the captures that they are made of."""

    path: Path
    captures: tuple[Path, ...]
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
        tuple(_captures(path, patterns)),
        tuple(str(each) for each in claims),
        str(content.get("profile", DEFAULT)),
        path.parent / str(rules) if rules else None,
    )


def run_motion_test(
    test: MotionTest, *, rules: Path | None = None, actionary: str | None = None
) -> Iterator[Verdict]:
    """Judge every claim of every capture.

    Args:
        test: The claims and captures.
        rules: Folder of the project's rules, where the test names none itself.
        actionary: An Actionary whose rules count too; None for CAPAR_ACTIONARY's.

    Raises:
        FileError: A claim cannot be read.
        CaparError: A capture cannot be read.
    """
    files = user_rules(test.rules or rules, actionary=actionary)
    for capture in test.captures:
        seen = _observed(capture, test.profile, files)
        for claim in test.claims:
            try:
                yield judge(claim, seen)
            except ClaimError as error:
                raise FileError(test.path, f"in the claim {claim!r}: {error}.") from None


def failures(verdicts: Sequence[Verdict]) -> tuple[Verdict, ...]:
    """Those that do not hold."""
    return tuple(each for each in verdicts if not each.holds)


@cache
def _observed(capture: Path, base: str, rules: tuple[Path, ...]) -> Observation:
    return observe(capture, rules=profile(base, added=rules))


def _content(path: Path) -> dict[str, object]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror}.", _EXAMPLE) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise FileError(path, f"is no TOML: {error}.", _EXAMPLE) from None


def _captures(path: Path, patterns: Sequence[str]) -> Iterator[Path]:
    for pattern in patterns:
        found = sorted(each for each in path.parent.glob(pattern) if _is_capture(each))
        if not found:
            raise FileError(path, f"no capture matches {pattern!r}.", _EXAMPLE)
        yield from found


def _is_capture(path: Path) -> bool:
    return path.suffix == ".toml" if path.is_file() else (path / "capture.toml").is_file()
