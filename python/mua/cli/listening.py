"""What mua-view says while it listens to another program, in the window and in a browser alike."""

from collections.abc import Iterator
from contextlib import contextmanager

import typer

from mua.live.receiver import LOOPBACK, Address, Receiver


@contextmanager
def listening(address: Address | None) -> Iterator[Receiver | None]:
    """An open port, if --listen asks for one; prints its address, and at the end what has come.

    Errors: InputError where it cannot be opened.
    """
    if address is None:
        yield None
        return
    with Receiver(address) as receiver:
        reach = "this machine alone" if receiver.address.host == LOOPBACK else "whoever reaches this machine"
        typer.echo(f"listens to VMC on {receiver.address}, from {reach}")
        yield receiver
        typer.echo(f"{receiver.address}: {receiver.figures}")
