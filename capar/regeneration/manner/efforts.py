"""Effort: four parameters of manner, each from one pole to the other (Chi et al. 2000)."""

from dataclasses import dataclass, fields, replace

from capar.model.errors import CaparError, UnknownNameError

POLES = {
    "time": ("sustained", "sudden"),
    "weight": ("light", "strong"),
    "space": ("indirect", "direct"),
    "flow": ("free", "bound"),
}
"""The pole at -1 and the one at +1 of each parameter."""


@dataclass(frozen=True, slots=True)
class Effort:
    """How something is done, compared with how it was recorded: 0 is as recorded.

    D. Chi, M. Costa, L. Zhao and N. Badler, The EMOTE model for effort and shape (SIGGRAPH 2000).
    """

    time: float = 0.0
    """From sustained (-1) to sudden (1)."""

    weight: float = 0.0
    """From light (-1) to strong (1)."""

    space: float = 0.0
    """From indirect (-1) to direct (1)."""

    flow: float = 0.0
    """From free (-1) to bound (1)."""

    def __post_init__(self) -> None:
        """Check that every parameter is between its poles.

        Raises:
            CaparError: One is not.
        """
        for name, value in self.values.items():
            if not -1.0 <= value <= 1.0:
                low, high = POLES[name]
                raise CaparError(
                    f"effort {name} = {value:g}; it is from -1 ({low}) to 1 ({high}), 0 being as "
                    "recorded"
                )

    @property
    def values(self) -> dict[str, float]:
        """By parameter."""
        return {field.name: float(getattr(self, field.name)) for field in fields(self)}

    def scaled(self, share: float) -> "Effort":
        """The same manner, less of it."""
        return Effort(**{name: share * value for name, value in self.values.items()})

    def __str__(self) -> str:
        """The parameters, as a user would state them."""
        return ", ".join(f"{name} {value:+.2f}" for name, value in self.values.items())


def read_effort(text: str) -> Effort:
    """An effort from ``time=0.6,weight=-0.3`` or the names of poles, ``sudden=0.6,light=0.3``.

    Raises:
        UnknownNameError: There is no such parameter or pole.
        CaparError: A value is no number or beyond a pole, or a parameter is stated twice.
    """
    out, stated = Effort(), set()
    for part in filter(None, (item.strip() for item in text.split(","))):
        name, _, said = (word.strip() for word in part.partition("="))
        parameter, sign = _parameter(name.lower())
        try:
            value = sign * float(said)
        except ValueError:
            raise CaparError(
                f"--effort {part!r}: {name} needs a number from -1 to 1, as in {name}=0.5"
            ) from None
        if parameter in stated:
            raise CaparError(f"--effort states {parameter} twice; state it once")
        stated.add(parameter)
        out = replace(out, **{parameter: value})
    if not stated:
        raise CaparError("--effort states nothing; as in --effort time=0.6,weight=-0.3")
    return out


def _parameter(name: str) -> tuple[str, float]:
    """The parameter of that name, and the sign of the pole if one was named."""
    for parameter, (low, high) in POLES.items():
        signs = {parameter: 1.0, low: -1.0, high: 1.0}
        if name in signs:
            return parameter, signs[name]
    known = [word for parameter, poles in POLES.items() for word in (parameter, *poles)]
    raise UnknownNameError("effort", name, known)
