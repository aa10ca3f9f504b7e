"""The triangles of a file's surface, written from section 8 of schemas/README.md alone, corner by corner."""

from collections.abc import Iterator
from typing import Any

Tree = dict[str, Any]
Triangle = tuple[int, ...]


def surface(avatar: Tree) -> list[Triangle]:
    """Of a tree that `decoder.read` gives."""
    return [*_blocks(avatar), *_strips(avatar["surface"]["strips"])]


def _blocks(avatar: Tree) -> Iterator[Triangle]:
    size = avatar["texels"]["size"]
    valid = {texel: e for e, texel in enumerate(avatar["texels"]["texels"].tolist())}
    codes = [int(byte) % 16 for byte in avatar["surface"]["runs"] for _ in range(byte // 16 + 1)]  # 8.2
    for row in range(size - 1):
        for col in range(size - 1):
            a, b, c, d = (valid.get((row + r) * size + col + s) for r in (0, 1) for s in (0, 1))  # 8.1
            if (a, b, c, d).count(None) <= 1:
                code = codes.pop(0)
                triangles = ((a, b, c), (b, d, c)) if code & 4 else ((a, b, d), (a, d, c))
                for bit, triangle in zip((1, 2), triangles, strict=True):
                    if code & bit:
                        corners = [corner for corner in triangle if corner is not None]
                        yield tuple(corners[::-1] if code & 8 else corners)
    assert not codes


def _strips(entries: Any) -> Iterator[Triangle]:
    """8.3"""
    strip: list[int] = []
    for entry in entries.tolist():
        if entry == -1:
            p, q = (s // 2 for s in strip[:2])
            for s in strip[2:]:
                yield p, q, s // 2
                p, q = (s // 2, q) if s % 2 == 0 else (p, s // 2)
            strip = []
        else:
            strip.append(entry)
