#!/usr/bin/env python3
"""Writes the corpus files that are made by formula: small measured files of every layout.
Run from the repository root: python3 tests/fuzz/make_corpus.py
(corpus/asset comes from the nacre command: factorize MODEL --size 4 in each storage format, and
envmap of a 4 x 2 picture --convert,
bump of a 4 x 3 picture with every output; corpus/exr from OpenEXR:
tests/core/exr_files.hpp, 9 × 9 texels or less in each compression.)"""
import base64
import json
import math
import os
import struct
import zlib

FLOAT, UINT8 = 10, 1
corpus = os.path.join(os.path.dirname(__file__), "corpus")


def write(name, data):
    path = os.path.join(corpus, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(data)


def tensor_file(fields):
    """fields: (name, shape, numbers or bytes)"""
    size = 18 + sum(2 + len(n) + 2 + 1 + 8 + 8 * len(s) for n, s, _ in fields)
    head = b"tensor_file\0\x01\0" + struct.pack("<I", len(fields))
    body = b""
    for name, shape, numbers in fields:
        text = isinstance(numbers, bytes)
        data = numbers if text else struct.pack(f"<{len(numbers)}f", *numbers)
        head += struct.pack("<H", len(name)) + name.encode() + struct.pack("<HB", len(shape), UINT8 if text else FLOAT)
        head += struct.pack("<Q", size + len(body)) + struct.pack(f"<{len(shape)}Q", *shape)
        body += data
    return head + body


def rgl(phi):
    theta, n = [0.1, 1.2], 3
    grid = [1 + 0.1 * math.sin(i) for i in range(n * n)]
    slices = len(phi) * len(theta)
    return tensor_file([
        ("phi_i", [len(phi)], phi), ("theta_i", [len(theta)], theta),
        ("sigma", [n, n], grid), ("ndf", [n, n], grid),
        ("vndf", [len(phi), len(theta), n, n], grid * slices),
        ("rgb", [len(phi), len(theta), 3, n, n], grid * 3 * slices),
        ("description", [4], b"made"),
    ])


write("rgl/isotropic.bsdf", rgl([0.0]))
write("rgl/anisotropic.bsdf", rgl([-math.pi, -math.pi / 2, 0.0, math.pi / 2, math.pi]))
write("rgl/header_only.bsdf", rgl([0.0])[:20])
write("merl/header_only.binary", struct.pack("<3i", 90, 90, 180))
write("merl/short.binary", struct.pack("<3i8d", 90, 90, 180, *range(8)))
write("merl/wrong_dimensions.binary", struct.pack("<3i8d", 2, 2, 2, *range(8)))
write("merl/negative_dimensions.binary", struct.pack("<3i8d", -90, -90, 180, *range(8)))
write("merl/product_matches.binary", struct.pack("<3i8d", 180, 90, 90, *range(8)))
models = [
    "lambert", "lambert:kd=0.1/0.2/0.3", "torrance-sparrow:d=beckmann,alpha=0.1,f=conductor,eta=1.5,k=3",
    "ward:alphax=0.1,alphay=0.3", "ggx:alphax=0.1,alphay=0.4", "blinn-phong:n=1e6", "phong:n=0", "sgd:gold-paint",
    "ashikhmin-shirley:nu=50,nv=500", "cosine-lobe", "schlick", "banks",
]
for i, model in enumerate(models):
    write(f"model/{i:02}.txt", model.encode())
write("samples/vectors.csv", b"# made\nwix,wiy,wiz,wox,woy,woz,r,g,b\n0,0,1,0,0,1,0.1,0.2,0.3\n"
      b"0.6,0,0.8,0,0.6,0.8,1e-3,0,nan\n\n0,0,1,0.6,0,0.8,-1,0,0\n")
write("samples/degrees.csv", b"theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,r,g,b\r\n10,0,20,180,1,1,1\r\n89.9,0,90,0,1,1,1")
write("samples/radians.csv", b"theta_i,phi_i,theta_o,phi_o,r,g,b\n0.1,0,0.2,3.14,1,1,inf\n")
write("samples/header.csv", b"a,b,c\n1,2,3\n")
write("directions/header.csv", b"wix,wiy,wiz,wox,woy,woz\n0,0,1,0,0,1\n0.6,0,0.8,0,0.6,0.8\r\n# end\n")
write("directions/bare.csv", b"0,0,1,0,0,1")
write("directions/broken.csv", b"0,0,1,0,0\n1,nan,inf,1e999,-0,.\n,,,,,\n")
head = b"#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n"
write("radiance/flat.hdr", head + b"-Y 2 +X 3\n" + bytes(range(100, 124)))
write("radiance/old_runs.hdr", head + b"+Y 1 -X 8\n" + b"\x80\x40\x20\x88\x01\x01\x01\x07")
row = b"\x02\x02\x00\x0a" + b"\x8a\x80" + b"\x03\x01\x02\x03\x87\x04" + b"\x0a" + bytes(range(10)) + b"\x8a\x88"
write("radiance/runs.hdr", head + b"-Y 2 +X 10\n" + row + row)
write("radiance/cut.hdr", head + b"-Y 2 +X 10\n" + row)
write("radiance/huge.hdr", head + b"-Y 16384 +X 16384\n" + row)
write("env_queries/queries.csv", b"x,y,z,alpha\n0,1,0\n1e300,0,-3,0.5\n# end\n\n0,0,-1e-300,1e9\r\n")
write("env_queries/broken.csv", b"0,0,0\nnan,1,1\n1,2\n1,2,3,4,5\n,,,\n")

write("bump_queries/queries.csv", b"u,v,lx,ly,lz\n0.5,0.5,0,0,1\n# end\n\n-3,1e9,1e300,0,-1e-300\r\n")
write("bump_queries/broken.csv", b"0,0,0,0,0\n0,nan,1,1,1\n1,2\n1,2,3,4,5,6\n,,,,\n")


def tiff(order, big, nodata):
    """One strip of two bytes and the tag GDAL_NODATA; the readers' layouts of TIFF 6.0 and BigTIFF."""
    size, count = ("Q", "Q") if big else ("I", "H")
    tags = [(273, 4, 1, struct.pack(order + "I", 0)), (279, 4, 1, struct.pack(order + "I", 2)),
            (42113, 2, len(nodata), nodata)]
    head = (b"II" if order == "<" else b"MM") + struct.pack(order + "H", 43 if big else 42)
    head += struct.pack(order + "HHQ", 8, 0, 16) if big else struct.pack(order + "I", 8)
    width = 8 if big else 4
    data_at = len(head) + struct.calcsize(order + count) + len(tags) * (4 + 2 * width) + width
    body, data = struct.pack(order + count, len(tags)), b""
    for tag, kind, number, value in tags:
        if len(value) > width:
            value, data = struct.pack(order + size, data_at + len(data)), data + value
        body += struct.pack(order + "HH" + size, tag, kind, number) + value.ljust(width, b"\0")
    return head + body + bytes(width) + data


write("tiff/little.tif", tiff("<", False, b"-32768\0"))
write("tiff/big.tif", tiff(">", False, b"nan"))
write("tiff/bigtiff.tif", tiff("<", True, b"-9999\0"))
write("tiff/bigtiff_big.tif", tiff(">", True, b"-3.4028234663852886e+38\0"))
write("tiff/no_number.tif", tiff("<", False, b"none\xff\0"))


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


png = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 1, 8, 0, 0, 0, 0)) +
       chunk(b"IDAT", zlib.compress(b"\0\1\2")) + chunk(b"IEND", b""))
write("png/grey.png", png)
write("png/cut.png", png[:-5])
boxes = b"".join(struct.pack("<9H", 0, 0, 0, 2, 1, 1, 3, 2, 2) for _ in range(3))
write("volume/head.den", struct.pack("<H", 1) + boxes + struct.pack("<HI", 3, 12) + bytes(range(12)))
for kind, bits, data in [("float", 32, struct.pack("<2f", 1, -2)), ("signed fixed", 16, struct.pack("<2h", 1, -2))]:
    header = f"#INRIMAGE-4#{{\nXDIM=2\nYDIM=1\nZDIM=1\nVDIM=1\nTYPE={kind}\nPIXSIZE={bits} bits\nCPU=decm\nVX=2\n"
    write(f"volume/{bits}.inr", header.encode().ljust(252, b"\n") + b"##}\n" + data)


def transfer(header, weld, triangles, blocks):
    text = json.dumps(header).encode()
    return (b"NACRE_TV" + struct.pack("<2I", 1, len(text)) + text + struct.pack(f"<{len(weld)}I", *weld) +
            struct.pack(f"<{len(triangles)}I", *triangles) + b"".join(struct.pack(f"<{len(b)}f", *b) for b in blocks))


header = {"kind": "transfer", "version": 1, "order": 1, "frames_per_second": 30, "vertices": 3, "source_vertices": 4,
          "triangles": 1, "blocks": 2, "frames": [0, 1, 3], "block_of_frame": [0, 0, 1]}
blocks = [[i / 8 - b for i in range(3 * (3 + 4))] for b in range(2)]
write("transfer/three.tv", transfer(header, [0, 1, 2, 0], [0, 1, 2], blocks))
write("transfer/cut.tv", transfer(header, [0, 1, 2, 0], [0, 1, 2], blocks)[:-30])
write("transfer/huge.tv", transfer({**header, "vertices": 2**31 - 1, "blocks": 2**31 - 1}, [], [], []))
write("transfer/empty.tv", transfer({**header, "vertices": 0, "source_vertices": 0, "triangles": 0}, [], [], []))


def visible(version, groups, places, windows, words):
    body = b"".join(struct.pack("<2i", *w) for w in windows) + struct.pack(f"<{len(words)}Q", *words)
    check = 0xcbf29ce484222325
    for byte in body:
        check = (check ^ byte) * 0x100000001b3 % 2**64
    return b"NACRE_PV" + struct.pack("<4I2Q", version, groups, places, len(windows), 99, check) + body


write("visible/two.pv", visible(3, 3, 70, [(0, 4), (4, 9)], range(12)))
write("visible/cut.pv", visible(3, 3, 70, [(0, 4), (4, 9)], range(11)))
write("visible/huge.pv", visible(3, 2**32 - 1, 2**32 - 1, [], []))


def glb(document, rest=b""):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest


lights = {"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 3, "range": 4, "color": [1, 0.5, 0],
                                              "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}},
                                             {"type": "directional"}]}}
gltf = {
    "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"], "extensions": lights, "scene": 0,
    "scenes": [{"nodes": [0, 3]}],
    "nodes": [{"name": "a", "children": [1, 2], "rotation": [0, 0.6, 0, 0.8], "scale": [1, 2, 3]},
              {"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}},
              {"camera": 0, "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]},
              {"camera": 1, "extensions": {"KHR_lights_punctual": {"light": 1}}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1], "metallicFactor": 0.5, "roughnessFactor": 0.3},
                   "emissiveFactor": [0, 0, 1], "alphaMode": "BLEND"}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}},
                {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 2, "znear": 0, "zfar": 9}}],
    "animations": [{"samplers": [{"input": 0, "output": 1, "interpolation": "STEP"}],
                    "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]}],
}
write("gltf/all.glb", glb(gltf, b"\4\0\0\0BIN\0abcd"))
write("gltf/all.gltf", json.dumps(gltf, indent=1).encode())
write("gltf/cycle.gltf", b'{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}]}')
write("gltf/cut.glb", glb(gltf)[:40])
scene = {
    "nacre_scene": 1,
    "assets": {"w": {"file": "w.exr", "bake": {"verb": "bump", "source": "w.png", "options": {"--scale": 2.5, "--ellipses": True,
                                                                                         "--light": [1, 0, 1]}}}},
    "meshes": {"b": {"sphere": {"segments": 6, "stacks": 4}, "fit": 3}, "q": {"quad": {"size": 2}},
               "t": {"torus": {"rings": 5, "sides": 4}}, "d": {"disk": {"segments": 5, "rings": 2}}},
    "materials": {"m": {"model": "ggx:alpha=0.3", "ambient": 0.1, "relief": {"asset": "w", "tiles": [2, 3]}},
                  "s": {"brdf": "w", "surrounding": {"reflection": {"asset": "w", "lod": 1}, "ior": 1.3}},
                  "g": {"specular": {"ior": 1.5, "partial": False, "surface": 0.5, "fogDistance": 2, "fog": 1, "spread": 0.1}}},
    "lights": {"l": {"type": "spot", "position": [0, 4, 0], "target": [0, 0, 0], "outerDeg": 30, "node": "n", "shadow": {"bits": 16}},
               "p": {"type": "point", "shadow": True}, "s": {"type": "directional", "direction": [0, -1, 0], "color": [1, 2, 3]}},
    "nodes": {"n": {"children": ["c"], "axis": [0, 1, 0], "angleDeg": 30},
              "c": {"mesh": "q", "material": "m", "scale": [1, 2, -3], "rotation": [0, 0, 0, 1]},
              "e": {"mesh": "b", "material": "s", "static": False}},
    "camera": {"eye": [0, 1, 5], "fovYDeg": 40},
    "sky": {"color": [0, 0, 1], "rotationYDeg": 20},
    "animation": {"duration": 3, "tracks": [
        {"node": "n", "path": "rotation", "times": [0, 1, 2], "axis": [0, 1, 0], "anglesDeg": [0, 90, 180]},
        {"node": "c", "path": "translation", "times": [0.5], "values": [[1, 2, 3]], "interpolation": "step"}]},
}
write("scene/all.json", json.dumps(scene, indent=1).encode())
write("scene/empty.json", b'{"nacre_scene": 1}')
write("scene/import.json", b'{"nacre_scene": 1, "nodes": {"n": {"import": "x.glb"}, "m": {"import": "scene.json"}}}')
write("scene/twice.json", b'{"nacre_scene": 1, "nodes": {"n": {}, "n": {}}}')
write("scene/cycle.json", b'{"nacre_scene": 1, "nodes": {"n": {"children": ["m"]}, "m": {"children": ["n"]}}}')

# A room that a headset scanned: a square of two triangles, and a box about it.
still = {"orientation": {"x": 0, "y": 0, "z": 0, "w": 1}, "position": {"x": 0, "y": 0, "z": 0}}
corners = struct.pack("<12f", *(c for i in range(4) for c in (i & 1, i >> 1, 0)))
write("scene/room.json", json.dumps({"type": "scene", "version": 1, "spatialEntities": [
    {"semanticLabel_META": "GLOBAL_MESH", "locatable_META": still, "triangleMesh_META": {
        "vertices": base64.b64encode(corners).decode(),
        "indices": base64.b64encode(struct.pack("<6I", 0, 1, 2, 1, 3, 2)).decode()}},
    {"semanticLabel_META": "TABLE", "locatable_META": still, "bounded3D_META": {
        "offset": {"x": 0, "y": 0, "z": 0}, "extent": {"width": 1, "height": 1, "depth": 1}}}]}, indent=1).encode())
write("scene/deep.json", b"[" * 70)


def iqm():
    parts, at = [], [144]

    def put(data):
        parts.append(data)
        at[0] += len(data)
        return at[0] - len(data)

    text = b"\0bend\0low\0high\0".ljust(20, b"\0")
    positions = put(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 0, 2))
    uvs = put(struct.pack("<6f", 0, 0, 1, 0, 0, 1))
    bones = put(bytes([0, 0, 0, 0] * 2 + [1, 0, 0, 0]))
    weights = put(bytes([255, 0, 0, 0, 100, 0, 0, 0, 255, 0, 0, 0]))
    arrays = put(struct.pack("<20I", 0, 0, 7, 3, positions, 1, 0, 7, 2, uvs, 4, 0, 1, 4, bones, 5, 0, 1, 4, weights))
    triangles = put(struct.pack("<3I", 0, 1, 2))
    low, high = (0, 0, 0, 0, 0, 0, 1, 1, 1, 1), (0, 0, 1, 0, 0, 0, 1, 1, 1, 1)
    joints = put(struct.pack("<Ii10f", 6, -1, *low) + struct.pack("<Ii10f", 10, 0, *high))
    poses = put(struct.pack("<iI20f", -1, 0, *low, *[0] * 10) + struct.pack("<iI20f", 0, 8, *high, 0, 0, 0, 1e-5, *[0] * 6))
    clips = put(struct.pack("<3IfI", 1, 0, 2, 24, 0))
    frames = put(struct.pack("<2H", 0, 65535))
    header = [2, at[0], 0, 20, 124, 0, 0, 4, 3, arrays, 1, triangles, 0, 2, joints, 2, poses, 1, clips, 2, 1, frames] + [0] * 5
    return b"INTERQUAKEMODEL\0" + struct.pack("<27I", *header) + text + b"".join(parts)


write("iqm/bend.iqm", iqm())
md2_frames = b"".join(struct.pack("<6f16s12B", 1, 1, 1, 0, 0, 0, n, *range(12)) for n in [b"run1", b"run2", b"wave001"])
write("md2/run.md2", b"IDP2" + struct.pack("<16I", 8, 64, 64, 52, 0, 3, 0, 0, 0, 3, 68, 68, 68, 68, 68, 0) + md2_frames)
