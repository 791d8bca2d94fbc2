"""`capar serve` beside the `oxigraph` server on the same data: rates, and how both bear floods.

Run by hand: ``python benchmarks/serving.py [--requests 300] [--clients 50] [--seconds 60]``.
First the clients look up observations, over connections that are kept and over a new one for each
request, of both servers in turn. Then `capar serve` alone answers look-ups beside eight endless
queries, and 200 clients half of whom ask endless queries, sent again as soon as they are answered.
One process is all clients; times are of the wall unless they are called processor time.
"""

import argparse
import os
import re
import selectors
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import cycle
from pathlib import Path
from statistics import median, quantiles
from urllib.parse import quote

from actionary import many

from kb.actionary import Actionary

PREFIXES = (
    "PREFIX capar: <https://w3id.org/capar/ontology#> "
    "PREFIX rdfs: <http://www.w3.org/2000/01/rdf-schema#> "
)
LOOKUP = PREFIXES + (
    "SELECT ?name ?seconds {{ <https://w3id.org/capar/data/observation/o{}> rdfs:label ?name ; "
    "capar:capture/capar:duration ?seconds }}"
)
ENDLESS = "SELECT (COUNT(*) AS ?n{}) {{ ?a ?b ?c . ?d ?e ?f . ?g ?h ?i . ?j ?k ?l }}"
TICKS_PER_S = os.sysconf("SC_CLK_TCK")
ROUNDS = 3


def message(query: str) -> bytes:
    """A query as a request over HTTP."""
    head = "Host: 127.0.0.1\r\nAccept: application/sparql-results+json\r\n"
    return f"GET /query?query={quote(query)} HTTP/1.1\r\n{head}\r\n".encode()


# Clients


class Client:
    """One that sends a request, waits for its response, and sends the next."""

    def __init__(self, port: int, requests: Iterator[bytes], *, keeps: bool = True) -> None:
        self.port, self.requests, self.keeps = port, requests, keeps
        self.statuses: Counter[str] = Counter()
        self.times: list[float] = []
        self.socket: socket.socket | None = None

    def send(self, selector: selectors.BaseSelector) -> bool:
        """Send the next request, if there is one."""
        request = next(self.requests, None)
        if request is None:
            self.close(selector)
            return False
        self.begun, self.received = time.perf_counter(), b""
        if self.socket is None:
            self.socket = socket.create_connection(("127.0.0.1", self.port))
            selector.register(self.socket, selectors.EVENT_READ, self)
        self.socket.sendall(request)
        return True

    def receive(self, selector: selectors.BaseSelector) -> bool:
        """Take what came; whether the response is whole."""
        assert self.socket is not None
        try:
            data = self.socket.recv(1 << 16)
        except OSError:
            data = b""
        self.received += data
        head, ended, body = self.received.partition(b"\r\n\r\n")
        length = re.search(rb"\r\ncontent-length: *(\d+)", head, re.IGNORECASE)
        whole = len(body) >= int(length[1]) if length else body.endswith(b"0\r\n\r\n")
        if data and not (ended and whole):
            return False
        status = head.split(b" ", 2)[1].decode() if ended and whole else "broken"
        if status == "503" and not re.search(rb"\r\nretry-after: *\d", head, re.IGNORECASE):
            status = "503 without Retry-After"
        self.statuses[status] += 1
        self.times.append(time.perf_counter() - self.begun)
        if not (data and self.keeps) or re.search(rb"\r\nconnection: *close", head, re.IGNORECASE):
            self.close(selector)
        return True

    def close(self, selector: selectors.BaseSelector) -> None:
        """End the connection."""
        if self.socket is not None:
            selector.unregister(self.socket)
            self.socket.close()
            self.socket = None


def run(clients: Sequence[Client], *, until: float = float("inf")) -> Iterator[None]:
    """Have all clients ask at once until they have no more to ask, or until a time."""
    with selectors.DefaultSelector() as selector:
        asking = {client for client in clients if client.send(selector)}
        while asking and time.perf_counter() < until:
            for key, _ in selector.select(timeout=0.2):
                client = key.data
                if client.receive(selector) and not client.send(selector):
                    asking.discard(client)
            yield
        for client in clients:
            client.close(selector)


# Servers


@contextmanager
def serving(command: Sequence[str]) -> Iterator[tuple[int, int]]:
    """A server's process and port while it runs; ended by Ctrl-C, with all of its processes."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    told = [each.replace("PORT", str(port)) for each in command]
    running = subprocess.Popen(told, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        for _ in range(600):
            client = Client(port, iter([message(LOOKUP.format(0))]))
            try:
                list(run([client]))
            except ConnectionRefusedError:
                time.sleep(0.05)
                continue
            break
        yield running.pid, port
    finally:
        begun, all_processes = time.perf_counter(), processes(running.pid)
        running.send_signal(signal.SIGINT)
        running.wait()
        left = [each for each in all_processes if Path(f"/proc/{each}").exists()]
        print(f"    ended in {time.perf_counter() - begun:.2f} s, {len(left)} processes left")


def processes(root: int) -> list[int]:
    """A process with all of its descendants."""
    parents = {}
    for each in Path("/proc").iterdir():
        if each.name.isdecimal():
            try:
                parents[int(each.name)] = int(
                    (each / "stat").read_text().rpartition(")")[2].split()[1]
                )
            except OSError:
                continue
    found = [root]
    for each in found:
        found += [child for child, parent in parents.items() if parent == each]
    return found


def processor_s(root: int) -> float:
    """Processor time of a process and its descendants, those that ended included [s]."""
    ticks = 0
    for each in processes(root):
        try:
            ticks += sum(
                map(int, Path(f"/proc/{each}/stat").read_text().rpartition(")")[2].split()[11:15])
            )
        except OSError:
            continue
    return ticks / TICKS_PER_S


def memory_mb(root: int) -> float:
    """What a process and its descendants hold, shared pages counted once [MB]."""
    kilobytes = 0
    for each in processes(root):
        try:
            text = Path(f"/proc/{each}/smaps_rollup").read_text()
        except OSError:
            continue
        held = re.search(r"^Pss: +(\d+)", text, re.MULTILINE)
        kilobytes += int(held[1]) if held else 0
    return kilobytes / 1024


# What is measured


def p95(times: Sequence[float]) -> float:
    """The 95th percentile."""
    return quantiles(times, n=20)[-1] if len(times) > 1 else max(times, default=0.0)


def rate(name: str, pid: int, port: int, asked: argparse.Namespace, *, keeps: bool) -> float:
    """Print a line of the look-ups of all clients, and give their rate [1/s]."""
    share = [asked.requests // asked.clients] * asked.clients
    share[0] += asked.requests - sum(share)
    clients = [
        Client(port, iter([message(LOOKUP.format(n)) for n in range(count)]), keeps=keeps)
        for count in share
    ]
    begun, spent, own = time.perf_counter(), processor_s(pid), time.process_time()
    for _ in run(clients):
        pass
    wall, own = time.perf_counter() - begun, time.process_time() - own
    times = [each for client in clients for each in client.times]
    statuses = sum((client.statuses for client in clients), Counter())
    print(
        f"  {name:22} {len(times) / wall:8,.0f} {median(times) * 1e3:8.1f} {p95(times) * 1e3:8.1f}"
        f" {(processor_s(pid) - spent) / len(times) * 1e3:10.2f} {own / len(times) * 1e3:10.2f}"
        f"   {dict(statuses)}"
    )
    return len(times) / wall


def flood(pid: int, port: int, *, endless: int, lookups: int, seconds: float) -> None:
    """Print how look-ups fare beside endless queries, and what the server holds meanwhile."""
    print(f"\n{endless} endless queries and {lookups} clients with look-ups, {seconds:g} s")
    asking = [Client(port, cycle([message(ENDLESS.format(n))])) for n in range(endless)]
    looking = [Client(port, cycle([message(LOOKUP.format(n % 50))])) for n in range(lookups)]
    begun = time.perf_counter()
    held, at = [memory_mb(pid)], begun
    for _ in run([*asking, *looking], until=begun + seconds):
        if time.perf_counter() - at > max(seconds / 12, 0.2):
            held.append(memory_mb(pid))
            at = time.perf_counter()
    for name, clients in (("look-ups", looking), ("endless", asking)):
        statuses = sum((client.statuses for client in clients), Counter())
        times = [each for client in clients for each in client.times] or [0.0]
        print(
            f"  {name:10} {dict(statuses)}, median {median(times):.3f}, p95 {p95(times):.3f}, "
            f"longest {max(times):.3f} s"
        )
    print(f"  memory [MB] {' '.join(f'{each:.0f}' for each in held)}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--requests", type=int, default=300)
    parser.add_argument("--clients", type=int, default=50)
    parser.add_argument("--seconds", type=float, default=60.0, help="of each flood")
    parser.add_argument("--triples", type=int, default=100_000)
    asked = parser.parse_args()
    sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "actionary"
        with Actionary.open(place) as actionary:
            actionary.store.bulk(many(asked.triples))
        capar = [sys.executable, "-c", "from capar.cli import main; main()"]
        ours = [*capar, "serve", "--actionary", str(place), "--port", "PORT"]
        beside = Path(sys.executable).parent / "oxigraph"
        oxigraph = (
            str(beside)
            if beside.exists()
            else shutil.which("oxigraph")
            or sys.exit(
                "no oxigraph program beside this Python or on the path: pip install oxigraph"
            )
        )
        other = [oxigraph, "serve-read-only", "--location", str(place / "store")]
        other += ["--bind", "127.0.0.1:PORT", "--union-default-graph"]
        with serving(other) as theirs, serving(ours) as mine:
            print(
                f"{asked.requests} look-ups by {asked.clients} clients, {asked.triples:,} triples"
            )
            print("                            per s   median ms    p95  processor ms, client's")
            for keeps in (True, False):
                print(" kept connections" if keeps else " a connection each")
                rates: dict[str, list[float]] = {"oxigraph": [], "capar serve": []}
                for _ in range(ROUNDS):
                    rates["oxigraph"].append(rate("oxigraph", *theirs, asked, keeps=keeps))
                    rates["capar serve"].append(rate("capar serve", *mine, asked, keeps=keeps))
                of = median(rates["capar serve"]) / median(rates["oxigraph"])
                print(f"  capar serve at {of:.2f} of the rate of oxigraph")
        with serving(ours) as mine:
            flood(*mine, endless=8, lookups=min(asked.clients, 8), seconds=asked.seconds)
        with serving(ours) as mine:
            many_clients = asked.clients * 4
            half = many_clients // 2
            flood(*mine, endless=half, lookups=many_clients - half, seconds=asked.seconds)


if __name__ == "__main__":
    main()
