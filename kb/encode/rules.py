"""The rules that named segments, with their texts and thresholds, as statements."""

from typing import TYPE_CHECKING

from pyoxigraph import NamedNode

from kb.store import names
from kb.store.statements import LABEL, Statements
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.observation import Observation
    from capar.model.par import NamingRule, Threshold


def rule_base(out: Statements, observation: "Observation") -> NamedNode:
    """The rule base that an observation was made with."""
    return out.share(
        names.shared("rules", observation.rules),
        (CAPAR.RuleBase,),
        {LABEL: f"rules {observation.rules[:12]}", CAPAR.sha256: observation.rules},
    )


def naming_rules(out: Statements, observation: "Observation") -> dict[str, NamedNode]:
    """The rule behind each name, by name; a rule of the same text and thresholds is one."""
    return {each.name: _rule(out, each) for each in observation.naming}


def _rule(out: Statements, rule: "NamingRule") -> NamedNode:
    return out.share(
        names.shared("rule", rule.name, names.hashed(rule)),
        (CAPAR.Rule,),
        {
            LABEL: f"rule of {rule.name}",
            CAPAR.name: rule.name,
            CAPAR.filePath: rule.file,
            CAPAR.sha256: rule.sha256,
            CAPAR.ruleText: rule.text,
            CAPAR.threshold: [_threshold(out, each) for each in rule.thresholds],
        },
    )


def _threshold(out: Statements, threshold: "Threshold") -> NamedNode:
    return out.share(
        names.shared("threshold", threshold.name, threshold.value),
        (CAPAR.Threshold,),
        {
            LABEL: threshold.name,
            CAPAR.name: threshold.name,
            CAPAR.thresholdValue: threshold.value,
        },
    )
