"""Body measures: those given, and the rest estimated from stature, sex and age."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from statistics import NormalDist
from types import MappingProxyType
from typing import Any

from capar.model.capture import Agent
from capar.model.errors import CaparError, UnknownNameError


@cache
def table(name: str) -> dict[str, Any]:
    """The table ``data/<name>.toml``; callers do not change it."""
    text = (files("capar.body") / "data" / f"{name}.toml").read_text("utf-8")
    return tomllib.loads(text)


def mirrored(name: str) -> str:
    """The name of the same thing on the other side: ``right_hand`` and ``left_hand``."""
    if "right_" in name:
        return name.replace("right_", "left_")
    return name.replace("left_", "right_")


def is_right(name: str) -> bool:
    """Whether a name is of the right side, whose rows stand for both sides."""
    return "right_" in name


#: Deviation of a length that somebody measured [m]: what trained observers differ by
GIVEN_DEVIATION_M = 0.003
STATURES_M = (0.9, 2.3)  # statures for which estimates are made [m]
GROWN = 18.0  # age from which on the adults' tables hold [years]
CHILD = 9.0  # age of the children's table [years]

ADULTS = {"male": "man", "female": "woman"}  # names of the adults' tables
#: Least height of cervicale above the hips [share of stature]; 0.33 to 0.36 is usual
LEAST_TRUNK = 0.25
#: Heights that rise in this order in every body
ORDER = ("acromial_height", "cervicale_height", "eye_height", "stature")


class MeasuresError(CaparError):
    """Measures that no body has."""


@dataclass(frozen=True)
class Measures:
    """The measures of one body."""

    sex: str  #: ``male`` or ``female``
    age: float  #: Years
    values: Mapping[str, float]  #: Lengths [m] and ``mass`` [kg] by name
    given: frozenset[str]  #: Which of them were stated; the others are estimates
    #: Standard deviation of each [m, kg]: of measuring, or of estimating from stature
    deviations: Mapping[str, float]

    def __post_init__(self) -> None:
        """Check that they are of one body, and make them read-only."""
        object.__setattr__(self, "values", MappingProxyType(dict(self.values)))
        object.__setattr__(self, "deviations", MappingProxyType(dict(self.deviations)))
        for name, value in self.values.items():
            if not 0.0 < value < 400.0:
                raise MeasuresError(f"{name} = {value}; measures are positive, in metres and kg")
        rising = [self.hip_height, *(self.values[each] for each in ORDER)]
        trunk = self.values["cervicale_height"] - self.hip_height
        if trunk < LEAST_TRUNK * self.values["stature"]:
            raise MeasuresError(
                f"hip height {self.hip_height:.3f} m (ankle_height + shank + thigh) leaves "
                f"{trunk:.3f} m up to cervicale_height; a trunk has a quarter of the stature"
            )
        if sorted(rising) != rising:
            heights = ", ".join(f"{each:.3f}" for each in rising)
            names = ", ".join(("hip height (ankle_height + shank + thigh)", *ORDER))
            raise MeasuresError(f"{names} must rise; they are {heights} m")

    def __getitem__(self, name: str) -> float:
        """A measure [m, kg] by name."""
        return self.values[name]

    @property
    def hip_height(self) -> float:
        """Height of the hip joints when standing [m]."""
        return self.values["ankle_height"] + self.values["shank"] + self.values["thigh"]

    @property
    def adult_share(self) -> float:
        """How far between the nine-year-old's proportions (0) and an adult's (1) [1]."""
        return _adult_share(self.age)

    @property
    def adult(self) -> str:
        """Name of the adults' table: ``man`` or ``woman``."""
        return ADULTS[self.sex]


def estimate_measures(
    *,
    sex: str = "male",
    age: float = 30.0,
    percentile: float | None = None,
    given: Mapping[str, float] | None = None,
) -> Measures:
    """The measures of a person, those not given estimated by regression on stature.

    Args:
        sex: ``male`` or ``female``.
        age: Years, from 6 up; between 9 and 18 the child's and the adult's tables are blended.
        percentile: Of stature among persons of that sex and age, where no stature is given.
        given: Any measures that are known [m, kg].

    Raises:
        MeasuresError, UnknownNameError: Measures of no body, or unknown ones.
    """
    known, tables = dict(given or {}), table("anthropometry")
    if sex not in ADULTS:
        raise UnknownNameError("sex", sex, ADULTS)
    for name in known:
        if name not in measure_names():
            raise UnknownNameError("measure", name, measure_names())
    if age < tables["growth"]["first_age"]:
        raise MeasuresError(f"age {age}; the tables begin at 6 years")
    if percentile is not None and not 0.0 < percentile < 100.0:
        raise MeasuresError(f"percentile {percentile}; it lies between 0 and 100")
    if percentile is not None and "stature" in known:
        raise MeasuresError("stature and its percentile are both given; give one")
    share, adult = _adult_share(age), ADULTS[sex]
    stature = known.get("stature") or _stature(sex, age, percentile or 50.0)
    if not STATURES_M[0] <= stature <= STATURES_M[1]:
        raise MeasuresError(f"stature {stature:.3f} m; estimates are made from 0.9 to 2.3 m")
    values, deviations = {}, {}
    for name in measure_names():
        young, grown = (_estimated(name, each, stature) for each in ("child", adult))
        values[name] = (1.0 - share) * young[0] + share * grown[0]
        deviations[name] = (1.0 - share) * young[1] + share * grown[1]
    values |= {"stature": stature} | known
    deviations |= dict.fromkeys(known, GIVEN_DEVIATION_M)
    return Measures(sex, age, values, frozenset(known), deviations)


def measure_names() -> tuple[str, ...]:
    """The names of all measures."""
    return tuple(name for name in table("anthropometry")["man"] if name != "age")


READY_MADE = {"man": ("male", 30.0), "woman": ("female", 30.0), "child": ("male", CHILD)}
"""Sex and age [years] of each ready-made agent."""


def ready_made(name: str) -> Measures:
    """The adult ``man`` or ``woman`` or the nine-year-old ``child``, of median stature."""
    if name not in READY_MADE:
        raise UnknownNameError("ready-made agent", name, READY_MADE)
    sex, age = READY_MADE[name]
    median = table("anthropometry")[name]["stature"]["percentiles"][1]
    given = {"stature": median} if name == "child" else None
    return replace(estimate_measures(sex=sex, age=age, given=given), given=frozenset())


def measures_of(agent: Agent) -> Measures:
    """The measures of a capture's performer: the kind of person, and what is stated of it."""
    kind = agent.kind if agent.kind in {"man", "woman", "child"} else "man"
    sex = "female" if kind == "woman" else "male"
    age = CHILD if kind == "child" else 30.0
    stated = {k: v for k, v in agent.measures.items() if k in measure_names()}
    return estimate_measures(sex=sex, age=agent.measures.get("age", age), given=stated)


def _adult_share(age: float) -> float:
    return min(max((age - CHILD) / (GROWN - CHILD), 0.0), 1.0)


def _stature(sex: str, age: float, percentile: float) -> float:
    """Stature from a percentile, by normal distribution about the median of that age [m]."""
    tables, adult, share = table("anthropometry"), ADULTS[sex], _adult_share(age)
    growth, place = tables["growth"][sex], age - tables["growth"]["first_age"]
    median = tables[adult]["stature"]["percentiles"][1]
    if age < GROWN:
        index = min(int(place), len(growth) - 2)
        median = growth[index] + (place - index) * (growth[index + 1] - growth[index])
    young, grown = (_deviation(tables[each]["stature"]) for each in ("child", adult))
    deviation = (1.0 - share) * young + share * grown
    return median + deviation * NormalDist().inv_cdf(percentile / 100.0)


def _estimated(name: str, population: str, stature: float) -> tuple[float, float]:
    """A measure's estimate and its deviation among persons of that stature [m, kg]."""
    rows = table("anthropometry")[population]
    row, tall = rows[name], rows["stature"]
    if "of_stature" in row:
        return row["of_stature"] * stature, row["sd_of_stature"] * stature
    deviation, middle = _deviation(row), row["percentiles"][1]
    left = deviation * (1.0 - row["r"] ** 2) ** 0.5
    if name == "mass":
        return middle * (stature / tall["percentiles"][1]) ** 2, left
    slope = row["r"] * deviation / _deviation(tall)
    return middle + slope * (stature - tall["percentiles"][1]), left


def _deviation(row: Mapping[str, Any]) -> float:
    """Standard deviation from the 5th and 95th percentile of a normal distribution."""
    low, _, high = row["percentiles"]
    return (high - low) / (2.0 * NormalDist().inv_cdf(0.95))
