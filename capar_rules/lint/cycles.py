"""Negative cycles: rules that depend on their own negation, with several answers or none."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence

from capar_rules.engine.slicing import nodes, nodes_read
from capar_rules.engine.syntax import Signature, Statement
from capar_rules.lint.findings import Finding

Graph = Mapping[Signature, set[Signature]]


def cycle_findings(own: Sequence[Statement], base: Sequence[Statement]) -> Iterator[Finding]:
    """Each rule of a file through which a predicate depends on its own negation."""
    everything = [*base, *own]
    graph = _graph(everything)
    component = _components(graph)
    negative = {
        component[head]
        for head, below, sign in _edges(everything)
        if sign and component[head] == component.get(below)
    }
    for rule in own:
        for head, below, _ in _edges([rule]):
            if component.get(head) == component.get(below) and component.get(head) in negative:
                path = " -> ".join(name for name, _ in [head, *_path(graph, below, head)])
                yield Finding(
                    rule.place, "negative-cycle",
                    f"{head[0]} depends on its own negation: {path}; there would be several "
                    "answers, or none.",
                    "Make it depend on measurements and features, which names do not change.",
                )  # fmt: skip
                break


def components(rules: Sequence[Statement]) -> dict[Signature, int]:
    """The number of the strongly connected component of each predicate."""
    return _components(_graph(rules))


def _edges(rules: Iterable[Statement]) -> Iterator[tuple[Signature, Signature, bool]]:
    """Edges of the dependency graph: head, predicate of the body, whether it is negated."""
    rules = list(rules)
    named = {node for rule in rules for head in rule.heads for node in nodes(head)}
    for rule in rules:
        for head in rule.heads:
            for literal in rule.body:
                for atom in literal.atoms:
                    closed = literal.kind == "atom" and atom.sign == 0
                    for node in nodes(head):
                        for below in nodes_read(atom, named):
                            yield node, below, not closed


def _graph(rules: Iterable[Statement]) -> Graph:
    graph: dict[Signature, set[Signature]] = defaultdict(set)
    for head, below, _ in _edges(rules):
        graph[head].add(below)
        graph[below] |= set()
    return graph


def _components(graph: Graph) -> dict[Signature, int]:
    """The strongly connected component of each predicate, by Kosaraju's algorithm."""
    order: list[Signature] = []
    seen: set[Signature] = set()
    for start in sorted(graph):
        order += _walk(graph, start, seen)
    backward: dict[Signature, set[Signature]] = defaultdict(set)
    for head, group in graph.items():
        for below in group:
            backward[below].add(head)
    component: dict[Signature, int] = {}
    done: set[Signature] = set()
    for number, start in enumerate(reversed(order)):
        for member in _walk(backward, start, done):
            component[member] = number
    return component


def _walk(graph: Graph, start: Signature, seen: set[Signature]) -> list[Signature]:
    """What a depth-first search newly reaches from a start, in postorder."""
    if start in seen:
        return []
    seen.add(start)
    left: list[Signature] = []
    stack = [(start, iter(sorted(graph.get(start, ()))))]
    while stack:
        node, rest = stack[-1]
        nearest = next((each for each in rest if each not in seen), None)
        if nearest is None:
            left.append(node)
            stack.pop()
        else:
            seen.add(nearest)
            stack.append((nearest, iter(sorted(graph.get(nearest, ())))))
    return left


def _path(graph: Graph, start: Signature, goal: Signature) -> list[Signature]:
    """A shortest path between two predicates."""
    before: dict[Signature, Signature] = {}
    waiting = [start]
    for node in waiting:
        if node == goal:
            break
        for successor in sorted(graph[node]):
            if successor not in before and successor != start:
                before[successor] = node
                waiting.append(successor)
    path = [goal]
    while path[-1] != start:
        path.append(before[path[-1]])
    return path[::-1]
