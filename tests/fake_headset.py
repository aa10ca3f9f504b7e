"""A headset as far as mua-deploy can see one: files, properties, packages, a log, a player. Scripted to fail."""

import shlex
import threading
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

STAMP = "11-21 12:00:00.000"
PACKAGE = "com.mua.player"
# As Meta's documentation has it.
VRAPI = (
    "FPS=72/72,Prd=38ms,Tear=0,Early=0,Stale=0,Stale2/5/10/max=0/0/0/0,VSnc=1,Lat=-1,Fov=0,CPU4/GPU=4/4,1171/441MHz,"
    "OC=FF,TA=0/0/0,SP=N/N/N,Mem=2092MHz,Free=2975MB,PLS=0,Temp=32.2C/0.0C,TW=1.25ms,App=4.49ms,GD=0.00ms,"
    "CPU&GPU=12.96ms,LCnt=2(DR72,LM2),GPU%=0.43,CPU%=0.37(W0.50),DSF=1.00,CFL=19.79/21.54"
)


def unity(text: str) -> str:
    return f"{STAMP} I/Unity   ( 4242): {text}"


def vrapi(text: str = VRAPI) -> str:
    return f"{STAMP} I/VrApi   ( 4242): {text}"


def mute(arguments: list[str]) -> list[str]:
    """A player that says nothing."""
    return []


@dataclass
class FakeHeadset:
    """Everything that a test reads or scripts."""

    serial: str = "2G0YC1"
    state: str = "device"
    features: str = "shell_v2,cmd"
    files: dict[str, bytes] = field(default_factory=dict)
    folders: set[str] = field(default_factory=lambda: {"/data/local/tmp"})
    properties: dict[str, str] = field(
        default_factory=lambda: {
            "ro.product.model": "Quest 3",
            "ro.build.version.release": "14",
            "ro.build.version.sdk": "34",
            "ro.build.display.id": "UP1A.231005.007",
            "debug.oculus.gpuLevel": "2",
        }
    )
    packages: set[str] = field(default_factory=lambda: {PACKAGE})
    battery: str = "87"
    worn: bool = False
    install_answer: str = "Success"
    start_answer: str = "Starting: Intent { cmp=com.mua.player/com.unity3d.player.UnityPlayerGameActivity }"
    player: Callable[[list[str]], Iterable[str]] = mute  # words of its command line to lines of the log
    log: list[str] = field(default_factory=list)
    keeps_log: bool = False  # logcat -c fails
    log_ends: bool = False
    cut_after: int | None = None  # bytes of a push until the connection breaks
    gone_after_cut: bool = False
    refuses_push: str | None = None  # the reason it gives
    loses_tail: bool = False  # of each pushed file, and says nothing
    renames: bool = True  # else mv does nothing, and says nothing
    frozen: frozenset[str] = frozenset()  # properties that cannot be set
    asked: list[str] = field(default_factory=list)  # every shell command
    started: list[list[str]] = field(default_factory=list)  # command line of each start of the player
    logged: threading.Condition = field(default_factory=threading.Condition)

    def shell(self, line: str) -> tuple[int, str]:
        """Exit code and text of commands parted by semicolons."""
        self.asked.append(line)
        lexer = shlex.shlex(line, posix=True, punctuation_chars=";")
        lexer.whitespace_split, lexer.commenters = True, ""
        code, text, command = 0, "", list[str]()
        for word in [*lexer, ";"]:
            if word != ";":
                command.append(word)
                continue
            said = self._echo(command, code) if command[0] == "echo" else None
            code, new = said or self._run(command)
            text, command = text + new, []
        return code, text

    def write(self, path: str, content: bytes) -> None:
        self.files[path] = content[:-1] if self.loses_tail and content else content

    @staticmethod
    def _echo(command: list[str], code: int) -> tuple[int, str]:
        return 0, " ".join(command[1:]).replace("$?", str(code)) + "\n"

    def _run(self, command: list[str]) -> tuple[int, str]:
        match command:
            case ["getprop", name]:
                return 0, self.properties.get(name, "") + "\n"
            case ["setprop", name, value]:
                if name not in self.frozen:
                    self.properties[name] = value
            case ["mkdir", "-p", path]:
                self.folders.add(path)
            case ["mv", "-f", old, new]:
                if old not in self.files:
                    return 1, f"mv: bad '{old}': No such file or directory\n"
                if self.renames:
                    self.files[new] = self.files.pop(old)
            case ["rm", "-f", *paths]:
                for path in paths:
                    self.files.pop(path, None)
            case ["dumpsys", "battery"]:
                return 0, f"Current Battery Service state:\n  USB powered: true\n  level: {self.battery}\n"
            case ["dumpsys", "package", name]:
                return 0, f"Packages:\n  Package [{name}] (1a2b):\n    versionCode=1 minSdk=29\n    versionName=0.1.0\n"
            case ["logcat", "-c"]:
                return self._clear_log()
            case ["pm", *rest]:
                return self._pm(rest)
            case ["am", *rest]:
                return self._am(rest)
            case _:
                return 127, f"sh: {command[0]}: inaccessible or not found\n"
        return 0, ""

    def _pm(self, words: list[str]) -> tuple[int, str]:
        if words[0] == "path":
            there = words[1] in self.packages
            return (0, f"package:/data/app/{words[1]}/base.apk\n") if there else (1, "")
        assert words[0] == "install"
        assert words[-1] in self.files
        if self.install_answer != "Success":
            return 1, self.install_answer + "\n"
        self.packages.add(PACKAGE)
        return 0, "Success\n"

    def _am(self, words: list[str]) -> tuple[int, str]:
        if words[0] == "broadcast":
            self.worn = words[-1].endswith("prox_close")
            return 0, f"Broadcasting: Intent {{ act={words[-1]} }}\nBroadcast completed: result=0\n"
        if words[0] == "start":
            arguments = words[words.index("unity") + 1].split(" ")
            self.started.append(arguments)
            if "Error" not in self.start_answer:
                self.say(self.player(arguments))
            return 0, self.start_answer + "\n"
        return 0, ""

    def say(self, lines: Iterable[str]) -> None:
        """Write to the log."""
        for line in lines:
            with self.logged:
                self.log.append(line)
                self.logged.notify_all()

    def _clear_log(self) -> tuple[int, str]:
        if self.keeps_log:
            return 1, "failed to clear the 'main' log\n"
        self.log.clear()
        return 0, ""
