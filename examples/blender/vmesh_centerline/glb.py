"""What vmesh writes as GLB, for Blender: its own importer makes loose bones of --bones, and fails on Debian 12 (np.bool)."""

import json
import struct

import numpy

_TYPES = {5121: numpy.uint8, 5123: numpy.uint16, 5125: numpy.uint32, 5126: numpy.float32}
_COMPONENTS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Surface:
    """Positions are in metres and Blender's axes, which are vmesh's: x to the left, y to the back, z up."""

    def __init__(self, content):
        if content[:4] != b"glTF" or struct.unpack_from("<I", content, 4)[0] != 2:
            raise ValueError("no GLB of version 2")
        size = struct.unpack_from("<I", content, 12)[0]
        self._scene = json.loads(content[20 : 20 + size])
        self._buffer = memoryview(content)[20 + size + 8 :]
        primitives = self._scene["meshes"][0]["primitives"]  # of patches; they share their vertices
        attributes = primitives[0]["attributes"]
        self.positions = z_up(self._values(attributes["POSITION"]) + self._middle())
        patches = [self._values(primitive["indices"]).reshape(-1, 3) for primitive in primitives]
        self.triangles = numpy.concatenate(patches)
        self.material_of_triangle = numpy.repeat(numpy.arange(len(patches)), [len(patch) for patch in patches])
        self.materials = [self._scene["materials"][primitive["material"]]["name"] for primitive in primitives]
        self.colors = self._values(attributes["COLOR_0"]) if "COLOR_0" in attributes else None
        self.attributes = {
            self._scene["accessors"][number]["name"]: self._attribute(number)
            for name, number in attributes.items()
            if name.startswith("_")
        }
        self.joints = []
        if "JOINTS_0" in attributes:
            self.joint_of_vertex = self._values(attributes["JOINTS_0"]).astype(int)
            self.weights = self._values(attributes["WEIGHTS_0"])
            nodes = [self._scene["nodes"][number] for number in self._scene["skins"][0]["joints"]]
            self.joints = [(n["name"], z_up(numpy.array([n.get("translation", [0, 0, 0])]))[0]) for n in nodes]

    def _middle(self):
        """Positions are relative to the middle of the surface, unless there are bones."""
        node = next(node for node in self._scene["nodes"] if node.get("mesh") == 0)
        return numpy.array(node.get("translation", [0, 0, 0]))

    def _values(self, number):
        accessor = self._scene["accessors"][number]
        view = self._scene["bufferViews"][accessor["bufferView"]]
        kind, width = numpy.dtype(_TYPES[accessor["componentType"]]), _COMPONENTS[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        values = numpy.frombuffer(self._buffer, kind, accessor["count"] * width, start)
        if accessor.get("normalized"):
            values = values / numpy.float32(numpy.iinfo(kind).max)
        return values.reshape(-1, width) if width > 1 else values

    def _attribute(self, number):
        values = self._values(number)
        whole = self._scene["accessors"][number].get("extras", {}).get("integer")
        return values.astype(numpy.int32) if whole else values.astype(numpy.float32)


def z_up(points):
    """From glTF's axes."""
    return numpy.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)
