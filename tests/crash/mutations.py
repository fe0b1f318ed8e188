# SPDX-License-Identifier: Apache-2.0
"""Random changes of bytes, for tests that send hostile input."""

# Texts on which parsers have failed.
TROUBLE = [b"", b"\0", b"\r\n", b"\n", b" ", b"\t", b":", b",", b";", b"%", b"%00", b"%2e%2e/", b"../", b"//", b"?", b"#", b"&", b"=",
           b"-1", b"0", b"00", b"4294967296", b"9223372036854775808", b"18446744073709551616", b"1e999", b"NaN", b"0x10", b"\xff\xfe",
           b"\xc0\xaf", b"\xf0\x9f\x92\xa9", b"null", b"[]", b"{}", b'"', b"[" * 200, b'{"a":' * 100, b"A" * 300, b"a" * 9000,
           b"chunked", b"gzip", b"bytes=0-0,-1", b"bytes=18446744073709551615-", b"Transfer-Encoding: chunked\r\n", b"Content-Length: 5\r\n",
           b"Host: other.example\r\n", b"Expect: 100-continue\r\n", b"Connection: close, upgrade\r\n"]


def flip_bit(dice, text, _):
    at = dice.randrange(len(text))
    return text[:at] + bytes([text[at] ^ 1 << dice.randrange(8)]) + text[at + 1:]


def cut(dice, text, _):
    return text[:dice.randrange(len(text))]


def remove(dice, text, _):
    at = dice.randrange(len(text))
    return text[:at] + text[at + dice.randint(1, 16):]


def repeat(dice, text, _):
    at = dice.randrange(len(text))
    end = at + dice.randint(1, 64)
    return text[:end] + text[at:end] * dice.choice([1, 2, 50]) + text[end:]


def insert(dice, text, _):
    at = dice.randrange(len(text) + 1)
    return text[:at] + dice.choice(TROUBLE) + text[at:]


def replace(dice, text, _):
    at = dice.randrange(len(text))
    return text[:at] + dice.choice(TROUBLE) + text[at + dice.randint(1, 8):]


def randomise(dice, text, _):
    at = dice.randrange(len(text))
    return text[:at] + dice.randbytes(dice.randint(1, 32)) + text[at:]


def join_with_other(dice, text, seeds):
    other = dice.choice(seeds)
    return text[:dice.randrange(len(text))] + other[dice.randrange(len(other)):]


CHANGES = (flip_bit, cut, remove, repeat, insert, insert, replace, replace, randomise, join_with_other)


def mutated(dice, seeds):
    """Returns a random one of `seeds` after one to four random changes."""
    text = dice.choice(seeds)
    for _ in range(dice.choice([1, 1, 1, 2, 4])):
        text = dice.choice(CHANGES)(dice, text, seeds) or b"\0"
    return text
