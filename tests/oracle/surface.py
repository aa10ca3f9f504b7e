"""Section 8 of schemas/README.md: the triangles of a file's surface, as corners among the valid texels."""

from collections.abc import Iterator

from oracle.file import Tree

Triangle = tuple[int, ...]


def triangles(avatar: Tree) -> list[Triangle]:
    codes = [run % 16 for run in map(int, avatar["surface"]["runs"]) for _ in range(run // 16 + 1)]  # 8.2
    found: list[Triangle] = []
    for code, (a, b, c, d) in zip(codes, _blocks(avatar), strict=True):
        two = [(a, b, c), (b, d, c)] if code & 4 else [(a, b, d), (a, d, c)]
        found += [t[::-1] if code & 8 else t for bit, t in zip((1, 2), two, strict=True) if code & bit]
    strips: list[list[int]] = [[]]
    for entry in map(int, avatar["surface"]["strips"]):
        strips = [*strips, []] if entry == -1 else [*strips[:-1], [*strips[-1], entry]]
    return found + [triangle for strip in strips for triangle in _strip(strip)]


def _blocks(avatar: Tree) -> Iterator[list[int]]:
    """8.1"""
    size = avatar["texels"]["size"]
    number = {int(texel): e for e, texel in enumerate(avatar["texels"]["texels"])}
    for row in range(size - 1):
        for col in range(size - 1):
            four = [number.get(r * size + c, -1) for r in (row, row + 1) for c in (col, col + 1)]
            if four.count(-1) <= 1:
                yield four


def _strip(s: list[int]) -> Iterator[Triangle]:
    """8.3"""
    if len(s) >= 3:
        p, q = s[0] // 2, s[1] // 2
        for entry in s[2:]:
            yield p, q, entry // 2
            p, q = (p, entry // 2) if entry % 2 else (entry // 2, q)
