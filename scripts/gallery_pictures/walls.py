"""Walls, translucent: from frames if they have any, else from what the scene says, if they do not move."""

import math

from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPlane, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkClipPolyData
from vtkmodules.vtkFiltersSources import vtkCylinderSource
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from actors import behind

AXES = "xyz"


def actor(surface, opacity):
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.ScalarVisibilityOff()
    made = vtkActor()
    made.SetMapper(mapper)
    made.GetProperty().SetColor(0.45, 0.5, 0.58)
    made.GetProperty().SetOpacity(opacity)
    return made


def from_frame(path, picture):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    surface = reader.GetOutput()
    planes = [behind(picture.cut, 1)] if picture.cut else []
    if math.isfinite(picture.wall_top):
        lid = vtkPlane()
        lid.SetOrigin(0, 0, picture.wall_top)
        lid.SetNormal(0, 0, -1)
        planes.append(lid)
    for plane in planes:
        clip = vtkClipPolyData()
        clip.SetInputData(surface)
        clip.SetClipFunction(plane)
        clip.Update()
        surface = clip.GetOutput()
    return surface


def from_scene(wall, bounds):
    """@param bounds  of everything else: walls without an end are drawn as far as these"""
    if any(isinstance(value, str) for value in wall.get("displacement", [])):
        return None
    makers = {"box": box, "plane": plane, "cylinder": cylinder}
    return makers[wall["shape"]](wall, bounds) if wall["shape"] in makers else None


def faces(quads):
    points, cells = vtkPoints(), vtkCellArray()
    for quad in quads:
        cells.InsertNextCell(4)
        for corner in quad:
            cells.InsertCellPoint(points.InsertNextPoint(corner))
    surface = vtkPolyData()
    surface.SetPoints(points)
    surface.SetPolys(cells)
    return surface


def side(axis, place, low, high):
    first, second = [k for k in range(3) if k != axis]
    corner = [0.0, 0.0, 0.0]
    corner[axis] = place
    quad = []
    for a, b in ((low, low), (high, low), (high, high), (low, high)):
        corner[first], corner[second] = a[first], b[second]
        quad.append(tuple(corner))
    return quad


def box(wall, bounds):
    """The sides that are not open, no higher than what lies in them."""
    low, high = wall["box"]
    low = [max(low[k], bounds[2 * k] - 1e-9) if k == 2 else low[k] for k in range(3)]
    high = [min(high[k], bounds[2 * k + 1]) if k == 2 else high[k] for k in range(3)]
    opened = wall.get("open", [])
    # The side that faces the camera is left out: the view is from −y.
    names = [name for name in ("x-", "x+", "y+", "z-") if name not in opened]
    return faces([side(AXES.index(name[0]), (low if name[1] == "-" else high)[AXES.index(name[0])], low, high)
                  for name in names])


def plane(wall, bounds):
    """Planes along the axes of space."""
    axis = max(range(3), key=lambda k: abs(wall["normal"][k]))
    low, high = list(bounds[0::2]), list(bounds[1::2])
    return faces([side(axis, wall["point"][axis], low, high)])


def cylinder(wall, bounds):
    """Cylinders along y, without an end."""
    source = vtkCylinderSource()
    source.SetRadius(wall["radius"])
    source.SetHeight(bounds[3] - bounds[2])
    source.SetCenter(wall["point"][0], 0.5 * (bounds[2] + bounds[3]), wall["point"][2])
    source.SetResolution(96)
    source.CappingOff()
    source.Update()
    return source.GetOutput()
