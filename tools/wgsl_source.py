"""HLSL as slangc takes it for WGSL, where a number that is counted in is of an atomic type, in all its uses."""

import re

INDEX = r"(?:\[(?:[^][]|\[[^][]*\])*\])?"
COUNTED = re.compile(r"\bInterlocked\w+\(\s*(\w+)")


def with_atomics(text: str) -> str:
    """The file with everything that an Interlocked call changes declared, read and written as an Atomic."""
    for name in sorted(set(COUNTED.findall(text))):
        place = rf"\b{name}{INDEX}"
        text = re.sub(rf"\bInterlocked(\w+)\(\s*({place}),(.*?)\);", _call, text)
        text = re.sub(rf"(?<!int )({place}) = (.*?);", r"\1.store(\2);", text)
        text = re.sub(rf"(?<!int )(?<!> )({place})(?!\.\w+\(|\w|\[)", r"\1.load()", text)
        text = re.sub(rf"(groupshared )(u?int)( {name}\b)", r"\1Atomic<\2>\3", text)
        text = re.sub(rf"(RWStructuredBuffer<)(u?int)(> {name}\b)", r"\1Atomic<\2>\3", text)
    return text


def _call(found: re.Match[str]) -> str:
    """InterlockedAdd(place, value) or (place, value, before)."""
    name, place, rest = found.groups()
    *value, last = re.split(r",(?![^(]*\))", rest)
    call = f"{place}.{name[0].lower()}{name[1:]}({(','.join(value) or last).strip()});"
    return f"{last.strip()} = {call}" if value else call
