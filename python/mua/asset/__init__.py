"""The `.muaavatar` file: the avatar in memory, the writer and the reader. Needs no torch."""

from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.asset.write import write

__all__ = ["Avatar", "read", "write"]
