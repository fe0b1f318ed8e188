# SPDX-License-Identifier: Apache-2.0
"""Runs in Blender: imports each file into an empty scene and prints a line IMPORTED with JSON: the
number of faces, the size of the object in Blender's unit and axes (z up), and its pictures' sizes.

Usage: blender --background --factory-startup --python-exit-code 1 --python blender.py -- FILE..."""

import json
import sys

import bpy
import numpy

# Blender 3.4 imports glTF by a name that the NumPy 1.24 of Debian 12 no longer has.
numpy.bool = bool

IMPORTERS = {
    "glb": bpy.ops.import_scene.gltf,
    "obj": bpy.ops.wm.obj_import,
    "ply": bpy.ops.import_mesh.ply,
    "stl": bpy.ops.import_mesh.stl,
}


def imported(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    IMPORTERS[path.rsplit(".", 1)[1]](filepath=path)
    meshes = [item for item in bpy.data.objects if item.type == "MESH"]
    return {
        "meshes": len(meshes),
        "triangles": sum(len(item.data.polygons) for item in meshes),
        "size": list(meshes[0].dimensions),
        "smooth": all(polygon.use_smooth for item in meshes for polygon in item.data.polygons),
        "pictures": [list(image.size) for image in bpy.data.images],
    }


for file in sys.argv[sys.argv.index("--") + 1 :]:
    print("IMPORTED", json.dumps(imported(file)), flush=True)
