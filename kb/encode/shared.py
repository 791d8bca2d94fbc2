"""Nodes that several observations share: actions, kinds, features, conditions, rules."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from pyoxigraph import NamedNode

from capar.model.par import UNKNOWN, Condition, FeatureSet
from kb.store import names
from kb.store.statements import LABEL, Statements
from ontology import CAPAR
from ontology.namespace import PREFIXES, PROV

if TYPE_CHECKING:
    from capar.model.observation import ObservedObject
    from capar.model.par import NamingRule

USED = NamedNode(PROV + "used")
DERIVED = NamedNode(PROV + "wasDerivedFrom")
GENERATED = NamedNode(PROV + "wasGeneratedBy")
ASSOCIATED = NamedNode(PROV + "wasAssociatedWith")
ENDED = NamedNode(PROV + "endedAtTime")
BROADER = NamedNode(PREFIXES["skos"] + "broaderTransitive")


def action(out: Statements, name: str) -> NamedNode | None:
    """The node of an action; the unknown has none."""
    if name in {"", UNKNOWN}:
        return None
    node = names.shared("action", name)
    return out.share(node, (CAPAR.Action,), {LABEL: name, CAPAR.name: name, CAPAR.kindOf: node})


def actions(out: Statements, known: Iterable[str]) -> list[NamedNode]:
    """Those of several actions."""
    return [node for each in known if (node := action(out, each)) is not None]


def kind_of(seen: "ObservedObject") -> str:
    """The noun under which an object's knowledge is kept: its kind, else its own name."""
    return seen.kind or seen.name


def kind(out: Statements, name: str) -> NamedNode:
    """A kind of object; one outside the hierarchy is just an object."""
    node = names.shared("kind", name)
    if names.graph_of(node) == names.GRAPHS["ontology"]:
        return node
    above = [names.shared("kind", general) for general in ("object", "thing")]
    return out.share(
        node,
        (CAPAR.ObjectKind,),
        {LABEL: name.replace("_", " "), CAPAR.name: name, CAPAR.isA: [node, *above]},
    )


def features(out: Statements, value: FeatureSet) -> NamedNode:
    """A set of features, named after its bits."""
    bits = {
        CAPAR.relStart: value.rel_start,
        CAPAR.relEnd: value.rel_end,
        CAPAR.changeLoc: value.change_loc,
        CAPAR.effectorType: value.end_effector,
        CAPAR.forceApplied: value.force,
    }
    return out.share(
        names.shared("features", *bits.values()),
        (CAPAR.FeatureSet,),
        {**bits, CAPAR.objectCount: value.count},
    )


def conditions(out: Statements, values: Iterable[Condition]) -> list[NamedNode]:
    """Conditions, each named after what it says."""
    return [
        out.share(
            names.shared("condition", each.kind, *each.arguments, *([] if each.holds else ["not"])),
            (CAPAR.Condition,),
            {
                LABEL: f"{'' if each.holds else 'not '}{each.kind}({', '.join(each.arguments)})",
                CAPAR.conditionKind: each.kind,
                CAPAR.parameters: " ".join(each.arguments),
                CAPAR.holds: each.holds,
            },
        )
        for each in values
    ]


def rule_base(out: Statements, digest: str) -> NamedNode:
    """The rule base of a digest."""
    return out.share(
        names.shared("rules", digest),
        (CAPAR.RuleBase,),
        {LABEL: f"rules {digest[:12]}", CAPAR.sha256: digest},
    )


def rule(out: Statements, value: "NamingRule") -> NamedNode:
    """The rule behind a name; one of the same text and thresholds is the same."""
    return out.share(
        names.shared("rule", value.name, names.hashed(value)),
        (CAPAR.Rule,),
        {
            LABEL: f"rule of {value.name}",
            CAPAR.name: value.name,
            CAPAR.filePath: value.file,
            CAPAR.sha256: value.sha256,
            CAPAR.ruleText: value.text,
            CAPAR.threshold: [
                out.share(
                    names.shared("threshold", each.name, each.value),
                    (CAPAR.Threshold,),
                    {LABEL: each.name, CAPAR.name: each.name, CAPAR.thresholdValue: each.value},
                )
                for each in value.thresholds
            ],
        },
    )
