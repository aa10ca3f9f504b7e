"""One headset behind an adb server: its shell, its files, its log. Every failure is an InputError with one sentence."""

import shlex
import socket
import struct
import time
from collections.abc import Generator, Iterator
from contextlib import closing, contextmanager
from stat import S_IFREG

from adbutils import AdbClient, AdbDevice, AdbError

from mua.errors import InputError

SECONDS = 60.0  # for the answer to one command; an install has INSTALL_SECONDS
INSTALL_SECONDS = 600.0
CHUNK = 64 * 1024  # bytes: the most that one DATA message of adb's sync protocol holds
MODE = S_IFREG | 0o644

# What each state of adb means to its user, and what to do.
STATES = {
    "unauthorized": "has not allowed this computer: put it on and confirm 'Allow USB debugging'",
    "authorizing": "is still asking whether to allow this computer: put it on and confirm 'Allow USB debugging'",
    "offline": "is offline: unplug it, plug it in again and wake it",
    "connecting": "is still connecting: run this again in a few seconds",
    # The library splits "no permissions (...)" at its first space.
    "no": "may not be opened by this user (no permissions): install Android's udev rules and plug it in again",
    "recovery": "is in recovery: restart it",
    "sideload": "is waiting for an update: restart it",
    "bootloader": "is in its boot loader: restart it",
}


class Headset:
    """An authorised device. It holds no connection: each command opens its own."""

    def __init__(self, device: AdbDevice) -> None:
        self._device = device

    @property
    def serial(self) -> str:
        return str(self._device.serial)

    def call(self, *words: str, seconds: float = SECONDS) -> tuple[int, str]:
        """Exit code and text of a shell command, whose words reach the program as they are."""
        with self._failing(words[0]):
            # Version 2 of the shell protocol reports exit codes; the library works around devices without it.
            done = self._device.shell2(shlex.join(words), timeout=seconds, v2=True)
            return int(done.returncode), done.output.strip()

    def run(self, *words: str, seconds: float = SECONDS) -> str:
        """The text of a shell command that must succeed."""
        code, text = self.call(*words, seconds=seconds)
        if code != 0:
            raise InputError(f"{self.serial}: {words[0]} failed with {one_line(text) or f'exit code {code}'}")
        return text

    def send(self, content: bytes, path: str) -> None:
        """Write a file on the headset."""
        # adbutils has a push too, but drops the reason that the device gives and waits without an end.
        spec = f"{path},{MODE}".encode()
        with self._failing(f"pushing {path}"), self._device.open_transport(timeout=SECONDS) as link:
            link.send_command("sync:")
            link.check_okay()
            link.conn.sendall(b"SEND" + struct.pack("<I", len(spec)) + spec)
            for at in range(0, len(content), CHUNK):
                part = content[at : at + CHUNK]
                link.conn.sendall(b"DATA" + struct.pack("<I", len(part)) + part)
            link.conn.sendall(b"DONE" + struct.pack("<I", int(time.time())))
            answer, length = struct.unpack("<4sI", link.read_exact(8))
            if answer != b"OKAY":
                raise AdbError(link.read_string(length))

    def size(self, path: str) -> int | None:
        """Bytes of a file on the headset; None if there is none."""
        with self._failing(f"looking at {path}"):
            found = self._device.sync.stat(path)
            return int(found.size) if found.mode else None

    def log(self, *tags: str, silence: float) -> Generator[str, None, None]:
        """Lines of the log as they come, with an empty one after each `silence` seconds without any.

        Ends when the connection does.
        """
        with self._failing("reading the log"), closing(self._follow(tags)) as link:
            link.settimeout(silence)
            held = b""
            while True:
                try:
                    held += (came := link.recv(CHUNK))
                except TimeoutError:
                    yield ""
                    continue
                if not came:
                    return
                *lines, held = held.split(b"\n")
                yield from (line.decode(errors="replace").rstrip("\r") for line in lines)

    def _follow(self, tags: tuple[str, ...]) -> socket.socket:
        stream = self._device.shell(["logcat", "-v", "time", "-s", *tags], stream=True)
        link: socket.socket = stream.conn
        return link

    @contextmanager
    def _failing(self, doing: str) -> Iterator[None]:
        try:
            yield
        except (AdbError, OSError, EOFError) as error:
            raise InputError(f"{self.serial}: {doing} failed with {_reason(error)}") from error


def connect(serial: str | None = None) -> Headset:
    """The headset of that serial number, or the only one that is attached.

    Errors: InputError if no adb server answers, and if there is not exactly one headset or it is not ready.
    """
    client = AdbClient()
    states = attached(client)
    if serial is None:
        if len(states) != 1:
            raise InputError(_which(states))
        serial = next(iter(states))
    if serial not in states:
        raise InputError(f"--serial is {serial!r}; attached are {', '.join(states) or 'none'}")
    if states[serial] != "device":
        raise InputError(f"{serial} {meaning(states[serial])}")
    return Headset(client.device(serial))


def attached(client: AdbClient) -> dict[str, str]:
    """Serial number to state of everything that adb sees."""
    try:
        return {device.serial: device.state for device in client.list()}
    except (AdbError, OSError, EOFError) as error:
        raise InputError(
            f"the adb server at {client.host}:{client.port} does not answer ({_reason(error)}): "
            "install Android's platform tools and run 'adb start-server'"
        ) from error


def meaning(state: str) -> str:
    """A sentence for a state other than `device`, with the fix."""
    return STATES.get(state, f"is in state {state!r}, expected 'device': restart it")


def one_line(text: str) -> str:
    """A program's text as part of a sentence."""
    return " ".join(text.split())


def _which(states: dict[str, str]) -> str:
    if not states:
        return (
            "no headset is attached: connect it by USB, turn on its developer mode and allow USB debugging, "
            "then look with 'adb devices'"
        )
    return f"{len(states)} headsets are attached ({', '.join(states)}): choose one with --serial"


def _reason(error: Exception) -> str:
    if isinstance(error, EOFError) or not str(error):
        return "the connection cut off"
    return one_line(str(error))
