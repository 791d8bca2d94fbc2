"""Settings by which Lab Streaming Layer sends and seeks streams on this computer alone."""

LOOPBACK = """
[ports]
IPv6=disable
[multicast]
ResolveScope=machine
ListenAddress=127.0.0.1
AddressesOverride={127.0.0.1}
[lab]
KnownPeers={127.0.0.1}
"""
