"""What an expression is by its name, in the spellings of ARKit, VRM, Oculus' visemes and of exporters."""

import re
import unicodedata

ARKIT = (
    *(f"eye{part}{side}" for part in ("Blink", "Squint", "Wide") for side in ("Left", "Right")),
    *(f"eyeLook{way}{side}" for way in ("Up", "Down", "In", "Out") for side in ("Left", "Right")),
    *("jawForward", "jawLeft", "jawRight", "jawOpen"),
    *("mouthClose", "mouthFunnel", "mouthPucker", "mouthLeft", "mouthRight"),
    *("mouthRollLower", "mouthRollUpper", "mouthShrugLower", "mouthShrugUpper"),
    *(
        f"mouth{part}{side}"
        for part in ("Smile", "Frown", "Dimple", "Stretch", "Press", "LowerDown", "UpperUp")
        for side in ("Left", "Right")
    ),
    *(f"brow{part}{side}" for part in ("Down", "OuterUp") for side in ("Left", "Right")),
    *("browInnerUp", "cheekPuff", "cheekSquintLeft", "cheekSquintRight", "noseSneerLeft", "noseSneerRight"),
    "tongueOut",
)
VRM_MOODS = ("happy", "angry", "sad", "relaxed", "surprised", "neutral")
VRM_MOUTH = ("aa", "ih", "ou", "ee", "oh")
VRM_LOOK = ("lookUp", "lookDown", "lookLeft", "lookRight")
VRM = (*VRM_MOODS, *VRM_MOUTH, "blink", "blinkLeft", "blinkRight", *VRM_LOOK)  # VRM 1.0's presets
VISEMES = tuple(
    f"viseme_{sound}"
    for sound in ("sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "ih", "oh", "ou")
)

_ALIASES = {
    **{"a": "aa", "i": "ih", "u": "ou", "e": "ee", "o": "oh"},  # VRM 0's presets
    **{"joy": "happy", "sorrow": "sad", "fun": "relaxed"},
    **{"viseme_i": "viseme_ih", "viseme_o": "viseme_oh", "viseme_u": "viseme_ou"},  # Ready Player Me's
    **{sound: f"viseme_{sound}" for sound in ("sil", "pp", "ff", "th", "dd", "kk", "ch", "ss", "nn", "rr")},
    **{"mth_a": "aa", "mth_i": "ih", "mth_u": "ou", "mth_e": "ee", "mth_o": "oh"},  # VRoid's, Unity-chan's
    **{"eye_close": "blink", "eye_close_l": "blinkLeft", "eye_close_r": "blinkRight", "eye_def_c": "blink"},
    **{"all_joy": "happy", "all_angry": "angry", "all_sorrow": "sad", "all_fun": "relaxed"},
    **{"all_surprised": "surprised", "all_neutral": "neutral"},
    **{"eyes_closed": "blink", "eyes_look_up": "lookUp", "eyes_look_down": "lookDown"},  # Ready Player Me's simple ones
    **{"mouth_open": "aa", "mouth_smile": "happy"},
    **{"eye_closed_left": "eyeBlinkLeft", "eye_closed_right": "eyeBlinkRight"},  # VRChat's Unified Expressions
    **{"mouth_corner_pull_left": "mouthSmileLeft", "mouth_corner_pull_right": "mouthSmileRight"},
    **{"mouth_closed": "mouthClose", "lip_funnel": "mouthFunnel", "lip_pucker": "mouthPucker"},
    **{"あ": "aa", "い": "ih", "う": "ou", "え": "ee", "お": "oh", "まばたき": "blink"},  # MikuMikuDance's
    **{"ウィンク": "blinkLeft", "ウィンク右": "blinkRight", "笑い": "relaxed", "びっくり": "surprised"},
}
_WORD = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|[^\W\d_A-Za-z]+")
_OWNERS = {"ak", "arkit", "bs", "blend", "shape", "blendshape", "fcl", "head", "face", "vrc"}  # say nothing
_SIDE = {"l": "left", "r": "right"}
_ROCKETBOX_VISEME = re.compile(r"^(?:\w+\.)?AA_VI_\d\d_(\w+)$")


def _words(name: str) -> list[str]:
    """The words of a name, lower case, less those before it that only say whose it is."""
    own = unicodedata.normalize("NFKC", name).rsplit(".", 1)[-1]
    words = [word.lower() for word in _WORD.findall(own)]
    while len(words) > 1 and words[0] in _OWNERS:
        words = words[1:]
    return words


def _spelt(words: list[str]) -> str:
    """Words in one spelling: a last l or r is a side."""
    if len(words) > 1:
        words = [*words[:-1], _SIDE.get(words[-1], words[-1])]
    return "".join(words)


_BY_SPELLING = {_spelt(_words(name)): name for name in (*ARKIT, *VRM, *VISEMES)}
_BY_ALIAS = {_spelt(_words(alias)): name for alias, name in _ALIASES.items()}


def known_expression(name: str) -> str | None:
    """The expression of ARKIT, VRM or VISEMES that a name means, in whatever spelling; None for any other.

    VRM 0's presets mean those of VRM 1.0; a vowel alone (aa, E, ih, oh, ou) is VRM's.
    """
    rocketbox = _ROCKETBOX_VISEME.match(name)
    spelt = _spelt(_words(f"viseme_{rocketbox[1]}" if rocketbox else name))
    return _BY_SPELLING.get(spelt) or _BY_ALIAS.get(spelt)


def is_own_spelling(name: str) -> bool:
    """Whether a name is that of its expression in another spelling, and not only one with the same meaning."""
    return _spelt(_words(name)) in _BY_SPELLING
