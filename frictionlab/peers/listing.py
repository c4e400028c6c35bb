"""Names to peers."""

from __future__ import annotations

from frictionlab.peers.base import Peer
from frictionlab.peers.heyoka_taylor import Heyoka
from frictionlab.peers.numbalsoda_bristle import Numbalsoda
from frictionlab.peers.scipy_bristle import ScipyBristle
from frictionlab.peers.scipy_events import ScipyEvents
from frictionlab.peers.scipy_steps import ScipySteps

PEERS: dict[str, type[Peer]] = {
    peer.name: peer for peer in (ScipySteps, ScipyEvents, ScipyBristle, Heyoka, Numbalsoda)
}
