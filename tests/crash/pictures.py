#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Uploads models whose textures are damaged. Jobs must make models without these textures; the daemon must survive.

Usage: pictures.py BINARIES [DAMAGES [SEED]]

For each texture, makes DAMAGES (default 3) shortened copies and as many copies with flipped bits. JPEG, WebP and PNG files are
textures of GLB files; TIFF, BMP and TGA files are next to an OBJ file in a ZIP package. Pictures in formats that the reader
does not support, such as GIF, count as damaged. Prints the random seed and how the jobs ended.
"""
import collections
import io
import json
import random
import struct
import sys
import tempfile
import zipfile
from pathlib import Path

from daemon import Client, Daemon, new_token
from disk import is_served, job_of, upload

CORPUS = Path(__file__).resolve().parents[1] / "fuzz/corpus/decode_picture"
EMBEDDED = ("jpeg", "webp_lossy", "webp_lossless", "png")
PACKAGED = ("tiff", "tiff_cmyk", "bmp", "tga", "tga_runs")
HEADER = 32  # number of bytes at the start of a picture; every second damage is among them
FOREIGN = {"TIFF": b"II*\0\x08\0\0\0" + bytes(64), "big-endian TIFF": b"MM\0*\0\0\0\x08" + bytes(64), "GIF": b"GIF89a" + bytes(64),
           "nothing": bytes(64)}


def padded(content):
    return content + bytes(-len(content) % 4)


def glb(picture):
    """Returns a GLB file of a square with this picture as its texture."""
    places = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0)
    coordinates = struct.pack("<8f", 0, 0, 1, 0, 1, 1, 0, 1)
    corners = struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    parts, views, binary = (places, coordinates, corners, picture), [], b""
    for part in parts:
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(part)})
        binary += padded(part)
    document = {
        "asset": {"version": "2.0"}, "buffers": [{"byteLength": len(binary)}], "bufferViews": views,
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                      {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "images": [{"bufferView": 3, "mimeType": "image/png"}], "textures": [{"source": 0}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def package(picture, name):
    """Returns a ZIP file with an OBJ file of a square, its material library, and this picture as its texture."""
    picture_name, content = f"square.{name.partition('_')[0]}", io.BytesIO()
    with zipfile.ZipFile(content, "w") as files:
        files.writestr("square.obj", "mtllib square.mtl\nusemtl square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                       "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n")
        files.writestr("square.mtl", f"newmtl square\nmap_Kd {picture_name}\n")
        files.writestr(picture_name, picture)
    return content.getvalue()


def damaged(content, count, dice):
    """Yields `count` shortened copies of a picture, and `count` copies with some flipped bits."""
    for number in range(count):
        at = dice.randrange(1, min(HEADER, len(content)) if number % 2 else len(content))
        yield content[:at]
        bits = bytearray(content)
        for _ in range(dice.choice([1, 1, 8])):
            bits[dice.randrange(min(HEADER, len(content)) if number % 2 else len(content))] ^= 1 << dice.randrange(8)
        yield bytes(bits)


class Uploads:
    def __init__(self, client):
        self.client, self.seen = client, collections.Counter()

    def model(self, picture, name):
        """Makes a model from a file with a texture. Returns the model, and whether it has the texture."""
        file = package(picture, name) if name in PACKAGED else glb(picture)
        job = job_of(self.client, upload(self.client, file)[1], metadata={"title": name})
        assert job["state"] == "done", f"{name} {picture.hex()}: {job}"
        assert is_served(self.client, job["model"]), job
        has_texture = self.client.json("GET", f"/api/v1/models/{job['model']}/manifest")[1]["texture"] is not None
        self.seen[f"{name}: {'with' if has_texture else 'without'} the texture"] += 1
        return job["model"], has_texture


def run(daemon, token, count, dice):
    client = Client(daemon, token)
    uploads = Uploads(client)
    for name in EMBEDDED + PACKAGED:
        content = (CORPUS / name).read_bytes()
        whole, has_texture = uploads.model(content, name)
        assert has_texture, name
        for picture in [content[:len(content) // 3], *damaged(content, count, dice)]:
            uploads.model(picture, name)
        assert uploads.seen[f"{name}: without the texture"] > 0, f"no damage of {name} is found"
        assert is_served(client, whole), name
    for name, content in FOREIGN.items():
        assert not uploads.model(content, name)[1], name
    for message, times in sorted(uploads.seen.items()):
        print(f"{times:4} {message}")


def main():
    binaries, count = Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 3
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else random.SystemRandom().randrange(1 << 32)
    print(f"seed {seed}", flush=True)
    with tempfile.TemporaryDirectory(prefix="vitrine-") as folder:
        data = Path(folder) / "data"
        data.mkdir()
        token = new_token(binaries, data)
        daemon = Daemon(binaries, data)
        try:
            run(daemon, token, count, random.Random(seed))
        except BaseException:
            daemon.kill()
            print("".join(line for line in daemon.printed[-20:] if "event=audit" not in line))
            raise
        assert daemon.stop() == 0, daemon.printed[-3:]
    print("ok")


if __name__ == "__main__":
    main()
