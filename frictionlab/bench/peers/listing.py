"""Names to peers."""

from __future__ import annotations

from frictionlab.bench.peers.base import Peer
from frictionlab.bench.peers.equations import ScipyBristle, ScipySteps
from frictionlab.bench.peers.heyoka_taylor import Heyoka
from frictionlab.bench.peers.numbalsoda_bristle import Numbalsoda
from frictionlab.bench.peers.scipy_events import ScipyEvents

PEERS: dict[str, type[Peer]] = {
    peer.name: peer for peer in (ScipySteps, ScipyEvents, ScipyBristle, Heyoka, Numbalsoda)
}
