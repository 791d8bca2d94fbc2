"""A performance with an effort, as much of it as limits and gates allow."""

from dataclasses import dataclass

from capar.body.human import Human
from capar.regeneration.errors import PlanError
from capar.regeneration.manner.efforts import Effort
from capar.regeneration.manner.measuring import MeasuredEffort, measured_effort
from capar.regeneration.manner.reshaping import with_effort
from capar.regeneration.motions import Motion
from capar.regeneration.quality import Quality
from capar.regeneration.regenerating import regenerate
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source
from capar.regeneration.style_kinds import Kind
from capar.regeneration.styles import Style, own_style, paced

SHARES = (1.0, 0.75, 0.5, 0.25, 0.0)
"""Shares of the effort that are tried [1]."""

DOUBLINGS = 0.5
"""A sudden performance is so many times halved in its time, a sustained one doubled [1]."""


@dataclass(frozen=True)
class EffortReport:
    """What effort was asked for, performed, and measured in the performed motion."""

    asked: Effort
    performed: Effort
    measured: MeasuredEffort
    why: str = ""
    """What did not allow more."""

    def __str__(self) -> str:
        """For people, in a line or two."""
        lines = [f"effort asked for: {self.asked}"]
        if self.why:
            share = _share(self.performed, self.asked)
            lines.append(
                f"effort performed: {self.performed}, {share:.2f} of it, since with more {self.why}"
            )
        return "\n".join([*lines, f"effort measured: {self.measured}"])


def regenerate_with_effort(
    source: Source,
    human: Human,
    scene: Scene | None = None,
    style: Style | None = None,
    *,
    effort: Effort,
    duration_s: float | None = None,
) -> tuple[Motion, Quality, EffortReport]:
    """Perform with an effort, or with the largest share of it that passes every gate.

    Args:
        source: The recorded performance.
        human: Who performs.
        scene: Where; as it was recorded, unless stated.
        style: How it is done without the effort; as it was recorded, unless stated.
        effort: How it is to be done.
        duration_s: How long it takes [s]; by the effort of time, unless stated.

    Raises:
        PlanError: It is impossible without any effort, too, or an effort has no meaning there.
    """
    style = style or own_style(source)
    check_effort(source, style, effort)
    found: list[tuple[Motion, Quality, float]] = []
    reasons: list[str] = []
    refused: PlanError | None = None
    for share in SHARES:
        part = effort.scaled(share)
        try:
            timed = paced(source, duration_s or _duration_s(source, part))
            motion, quality = regenerate(timed, human, scene, with_effort(style, timed, part))
        except PlanError as error:
            refused = error
            reasons.append(str(error))
            continue
        found.append((motion, quality, share))
        if quality.passed:
            break
        gates = [gate for gate in quality.gates if not gate.passed]
        reasons.append(
            ", ".join(f"{g.name} is {g.value:.2f} {g.unit}, limit {g.limit:g}" for g in gates)
        )
    if not found:
        assert refused is not None
        raise refused
    motion, quality, share = min(found, key=lambda made: (len(made[1].failed), -made[2]))
    why = reasons[SHARES.index(share) - 1] if share < 1.0 else ""
    report = EffortReport(effort, effort.scaled(share), measured_effort(motion, style), why)
    return motion, quality, report


def regenerate_in_manner(
    source: Source,
    human: Human,
    scene: Scene,
    style: Style,
    *,
    effort: Effort | None,
    duration_s: float | None,
) -> tuple[Motion, Quality, EffortReport | None]:
    """Perform with an effort if one is stated, and in a certain time if that is.

    Args:
        source: The recorded performance.
        human: Who performs.
        scene: Where.
        style: How it is done without the effort.
        effort: How it is to be done.
        duration_s: How long it takes [s].

    Raises:
        PlanError: It is impossible; the message says what would help.
    """
    if effort:
        return regenerate_with_effort(
            source, human, scene, style, effort=effort, duration_s=duration_s
        )
    source = paced(source, duration_s) if duration_s else source
    return *regenerate(source, human, scene, style), None


def check_effort(source: Source, style: Style, effort: Effort) -> None:
    """Whether an effort can have its effect there.

    Raises:
        PlanError: It cannot; the message says what would do.
    """
    set_going = [(launch.frame, launch.thing) for launch in source.launches]
    set_going += [(toss.first, toss.thing) for toss in source.tosses]
    if set_going:
        frame, thing = min(set_going)
        raise PlanError(
            f"an effort would change the speed at which {thing!r} is struck or let go at "
            f"{source.times[frame]:.2f} s; --force says what is kept of that: leave out "
            "--effort, or the adverb"
        )
    if style.kind is Kind.EVEN:
        raise PlanError(
            "style 'even' has its own speeds and straight ways, on which an effort has no effect; "
            "--style path or frame would do"
        )
    if style.kind is Kind.VEL and effort.space:
        raise PlanError(
            "style 'vel' goes straight, so that space has no effect; --style path or frame would do"
        )


def _duration_s(source: Source, effort: Effort) -> float:
    """How long it takes with an effort [s]."""
    recorded_s = float(source.times[-1] - source.times[0])
    return float(recorded_s * 2.0 ** (-DOUBLINGS * effort.time))


def _share(performed: Effort, asked: Effort) -> float:
    pairs = zip(performed.values.values(), asked.values.values(), strict=True)
    return max((done / wanted for done, wanted in pairs if wanted), default=1.0)
