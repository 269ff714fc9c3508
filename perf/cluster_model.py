"""The time of a step on a cluster, from what each rank owns and shares: the arithmetic behind perf/simulate.

A rank sweeps twice over its tiles, those inside (which touch no other rank) and the outer ones; rows for other ranks travel
under the sweep over the tiles inside. A node has some ranks and one link to the network. All ranks start an exchange about
together and the messages on a link share it evenly, so that one of size s is through when the link has carried the sum
of min(s, size) over all its messages; the slower of the two nodes' links counts, and the latency:
    step = max over ranks [rest + pack + max(first inside, traces) + first outer
                                + pack + max(second inside, tractions) + second outer]
With several threads a sweep takes as long as its thread with most tiles, each of TILE tets, and a step has some
barriers of the team. The reduction has a sweep and a half to go round and stays hidden as long as 2 log2(ranks) latencies are shorter.
"""

import dataclasses

import numpy as np

TILE = 256
TEAM_BARRIERS, BARRIER = 8, 1e-6  # of a step; seconds of one, where a rank has threads
TRACE_BYTES, TRACTION_BYTES = 18 * 8, 9 * 8  # of a face and direction: RG_TRACE_ROW, RG_SEAM_ROW


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


def shared_link(node, size, nodes):
    """Bytes that a node's link has carried when each of its messages is through."""
    carried = np.zeros(len(size))
    order = np.lexsort((size, node))
    begin = np.searchsorted(node[order], np.arange(nodes + 1))
    for first, last in zip(begin, begin[1:]):
        s = size[order[first:last]]
        carried[order[first:last]] = np.cumsum(s) + s * np.arange(len(s) - 1, -1, -1)
    return carried


def exchange(pattern, network, bytes_per_face):
    """Seconds of an exchange that nothing hides, for each rank."""
    node = np.arange(pattern.ranks) // network.ranks_per_node
    source, target = node[pattern.source], node[pattern.target]
    size = bytes_per_face * pattern.faces
    between = source != target
    time = network.inside_latency + size / network.inside_bandwidth
    carried = [shared_link(side[between], size[between], node[-1] + 1) for side in (source, target)]
    time[between] = network.latency + np.maximum(*carried) / network.bandwidth
    longest = np.zeros(pattern.ranks)
    np.maximum.at(longest, pattern.source, time)
    return longest


def swept(tets, threads):
    """Tets of the thread that has most of them."""
    return tets if threads == 1 else TILE * np.ceil(tets / TILE / threads)


def step(pattern, network, costs, threads=1):
    """Seconds of a step, and its parts for the rank that sets it: sweeps, pack, wait, rest."""
    count = np.bincount(pattern.source, minlength=pattern.ranks)
    inner, outer = swept(pattern.inner, threads), swept(pattern.tets - pattern.inner, threads)
    pack = 2 * costs.pack * pattern.shared / threads + 4 * network.overhead * count
    wait = (np.maximum(exchange(pattern, network, TRACE_BYTES) - costs.first * inner, 0)
            + np.maximum(exchange(pattern, network, TRACTION_BYTES) - costs.second * inner, 0))
    sweeps = (costs.first + costs.second) * (inner + outer)
    rest = costs.rest + (TEAM_BARRIERS * BARRIER if threads > 1 else 0)
    reduction = 2 * np.ceil(np.log2(max(pattern.ranks, 2))) * (network.latency + 2 * network.overhead)
    late = np.maximum(reduction - costs.second * (inner + outer), 0) if pattern.ranks > 1 else np.zeros(1)
    total = sweeps + pack + wait + late + rest
    slowest = int(np.argmax(total))
    return {"step_s": float(total[slowest]), "sweeps_s": float(sweeps[slowest]), "pack_s": float(pack[slowest]),
            "wait_s": float(wait[slowest]), "reduce_s": float(late[slowest]), "rest_s": rest,
            "mean_sweeps_s": float(sweeps.mean()), "imbalance": float(pattern.tets.max() / pattern.tets.mean()),
            "neighbours": float(count.mean()), "faces": float(pattern.shared.mean()),
            "inner_share": float((pattern.inner / pattern.tets).mean())}
