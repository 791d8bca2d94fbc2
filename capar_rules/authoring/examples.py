"""Examples in comments of a rule file: facts, and the names that must be inferred from them."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from capar.model.errors import CaparError, RuleError
from capar.model.facts import Fact, read_fact
from capar_rules.engine.profiles import Profile
from capar_rules.pars.inference import infer

_EXAMPLE = re.compile(r"%\*\s*(Example|Counter-example):\s*(.*?)\n(.*?)\*%", re.DOTALL)
_FACT = re.compile(r"([a-z]\w*(?:\([^()]*\))?)\.(?=\s|$)")


@dataclass(frozen=True)
class Example:
    """Facts, and the names of each link's segments that must be inferred from them."""

    story: str
    positive: bool
    """Whether the file's primitive must occur in it; in a counter-example it must not."""

    facts: tuple[Fact, ...]
    names: tuple[tuple[str, tuple[str, ...]], ...]
    """End-effector and names, in order."""

    line: int


@dataclass(frozen=True)
class Outcome:
    """An example with the names that were inferred."""

    example: Example
    found: tuple[tuple[str, tuple[str, ...]], ...]

    @property
    def met(self) -> bool:
        """Whether the names are those expected."""
        return dict(self.found) | dict(self.example.names) == dict(self.found)


def read_examples(text: str, *, file: Path | str = "") -> tuple[Example, ...]:
    """The examples of a rule file.

    Raises:
        RuleError: One has no facts, no expectation, or something that is no fact.
    """
    return tuple(_examples(text, str(file)))


def _examples(text: str, file: str) -> Iterator[Example]:
    for found in _EXAMPLE.finditer(text):
        line = text.count("\n", 0, found.start()) + 1
        story, body = found[2].strip(), found[3]
        rows = [each.strip() for each in body.splitlines()]
        expected = [each[2:].strip() for each in rows if each.startswith("=>")]
        stated = "\n".join("" if each.startswith("=>") else each for each in rows)
        facts = tuple(_facts(stated, f"in the example {story!r}: ", file, line + 1))
        if not facts or not expected:
            raise RuleError(
                f"{file}:{line}: the example {story!r} needs facts and a line such as "
                "=> right_hand: Reach, Lift"
            )
        names = tuple(_expectation(each, file, line) for each in expected)
        yield Example(story, found[1] == "Example", facts, names, line)


def _facts(stated: str, where: str, file: str, first: int) -> Iterator[Fact]:
    """Every fact of an example; nothing else may stand between them."""
    at = 0
    while rest := stated[at:].lstrip():
        at = len(stated) - len(rest)
        place = f"{file}:{first + stated.count(chr(10), 0, at)}: {where}"
        found = _FACT.match(stated, at)
        if found is None:
            told = rest.splitlines()[0].rstrip()
            raise RuleError(
                f"{place}{told!r} is no fact; a fact reads moving(cup, 0, 200). and "
                "ends with a full stop"
            )
        try:
            yield read_fact(found[1])
        except CaparError as error:
            raise RuleError(f"{place}{error}") from None
        at = found.end()


def _expectation(text: str, file: str, line: int) -> tuple[str, tuple[str, ...]]:
    ee, colon, names = text.partition(":")
    if not colon:
        raise RuleError(f"{file}:{line}: expected END_EFFECTOR: Name, Name; found {text!r}")
    return ee.strip(), tuple(each.strip() for each in names.split(",") if each.strip())


def try_examples(examples: Sequence[Example], *, profile: Profile) -> tuple[Outcome, ...]:
    """The names that the rules infer for each example.

    Raises:
        RuleError: The rules have an error.
    """
    outcomes = []
    for each in examples:
        links = infer(each.facts, profile=profile).links
        found = tuple((link.ee, tuple(one.name for one in link.segments)) for link in links)
        outcomes.append(Outcome(each, found))
    return tuple(outcomes)


def lacking(examples: Sequence[Example], name: str) -> tuple[str, ...]:
    """Which examples of a primitive are missing: one that it matches, one that it does not."""
    shown = {
        each.positive
        for each in examples
        if each.positive == any(name in names for _, names in each.names)
    }
    missing = []
    if True not in shown:
        missing.append(f"an Example in which {name} occurs")
    if False not in shown:
        missing.append(f"a Counter-example in which {name} does not occur")
    return tuple(missing)


def written(example: Example) -> str:
    """The example as a comment of a rule file."""
    kind = "Example" if example.positive else "Counter-example"
    lines = [f"%* {kind}: {example.story}"]
    lines += [f"   {each}." for each in example.facts]
    lines += [f"   => {ee}: {', '.join(names)}" for ee, names in example.names]
    return "\n".join(lines) + "\n*%\n"
