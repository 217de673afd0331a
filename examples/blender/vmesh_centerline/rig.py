"""An armature to pose a vessel tree by, from the joints that vmesh's --bones are.

Those are three frames for every segment, side by side, for a program that places all of them. Here every segment is one
bone, "segment S", a child of the one before it, so that turning it takes all beyond along; "root N" is where a tree
begins. The skin needs one more for each, hidden: "segment S parent" is turned like the bone before S, but at the end of
S. So posed, vertices go where vmesh deforms them to (Eq. 10 of the paper).
"""

import re

import numpy

_LEAST_LENGTH = 2e-6  # Blender removes bones of less than 1e-6
_CONSTRAINT = "vmesh"


class Slot:
    """A segment, or a node where a tree begins, and the joints that belong to it."""

    def __init__(self, name, position, joints, start=None, parent=None):
        self.name, self.position, self.joints, self.start, self.parent = name, position, joints, start, parent

    @property
    def helper(self):
        return self.name + " parent"


def slots_of(joints):
    """The tree, parents first, of joints as (name, position): for a root "node N", for others "node N", "segment S
    start" and "segment S parent"."""
    slots = []
    for number, (name, position) in enumerate(joints):
        if not name.startswith("node "):
            continue
        start = re.fullmatch(r"(segment \d+) start", joints[number + 1][0]) if number + 1 < len(joints) else None
        if not start:
            slots.append(Slot("root " + name.split()[1], position, [number]))
            continue
        begin = joints[number + 1][1]
        parent = _parent_of(begin, slots)
        slots.append(Slot(start[1], position, [number, number + 1, number + 2], begin, parent))
    return slots


def _parent_of(begin, slots):
    """The one that ends where a segment begins; of those, the one from which the tree goes on: a branch that closes a
    loop ends at a node too, but nothing begins there."""
    before = slots[-1] if slots else None
    found = None
    while before is not None:
        if (before.position == begin).all():
            found = before
        before = before.parent
    if found is None:
        raise ValueError("a segment begins where none ends")
    return found


def weights(slots, joint_of_vertex, weight_of_vertex):
    """Name of each bone that moves vertices: their numbers and weights."""
    of_joint = {}
    for slot in slots:
        for joint in slot.joints[:2]:
            of_joint[joint] = slot.name
        for joint in slot.joints[2:]:
            of_joint[joint] = slot.helper
    names = sorted(set(of_joint.values()))
    column = {name: i for i, name in enumerate(names)}
    columns = numpy.array([column[of_joint[joint]] for joint in range(len(of_joint))])[joint_of_vertex]
    vertices = numpy.arange(len(columns))
    keys = (columns * len(vertices) + vertices[:, None]).ravel()
    unique, place = numpy.unique(keys, return_inverse=True)
    sums = numpy.bincount(place, weight_of_vertex.ravel())
    of_bone, of_vertex = unique // len(vertices), unique % len(vertices)
    return {
        name: (of_vertex[rows].tolist(), sums[rows].tolist())
        for name, rows in ((names[i], (of_bone == i) & (sums > 0)) for i in numpy.unique(of_bone))
    }


def make_bones(slots, edit_bones, scale):
    """In edit mode, instead of what bones there are."""
    for bone in list(edit_bones):
        edit_bones.remove(bone)
    for slot in slots:
        bone = edit_bones.new(slot.name)
        begin, end = _ends_of(slot, slots)
        _place(bone, scale * begin, scale * end)
        if slot.parent is None:
            continue
        bone.parent = edit_bones[slot.parent.name]
        helper = edit_bones.new(slot.helper)
        before = bone.parent
        # The rest of what it copies, elsewhere.
        at = scale * slot.position
        _place(helper, at, at + numpy.array(before.tail - before.head))
        helper.roll = before.roll
        helper.parent = bone


def make_helpers_follow(slots, armature_object):
    """After make_bones(), in object mode."""
    for slot in slots:
        if slot.parent is None:
            continue
        armature_object.data.bones[slot.helper].hide = True
        bone = armature_object.pose.bones[slot.helper]
        for constraint in [c for c in bone.constraints if c.name == _CONSTRAINT]:
            bone.constraints.remove(constraint)
        follow = bone.constraints.new("COPY_ROTATION")
        follow.name = _CONSTRAINT
        follow.target, follow.subtarget = armature_object, slot.parent.name
        follow.target_space = follow.owner_space = "POSE"


def _ends_of(slot, slots):
    if slot.parent is not None:
        return slot.start, slot.position
    first = next((other for other in slots if other.parent is slot), None)
    toward = first.position - slot.position if first else numpy.array([0, 0, 4e-3])
    return slot.position - toward / 4, slot.position


def _place(bone, begin, end):
    """With a length that Blender keeps."""
    along = end - begin
    length = numpy.linalg.norm(along)
    if length < _LEAST_LENGTH:
        end = begin + along * (_LEAST_LENGTH / length)
    bone.head, bone.tail = begin, end
