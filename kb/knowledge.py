"""Lookups of an Actionary: actions, features, objects, agents, styles."""

from collections.abc import Iterable

from capar.model.locations import ConstraintLocation
from capar.model.par import (
    ComplexPar,
    Condition,
    FeatureSet,
    Ipar,
    Style,
    Upar,
)
from kb.findings import Ability, FeatureRow, FoundLocation, FoundStyle, Stored
from kb.lookup import (
    abilities,
    agents,
    feature_table,
    kinds,
    locations,
    profiles,
    recognition,
    stored_pars,
    styles,
)
from kb.store.stores import Store


class Knowledge:
    """The lookups over a store."""

    store: Store

    # Actions

    def recognise(self, value: ComplexPar) -> str | None:
        """The name under which a complex action is known, whoever performed it."""
        return recognition.recognise(self.store, value)

    def find_pars(
        self,
        *,
        action: str | None = None,
        objects: Iterable[str] = (),
        performer: str | None = None,
    ) -> tuple[Stored, ...]:
        """Observations of complex actions that fit.

        Args:
            action: Name of the complex action, or of a step of it.
            objects: Kinds or names of objects, all of which take part.
            performer: Name of the agent.
        """
        return stored_pars.find(
            self.store, action=action, objects=tuple(objects), performer=performer
        )

    def complex_par(self, name: str) -> ComplexPar:
        """A complex action as it was observed: by the observation's name, or by its own.

        Raises:
            UnknownNameError: There is none.
        """
        return stored_pars.complex_par(self.store, name)

    def upars(self, name: str | None = None) -> tuple[Upar, ...]:
        """Uninstantiated actions of a name, or all of them, by name and number of objects."""
        return stored_pars.upars(self.store, name)

    def ipars(self, observation: str) -> tuple[Ipar, ...]:
        """The instantiated actions of an observation, links in order.

        Raises:
            UnknownNameError: There is no such observation.
        """
        return stored_pars.ipars(self.store, observation)

    def effective(self, ipar: Ipar) -> Upar:
        """An action as it is to be done: what the IPAR says overrides its UPAR (thesis 4.1.2).

        Raises:
            UnknownNameError: Its UPAR is not known.
        """
        return stored_pars.effective(self.upars(ipar.upar), ipar)

    # Features

    def feature_table(self) -> tuple[FeatureRow, ...]:
        """Known sets of features with their names (thesis 4.5), sorted."""
        return feature_table.rows(self.store)

    def feature_program(self) -> str:
        """The feature table as facts of the rules, one a line (``feature_row(...)``)."""
        return feature_table.program(self.feature_table())

    def add_feature_row(
        self, name: str, features: FeatureSet, *, general: Iterable[str] = ()
    ) -> FeatureRow:
        """Name a set of features; it stays when observations are forgotten.

        Raises:
            ParError: Another name was given to the same set of features.
        """
        return feature_table.add(self.store, name, features, tuple(general))

    # Objects, agents and what is stored with them

    def define_kind(self, name: str, *, broader: str = "object") -> None:
        """State that a kind of object or agent is a case of a more general one.

        Raises:
            StoreError: The more general kind would be a case of this one.
        """
        kinds.define(self.store, name, broader)

    def kinds_above(self, kind: str) -> tuple[str, ...]:
        """A kind and every more general one, nearest first."""
        return kinds.above(self.store, kind)

    def locations(
        self,
        kind: str,
        *,
        action: str | None = None,
        purpose: str | None = None,
        side: str | None = None,
    ) -> tuple[FoundLocation, ...]:
        """Constraint locations for a kind of object, best first.

        Those of the kind itself stand before those of more general kinds, those of the side
        before those mirrored from the other one; then by observation.
        """
        return locations.find(self.store, kind, action=action, purpose=purpose, side=side)

    def location(
        self, kind: str, *, action: str, purpose: str | None = None, side: str | None = None
    ) -> ConstraintLocation | None:
        """The best constraint location for a kind of object, mirrored if need be."""
        found = locations.find(self.store, kind, action=action, purpose=purpose, side=side, most=1)
        return found[0].location if found else None

    def styles(
        self,
        *,
        agent: str | None = None,
        action: str | None = None,
        purpose: str | None = None,
        ee: str | None = None,
    ) -> tuple[FoundStyle, ...]:
        """Styles that fit, by observation."""
        return styles.find(self.store, agent=agent, action=action, purpose=purpose, ee=ee)

    def style(
        self, agent: str, *, action: str, purpose: str | None = None, ee: str | None = None
    ) -> Style | None:
        """An agent's style of doing an action, from the first observation by name."""
        found = self.styles(agent=agent, action=action, purpose=purpose, ee=ee)
        return found[0].style if found else None

    def declare_agent(self, name: str, *, kind: str = "", can: Iterable[str] = ()) -> None:
        """State that there is an agent, of what kind it is, and which actions it is able to do.

        Raises:
            StoreError: There is one of that name.
        """
        agents.declare(self.store, name, kind=kind)
        for action in can:
            self.add_ability(action, agent=name)

    def agents(self) -> tuple[str, ...]:
        """Every agent, declared or seen, by name; an unnamed one by the capture that it is of."""
        return tuple(agents.known(self.store))

    def same_agent(self, first: str, second: str) -> None:
        """State that two agents are one: what the second did is the first one's from now on.

        Raises:
            UnknownNameError: There is no such agent.
            StoreError: They are one already.
        """
        agents.same(self.store, first, second)

    def agent_profile(self, name: str) -> profiles.Fields:
        """What is known of an agent, by the fields of thesis Fig 4.2; of some nothing is.

        Raises:
            UnknownNameError: There is no such agent.
        """
        return profiles.agent(self.store, name)

    def object_kinds(self) -> tuple[str, ...]:
        """Every kind of object that was observed or declared, by name."""
        return tuple(profiles.kinds(self.store))

    def object_profile(self, name: str) -> profiles.Fields:
        """What is known of a kind of object, by the fields of thesis Fig 4.3.

        Raises:
            UnknownNameError: There is no object and no kind of that name.
        """
        return profiles.kind(self.store, name)

    def add_ability(
        self, action: str, *, agent: str = "", kind: str = "", conditions: Iterable[Condition] = ()
    ) -> None:
        """State that an agent is able to do an action, or that a kind lends itself to it.

        Args:
            action: Name of the action.
            agent: Name of the agent; or
            kind: Name of the kind of agents or objects.
            conditions: What else must hold.

        Raises:
            StoreError: Neither of them is named, or both are.
        """
        abilities.declare(self.store, action, tuple(conditions), agent=agent, kind=kind)

    def abilities(self, of: str) -> tuple[Ability, ...]:
        """What an agent, or a kind of agent or object, was declared or observed to do."""
        return abilities.of(self.store, of)

    def unmet(
        self, action: str, *, agent: str, objects: Iterable[str] = ()
    ) -> tuple[Condition, ...]:
        """Conditions of an action's applicability that nothing known speaks for (thesis 4.6.1.4).

        Args:
            action: Name of the action.
            agent: Name of the agent.
            objects: Kinds of the objects, dominant first.

        Raises:
            UnknownNameError: The action is not known.
        """
        return abilities.unmet(self.store, action, agent, tuple(objects))
