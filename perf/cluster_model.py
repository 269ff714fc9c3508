"""The time of a step on a cluster, from what each rank owns and shares: the arithmetic behind perf/simulate.

A rank sweeps twice over its tiles, those inside (which touch no other rank) and the outer ones; rows for other ranks travel
under the sweep over the tiles inside:
    first inside | traces there | first outer, pack | second inside | tractions there | second outer, pack, rest
A node has some ranks and one link to the network, which its messages share evenly while they are on it (processor sharing);
the slower of the two nodes' links counts, and the latency. Ranks begin together and then keep step by their messages
alone: those whose messages are through early compute while others still send, so that links are in use for more of the time
than if all exchanged at once.
With several threads a sweep takes as long as its thread with most tiles, each of TILE tets, and a step has some
barriers of the team. The reduction goes round by dissemination, in log2(ranks) rounds, and is late by what they take beyond
the second sweep.
"""

import dataclasses
import heapq

import numpy as np

TILE = 256
WARM, STEPS = 2, 2  # as perf/simulated_step.c, which perf/simulate runs for 2 steps
TEAM_BARRIERS, BARRIER = 8, 1e-6  # of a step; seconds of one, where a rank has threads
TRACE_BYTES, TRACTION_BYTES = 18 * 8, 9 * 8  # of a face and direction: RG_TRACE_ROW, RG_TILE_FACE_ROW


@dataclasses.dataclass
class Network:
    name: str
    ranks_per_node: int
    bandwidth: float  # bytes/s of a node's link, each way
    latency: float  # s from node to node, at most
    inside_bandwidth: float  # bytes/s of a message within a node
    inside_latency: float
    overhead: float  # s of a rank's time for each message, sent or received


@dataclasses.dataclass
class Costs:
    first: float  # s per tet
    second: float
    pack: float  # s per face and exchange
    rest: float  # s per step


@dataclasses.dataclass
class Pattern:
    tets: np.ndarray
    inner: np.ndarray
    source: np.ndarray  # [messages]: rank, its neighbour, faces that they share
    target: np.ndarray
    faces: np.ndarray

    @property
    def ranks(self):
        return len(self.tets)

    @property
    def shared(self):
        return np.bincount(self.source, self.faces, self.ranks)


def read_pattern(path):
    """What rhegma-pattern wrote."""
    tets, inner, messages = [], [], []
    with open(path) as file:
        next(file)
        for rank, line in enumerate(file):
            numbers = [int(word) for word in line.split()]
            tets.append(numbers[0])
            inner.append(numbers[1])
            messages += [(rank, numbers[k], numbers[k + 1]) for k in range(3, len(numbers), 2)]
    columns = np.array(messages, dtype=np.int64).reshape(-1, 3).T
    return Pattern(np.array(tets), np.array(inner), *columns)


def through(start, size, bandwidth):
    """When the messages of a link, which share it evenly, are through: each from its start, of its size."""
    end = np.empty(len(start))
    now = level = 0.0  # time; bytes that a message has got that was there from the beginning
    active = []  # (level at which a message is through, its number)
    for k in np.argsort(start, kind="stable"):
        while active and now + (active[0][0] - level) * len(active) / bandwidth <= start[k]:
            now += (active[0][0] - level) * len(active) / bandwidth
            level, done = heapq.heappop(active)
            end[done] = now
        if active:
            level += (start[k] - now) * bandwidth / len(active)
        now = start[k]
        heapq.heappush(active, (level + size[k], k))
    while active:
        now += (active[0][0] - level) * len(active) / bandwidth
        level, done = heapq.heappop(active)
        end[done] = now
    return end


def exchange(pattern, network, bytes_per_face, start):
    """When the messages of an exchange, sent at `start` of each rank, are through: the last one of each rank."""
    node = np.arange(pattern.ranks) // network.ranks_per_node
    sent, size = start[pattern.source], bytes_per_face * pattern.faces
    between = np.flatnonzero(node[pattern.source] != node[pattern.target])
    end = sent + network.inside_latency + size / network.inside_bandwidth
    end[between] = 0
    for side in (node[pattern.source], node[pattern.target]):
        order = between[np.argsort(side[between], kind="stable")]
        first = np.searchsorted(side[order], np.arange(node[-1] + 2))
        for link in np.split(order, first[1:-1]):
            end[link] = np.maximum(end[link], network.latency + through(sent[link], size[link], network.bandwidth))
    last = np.zeros(pattern.ranks)
    np.maximum.at(last, pattern.source, end)  # a rank waits for what it sent as well
    np.maximum.at(last, pattern.target, end)
    return last


def swept(tets, threads):
    """Tets of the thread that has most of them."""
    return tets if threads == 1 else TILE * np.ceil(tets / TILE / threads)


def step(pattern, network, costs, threads=1):
    """Seconds of a step, the mean of STEPS after WARM, and its parts for the rank that works longest."""
    count = np.bincount(pattern.source, minlength=pattern.ranks)
    inner, outer = swept(pattern.inner, threads), swept(pattern.tets - pattern.inner, threads)
    pack = costs.pack * pattern.shared / threads + 2 * network.overhead * count  # of one exchange
    sweeps = (costs.first + costs.second) * (inner + outer)
    rest = costs.rest + (TEAM_BARRIERS * BARRIER if threads > 1 else 0)
    reduction = np.ceil(np.log2(max(pattern.ranks, 2))) * (network.latency + 2 * network.overhead)
    late = np.maximum(reduction - costs.second * (inner + outer), 0) if pattern.ranks > 1 else np.zeros(1)
    now = np.zeros(pattern.ranks)  # when a rank has sent its traces
    for k in range(WARM + STEPS):
        if k == WARM:
            begin = now
        now = np.maximum(now + costs.first * inner, exchange(pattern, network, TRACE_BYTES, now)) + costs.first * outer + pack
        now = np.maximum(now + costs.second * inner, exchange(pattern, network, TRACTION_BYTES, now)) + costs.second * outer + pack
        now = now + late + rest
    total = (now - begin).mean() / STEPS
    slowest = int(np.argmax(sweeps + 2 * pack))
    work = {"sweeps_s": float(sweeps[slowest]), "pack_s": float(2 * pack[slowest]), "reduce_s": float(late[slowest]), "rest_s": rest}
    return {"step_s": float(total), **work, "wait_s": float(total - sum(work.values())),
            "mean_sweeps_s": float(sweeps.mean()), "imbalance": float(pattern.tets.max() / pattern.tets.mean()),
            "neighbours": float(count.mean()), "faces": float(pattern.shared.mean()),
            "inner_share": float((pattern.inner / pattern.tets).mean())}
