"""Writes tubes with ITK: itk_tubes.py version, or itk_tubes.py FILE binary|text with the tree's points, radius and
segments as JSON at stdin. Runs in the Python of ITK (scripts/check-formats)."""
import json
import sys

import itk
import numpy


def tube(number, points, radius):
    made = itk.TubeSpatialObject[3].New()
    made.SetId(number)
    for i, place in enumerate(points):
        point = itk.TubeSpatialObjectPoint[3]()
        point.SetId(i)
        point.SetPositionInObjectSpace(place)
        point.SetRadiusInObjectSpace(radius)
        made.AddPoint(point)
    return made


def scene(points, radius, segments):
    """A tube for every segment, the first the parent of all others, which begin at its last point. It is turned by a
    quarter and moved, and its children with it."""
    turn, offset = numpy.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]]), numpy.array([10, 20, 30.0])
    local = (numpy.array(points) - offset) @ turn  # by the inverse, which is the transposed
    group = itk.GroupSpatialObject[3].New()
    tubes = [tube(number + 1, local[list(ends)].tolist(), radius) for number, ends in enumerate(segments)]
    group.AddChild(tubes[0])
    for child in tubes[1:]:
        child.SetParentPoint(1)
        tubes[0].AddChild(child)
    placed = tubes[0].GetObjectToParentTransform()  # last: children that are added later stay where they are
    placed.SetMatrix(itk.matrix_from_array(turn))
    placed.SetOffset(offset.tolist())
    tubes[0].SetObjectToParentTransform(placed)
    group.Update()
    return group


def main():
    if sys.argv[1] == "version":
        print(itk.Version.GetITKVersion())
        return
    writer = itk.SpatialObjectWriter[3].New()
    writer.SetInput(scene(**json.load(sys.stdin)))
    writer.SetFileName(sys.argv[1])
    writer.SetBinaryPoints(sys.argv[2] == "binary")
    writer.Update()


main()
