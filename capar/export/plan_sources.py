"""What plans for other programs are written from: a complex action and the PARs of its steps."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from capar.model.errors import CaparError
from capar.model.par import ComplexPar, Condition, Ipar, Step, Upar

GENERAL_KIND = "object"
"""The kind of what no kind was stated of."""

HOLDER = "EE"
"""The parameter of a condition that stands for the end-effector."""


class PlanExportError(CaparError):
    """An action that cannot be written as a plan."""


@dataclass(frozen=True, slots=True)
class PlanStep:
    """A step, the instantiated PAR of it, and the uninstantiated one that it is a case of."""

    step: Step
    ipar: Ipar
    upar: Upar

    @property
    def moves(self) -> bool:
        """Whether the step moves its dominant object."""
        return bool(self.ipar.core.moved)

    @property
    def lasts(self) -> bool:
        """Whether it ends when its time is over, rather than when a contact changes."""
        return any(each.kind == "duration" for each in self.upar.core.termination)

    @property
    def rests(self) -> bool:
        """Whether it ends in a posture rather than in a contact."""
        return not any(each.holds for each in self.upar.post_assertions)


@dataclass(frozen=True, slots=True)
class PlanSource:
    """A complex action, whatever it was read from."""

    name: str
    agent: str
    duration_s: float
    links: Mapping[str, tuple[PlanStep, ...]]
    """Steps by end-effector, a step common to all links as the last of each."""

    common: Step | None
    par: ComplexPar
    kinds: Mapping[str, tuple[str, ...]]
    """The kind of every object, and the more general ones above it, nearest first."""

    looks: tuple[tuple[str, float, float], ...] = ()
    """What was looked at, from when to when [s]."""

    @property
    def steps(self) -> tuple[PlanStep, ...]:
        """Every step, link by link."""
        return tuple(each for steps in self.links.values() for each in steps)


def plan_source(
    par: ComplexPar,
    ipars: Iterable[Ipar],
    upars: Iterable[Upar],
    kinds: Mapping[str, tuple[str, ...]],
    *,
    name: str,
    looks: Iterable[tuple[str, float, float]] = (),
) -> PlanSource:
    """A complex action with the PARs of its steps.

    Args:
        par: The complex action.
        ipars: The instantiated actions of its observation, in order of time for each link.
        upars: The uninstantiated actions that they are cases of.
        kinds: Of every object, its kind and those above it.
        name: What the action is called.
        looks: What was looked at, from when to when [s].

    Raises:
        PlanExportError: It has no steps, or a step has no PAR.
    """
    by_link: dict[str, list[Ipar]] = {}
    for each in ipars:
        by_link.setdefault(each.ee, []).append(each)
    known = tuple(upars)
    links = {
        link.ee: tuple(
            _plan_step(step, by_link.get(link.ee, []), known) for step in _own_steps(par, link.ee)
        )
        for link in par.links
    }
    if not any(links.values()):
        raise PlanExportError(f"{name!r} has no steps; observe a capture in which a hand acts")
    agent = next(iter(by_link.values()))[0].agent
    return PlanSource(name, agent, par.duration_s, links, par.common, par, kinds, tuple(looks))


def bound_condition(upar: Upar, ipar: Ipar, condition: Condition) -> tuple[str, ...]:
    """The arguments of a UPAR's condition, as an IPAR binds them."""
    names = dict(zip(upar.objects, ipar.objects, strict=True))
    names |= {upar.agent: ipar.agent, HOLDER: ipar.ee}
    return tuple(names.get(each, each) for each in condition.arguments)


def _own_steps(par: ComplexPar, ee: str) -> tuple[Step, ...]:
    """A link's steps; one that all share is done by each."""
    (own,) = [link for link in par.links if link.ee == ee]
    return (*own.steps, par.common) if par.common else own.steps


def _plan_step(step: Step, ipars: list[Ipar], upars: tuple[Upar, ...]) -> PlanStep:
    found = [
        each
        for each in ipars
        if each.upar == step.action and (step.ee == "all" or each.objects == step.objects)
    ]
    number = step.segments[0] if step.ee != "all" else -1
    fitting = [ipars[number]] if 0 <= number < len(ipars) else found[-1:]
    if not fitting or fitting[0].upar != step.action:
        raise PlanExportError(f"step {step.action!r} of {step.ee!r} has no PAR of its own")
    (ipar,) = fitting
    for upar in upars:
        same = upar.core.constraint.features == ipar.core.constraint.features
        if upar.name == ipar.upar and same:
            return PlanStep(step, ipar, upar)
    raise PlanExportError(f"no action {ipar.upar!r} with the features of step {step.action!r}")
