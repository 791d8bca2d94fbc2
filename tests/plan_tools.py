"""Tools of other fields that take what is exported: a planning framework, an executive."""

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from xml.etree import ElementTree as ET

import behaviortreepy
from unified_planning.io import PDDLReader
from unified_planning.model import FNode, InstantaneousAction, Object, Problem
from unified_planning.plans import ActionInstance, SequentialPlan
from unified_planning.shortcuts import PlanValidator, get_environment

from capar.model.par import Condition

get_environment().credits_stream = None


def problem_of(domain: str, problem: str) -> Problem:
    """A problem as unified-planning reads it."""
    return PDDLReader().parse_problem_string(domain, problem)


def shortest_plan(problem: Problem) -> list[tuple[str, ...]]:
    """A shortest plan, found breadth first, that unified-planning's validator takes."""
    start = frozenset(str(a) for a, value in problem.initial_values.items() if value.is_true())
    goals = _literals([leaf for goal in problem.goals for leaf in _leaves(goal)], {})
    moves = [each for action in problem.actions for each in _grounded(problem, action)]
    changed = {atom for move in moves for atom in (*move.adds, *move.deletes)}
    static = start - changed
    moves = [m for m in moves if all(a in static or a in changed for a in m.needs[0])]
    queue, seen = deque([(start, ())]), {start}
    while queue:
        state, steps = queue.popleft()
        if _holds(goals, state):
            _validate(problem, steps)
            return [(each.action.name, *map(str, each.objects)) for each in steps]
        for each in moves:
            if _holds(each.needs, state):
                after = (state - each.deletes) | each.adds
                if after not in seen:
                    seen.add(after)
                    queue.append((after, (*steps, each)))
    return []


Literals = tuple[frozenset[str], frozenset[str]]
"""What holds, and what does not."""


@dataclass(frozen=True)
class _Move:
    action: InstantaneousAction
    objects: tuple[Object, ...]
    needs: Literals
    adds: frozenset[str]
    deletes: frozenset[str]


def _grounded(problem: Problem, action: InstantaneousAction) -> Iterator[_Move]:
    choices = [list(problem.objects(each.type)) for each in action.parameters]
    needs = [leaf for each in action.preconditions for leaf in _leaves(each)]
    for objects in product(*choices):
        names = {p.name: str(o) for p, o in zip(action.parameters, objects, strict=True)}
        adds = {_atom(e.fluent, names) for e in action.effects if e.value.is_true()}
        deletes = {_atom(e.fluent, names) for e in action.effects if e.value.is_false()}
        literals = _literals(needs, names)
        yield _Move(action, objects, literals, frozenset(adds), frozenset(deletes - adds))


def _leaves(node: FNode) -> list[FNode]:
    return [leaf for arg in node.args for leaf in _leaves(arg)] if node.is_and() else [node]


def _literals(leaves: list[FNode], names: Mapping[str, str]) -> Literals:
    holds = {_atom(each, names) for each in leaves if not each.is_not()}
    lacks = {_atom(each.arg(0), names) for each in leaves if each.is_not()}
    return frozenset(holds), frozenset(lacks)


def _atom(node: FNode, names: Mapping[str, str]) -> str:
    words = (names.get(str(arg), str(arg)) for arg in node.args)
    return f"{node.fluent().name}({', '.join(words)})"


def _holds(literals: Literals, state: frozenset[str]) -> bool:
    return literals[0] <= state and not literals[1] & state


def _validate(problem: Problem, steps: tuple[_Move, ...]) -> None:
    plan = SequentialPlan([ActionInstance(each.action, each.objects) for each in steps])
    with PlanValidator(name="sequential_plan_validator") as validator:
        found = validator.validate(problem, plan)
    assert found, found.reason


@dataclass
class World:
    """Contacts and postures, as the leaves of a tree find and change them."""

    after: Mapping[str, Sequence[Condition]]
    """What each action brings about, over its parameters."""

    contacts: set[tuple[str, str]] = field(default_factory=set)
    postures: set[str] = field(default_factory=set)
    unable: frozenset[str] = frozenset()
    done: list[tuple[str, ...]] = field(default_factory=list)

    def act(self, node: behaviortreepy.TreeNode) -> behaviortreepy.NodeStatus:
        """Do what an action's ports say."""
        action = node.name().removeprefix("Do")
        ee, words = _told(node, "ee", "objects")
        objects = [each for each in words.split(";") if each]
        self.done.append((action, ee, *objects))
        self.postures.discard(ee)
        named = {"EE": ee, **{f"obj{i}": each for i, each in enumerate(objects, start=1)}}
        for each in self.after[action]:
            first, second = (named[name] for name in each.arguments)
            (self.contacts.add if each.holds else self.contacts.discard)((first, second))
        return behaviortreepy.NodeStatus.SUCCESS

    def touches(self, node: behaviortreepy.TreeNode) -> behaviortreepy.NodeStatus:
        """Whether two bodies touch."""
        pair = _told(node, "first", "second")
        return _status(pair in self.contacts)

    def apart(self, node: behaviortreepy.TreeNode) -> behaviortreepy.NodeStatus:
        """Whether they do not."""
        pair = _told(node, "first", "second")
        return _status(pair not in self.contacts)

    def stands(self, node: behaviortreepy.TreeNode) -> behaviortreepy.NodeStatus:
        """Whether an end-effector is in its posture."""
        return _status(_told(node, "agent")[0] in self.postures)

    def able(self, node: behaviortreepy.TreeNode) -> behaviortreepy.NodeStatus:
        """Whether somebody or something is capable of an action."""
        return _status(_told(node, "who")[0] not in self.unable)


def _told(node: behaviortreepy.TreeNode, *names: str) -> tuple[str, ...]:
    return tuple(node.config().blackboard.get_string(each) for each in names)


def _status(holds: bool) -> behaviortreepy.NodeStatus:
    return behaviortreepy.NodeStatus.SUCCESS if holds else behaviortreepy.NodeStatus.FAILURE


def ticked(text: str, world: World) -> behaviortreepy.NodeStatus:
    """The status in which BehaviorTree.CPP ends a tree whose leaves act on a world."""
    factory = behaviortreepy.BehaviorTreeFactory()
    for action in world.after:
        factory.register_simple_action(f"Do{action}", world.act)
    factory.register_simple_condition("IsContact", world.touches)
    factory.register_simple_condition("IsNoContact", world.apart)
    factory.register_simple_condition("IsPosture", world.stands)
    factory.register_simple_condition("IsCapable", world.able)
    factory.register_behavior_tree_from_text(text)
    main = ET.fromstring(text).get("main_tree_to_execute")
    return factory.create_tree(main).tick_while_running()
