"""The audit of a profile: its shipped rules together with those of users."""

from capar_rules.engine.profiles import Profile
from capar_rules.engine.profiles import profile as shipped
from capar_rules.engine.syntax import parse
from capar_rules.lint.audit import ASKED, Audit, evaluate, summarise
from capar_rules.lint.firing import Firing
from capar_rules.lint.text_checks import known
from capar_rules.lint.trials import Trial


def audit(profile: Profile) -> Audit:
    """Audit the rules of a profile.

    Primitives of users with conditions that the worlds cannot decide are told apart from those
    that no segment can fit.

    Raises:
        RuleError: The rules have an error.
    """
    rules = parse(profile.files)
    base = parse(shipped(profile.name).files)
    files = {each.place.file for each in base}
    added = [each for each in rules if each.place.file not in files]
    soft = Firing(Trial(added, known(base))).relaxation.soft_names if added else frozenset()
    return summarise(evaluate(rules, ASKED), undecided=soft)
