"""A plan carried out: captures observed and held against their labels, whatever these are about."""

from capar.evaluation.contacts import score_contacts
from capar.evaluation.events import score_events
from capar.evaluation.labels import Kind
from capar.evaluation.metrics import Evaluation
from capar.evaluation.objects import score_carries, score_containers
from capar.evaluation.plan import Plan, Progress
from capar.evaluation.scoring import score_actions
from capar_rules.engine.profiles import DEFAULT, Profile, profile

SCORERS = {
    Kind.ACTIONS: score_actions,
    Kind.CONTACTS: score_contacts,
    Kind.CARRIES: score_carries,
    Kind.EVENTS: score_events,
    Kind.CONTAINERS: score_containers,
}


def evaluate(
    plan: Plan, *, rules: Profile | str = DEFAULT, progress: Progress = iter
) -> Evaluation:
    """Observe the captures of a plan and compare what is printed or stored with their labels.

    Args:
        plan: Captures, labels, and what the labels are about.
        rules: The rule profile to observe with, or its name.
        progress: Goes through the captures, one after the other, and may show how far it is.

    Raises:
        CaparError: A capture, a label file or the mapping has a fault.
    """
    base = profile(rules) if isinstance(rules, str) else rules
    return SCORERS[plan.kind](plan, base, progress)
