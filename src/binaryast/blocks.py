"""Blocks that are appended to a file, each with its kind, its length and a hash.

A process that is killed, or a disk that is full, leaves at most the last block torn: its length or its hash then does
not fit, and it is left out. The hash goes on from that of the block before, so none can be missing in between.
"""

import hashlib
import struct
from typing import BinaryIO, NamedTuple

HEAD = struct.Struct("<8sQ")  # kind, and length in bytes
HASH_SIZE = 16
AT_ONCE = 1 << 20  # bytes that are read in one go


class Block(NamedTuple):
    """A block in a file: its kind, where its content begins, and how many bytes that has."""

    kind: str
    begin: int
    size: int

    @property
    def end(self) -> int:
        """Where the next block begins."""
        return self.begin + self.size + HASH_SIZE


class Chain(NamedTuple):
    """The blocks of a file.

    Attributes
    ----------
    blocks : list of Block
        Those that are whole.
    end : int
        Where the last of them ends.
    link : bytes
        Its hash, with which that of the next begins.
    damaged : bool
        Whether more follows that is not just the torn rest of one block.
    """

    blocks: list[Block]
    end: int
    link: bytes
    damaged: bool


def block(kind: str, content: bytes, link: bytes) -> bytes:
    """Return a block as it is written, given the hash of the one before; its own hash are its last bytes."""
    head = HEAD.pack(kind.encode(), len(content))
    return head + content + hashlib.blake2b(link + head + content, digest_size=HASH_SIZE).digest()


def chain(file: BinaryIO, begin: int) -> Chain:
    """Return the blocks of a file from where they begin on, as far as they are whole."""
    size = file.seek(0, 2)
    blocks: list[Block] = []
    link = b""
    while begin < size:
        found, hashed = _block(file, begin, size, link)
        if found is None:  # torn, if nothing can follow it
            return Chain(blocks, begin, link, damaged=False)
        if not hashed:
            return Chain(blocks, begin, link, damaged=found.end < size)
        blocks.append(found)
        begin, link = found.end, hashed
    return Chain(blocks, begin, link, damaged=False)


def _block(file: BinaryIO, begin: int, size: int, link: bytes) -> tuple[Block | None, bytes]:
    """Return the block that begins here and its hash, empty where that is wrong; None where the file ends within it."""
    file.seek(begin)
    head = file.read(HEAD.size)
    if len(head) < HEAD.size:
        return None, b""
    kind, length = HEAD.unpack(head)
    found = Block(kind.rstrip(b"\0").decode("ascii", "replace"), begin + HEAD.size, length)
    if found.end > size:
        return None, b""
    digest = hashlib.blake2b(link + head, digest_size=HASH_SIZE)
    left = length
    while left and (piece := file.read(min(left, AT_ONCE))):
        digest.update(piece)
        left -= len(piece)
    expected = file.read(HASH_SIZE)
    return found, expected if digest.digest() == expected else b""
