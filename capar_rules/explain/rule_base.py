"""A profile's rules as explanations read them: parsed, with the sentences of their comments."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from capar_rules.engine.profiles import Profile
from capar_rules.engine.solver import rule_file
from capar_rules.engine.syntax import Statement, parse
from capar_rules.explain.sentences import Sentences


@dataclass(frozen=True, eq=False)
class RuleBase:
    """The rules of a profile with the sentence templates of their comments."""

    sentences: Sentences
    statements: tuple[Statement, ...]


def rule_base(profile: Profile) -> RuleBase:
    """The rules of a profile, parsed once."""
    return _rule_base(profile.files, profile.fingerprint)


@cache
def _rule_base(files: tuple[Path, ...], fingerprint: str) -> RuleBase:
    statements = parse((*files, rule_file("explain/explaining.lp")))
    return RuleBase(Sentences(statements), statements)
