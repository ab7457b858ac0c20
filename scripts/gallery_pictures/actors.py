"""Grains, solids and lines of frames, with the bars that tell their colours."""

import math

from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPlane
from vtkmodules.vtkFiltersCore import vtkArrayCalculator, vtkCellDataToPointData, vtkTubeFilter
from vtkmodules.vtkFiltersExtraction import vtkExtractGeometry
from vtkmodules.vtkFiltersGeneral import vtkTableBasedClipDataSet, vtkWarpVector
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkActor, vtkGlyph3DMapper, vtkPolyDataMapper, vtkColorTransferFunction

# Anchors of colour, dark to light, that readers with any colour vision tell apart.
COLD = ((0.20, 0.13, 0.42), (0.17, 0.37, 0.60), (0.13, 0.60, 0.59), (0.45, 0.79, 0.40), (0.98, 0.90, 0.25))
WARM = ((0.93, 0.91, 0.88), (0.98, 0.76, 0.50), (0.93, 0.47, 0.28), (0.73, 0.19, 0.30), (0.35, 0.06, 0.30))
GREY = ((0.93, 0.93, 0.93), (0.20, 0.20, 0.22))

# (title of the bar, colours, factor)
FIELDS = {
    "speed": ("speed, m/s", COLD, 1.0),
    "weight": ("weight of the grains", COLD, 1.0),
    "solid_weight": ("weight of the solid", WARM, 1.0),
    "von_mises": ("von Mises stress, kPa", WARM, 1e-3),
    "plastic_strain": ("plastic strain", WARM, 1.0),
    "displacement": ("displacement, mm", WARM, 1e3),
    "normal_force": ("normal force, N", COLD, 1.0),
}


def read(path):
    reader = (vtkXMLPolyDataReader if path.suffix == ".vtp" else vtkXMLUnstructuredGridReader)()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def with_value(data, field, of_cells=False):
    """The frame with the array "value": what is shown, in the units of the bar."""
    factor = FIELDS[field][2]
    calculator = vtkArrayCalculator()
    calculator.SetInputData(data)
    calculator.SetAttributeType(vtkDataObject.CELL if of_cells else vtkDataObject.POINT)
    if field in ("speed", "displacement"):
        source = "velocity" if field == "speed" else field
        calculator.AddVectorArrayName(source)
        calculator.SetFunction(f"{factor} * mag({source})")
    else:
        calculator.AddScalarArrayName(field)
        calculator.SetFunction(f"{factor} * {field}")
    calculator.SetResultArrayName("value")
    calculator.Update()
    return calculator.GetOutput()


def colours(field, low, high):
    anchors = FIELDS[field][1]
    smooth = vtkColorTransferFunction()
    for k, colour in enumerate(anchors):
        smooth.AddRGBPoint(k / (len(anchors) - 1), *colour)
    table = vtkLookupTable()
    table.SetNumberOfTableValues(64)
    for k in range(64):
        table.SetTableValue(k, *smooth.GetColor(k / 63), 1.0)
    table.SetRange(low, high)
    return table


def bar(field, table):
    made = vtkScalarBarActor()
    made.SetLookupTable(table)
    made.SetTitle(FIELDS[field][0])
    made.SetNumberOfLabels(3)
    made.SetLabelFormat("%.4g")
    made.SetOrientationToHorizontal()
    made.UnconstrainedFontSizeOn()
    made.SetTextPositionToPrecedeScalarBar()
    made.SetVerticalTitleSeparation(0)
    made.SetTextPad(5)
    made.SetBarRatio(0.3)
    for text in (made.GetTitleTextProperty(), made.GetLabelTextProperty()):
        text.SetColor(0.15, 0.15, 0.15)
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
    return made


def place_bar(made, number, count, rows):
    """@param rows  of pixels of the picture"""
    made.GetTitleTextProperty().SetFontSize(rows * 17 // 600)
    made.GetLabelTextProperty().SetFontSize(rows * 15 // 600)
    width = min(0.3, 0.66 / count)
    made.SetWidth(width)
    made.SetHeight(0.15)
    made.SetPosition((number + 1) / (count + 1) - 0.5 * width, 0.015)


def rounded(value):
    """Away from zero to two digits."""
    if value == 0.0:
        return 0.0
    unit = 10.0 ** (math.floor(math.log10(abs(value))) - 1)
    return math.copysign(math.ceil(abs(value) / unit) * unit, value)


def coloured(mapper, field, picture, limits):
    """Tells a mapper its colours; @return the bar."""
    low, high = picture.range.get(field, (rounded(min(0.0, limits[0])), rounded(limits[1])))
    table = colours(field, low, high if high > low else low + 1.0)
    mapper.SetScalarVisibility(1)
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    mapper.SelectColorArray("value")
    return bar(field, table)


def behind(cut, k):
    """The half space that is drawn; k: which of the places of the cut."""
    origin, normal = [0.0] * 3, [0.0] * 3
    axis = "xyz".index(cut[0])
    origin[axis], normal[axis] = cut[k], 1.0
    plane = vtkPlane()
    plane.SetOrigin(origin)
    plane.SetNormal(normal)
    return plane


def clipped(data, cut):
    if not cut:
        return data
    clip = vtkTableBasedClipDataSet()
    clip.SetInputData(data)
    clip.SetClipFunction(behind(cut, 2))
    clip.Update()
    return clip.GetOutput()


def kept(data, cut):
    """Without the points (grains) before the cut."""
    if not cut:
        return data
    choice = vtkExtractGeometry()
    choice.SetInputData(data)
    choice.SetImplicitFunction(behind(cut, 1))
    choice.ExtractInsideOff()
    choice.Update()
    return choice.GetOutput()


def grains(path, picture):
    """@return (actor, bar): spheres at the radii of the grains"""
    data = kept(with_value(read(path), picture.grains), picture.cut)
    ball = vtkSphereSource()
    ball.SetRadius(1.0)
    ball.SetThetaResolution(24)
    ball.SetPhiResolution(16)
    mapper = vtkGlyph3DMapper()
    mapper.SetInputData(data)
    mapper.SetSourceConnection(ball.GetOutputPort())
    mapper.SetScaleArray("radius")
    mapper.SetScaleModeToScaleByMagnitude()
    mapper.OrientOff()
    values = data.GetPointData().GetArray("value")
    limits = values.GetRange() if values else (0.0, 1.0)
    made_bar = coloured(mapper, picture.grains, picture, limits)
    mapper.SetScalarModeToUsePointFieldData()
    actor = vtkActor()
    actor.SetMapper(mapper)
    if picture.grain_opacity < 1.0:
        mapper.ScalarVisibilityOff()
        made_bar = None
        actor.GetProperty().SetColor(0.5, 0.5, 0.5)
        actor.GetProperty().SetOpacity(picture.grain_opacity)
    actor.GetProperty().SetSpecular(0.1)
    actor.GetProperty().SetSpecularPower(25)
    actor.GetProperty().SetAmbient(0.12)
    return actor, made_bar


def solid(path, name, picture):
    """@return (actor, bar): the surface where it is now, with the edges of its elements"""
    field = picture.solids.get(name, "von_mises")
    data = read(path)
    of_cells = data.GetCellData().HasArray(field) == 1
    warp = vtkWarpVector()
    warp.SetInputData(with_value(data, field, of_cells))
    warp.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, "displacement")
    warp.SetScaleFactor(picture.warp)
    warp.Update()
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(clipped(warp.GetOutput(), picture.cut))
    surface.Update()
    shown = surface.GetOutput()
    attributes = shown.GetCellData() if of_cells else shown.GetPointData()
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(shown)
    limits = attributes.GetArray("value").GetRange()
    made_bar = coloured(mapper, field, picture, limits)
    if of_cells:
        mapper.SetScalarModeToUseCellFieldData()
    else:
        mapper.SetScalarModeToUsePointFieldData()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetAmbient(0.25)
    actor.GetProperty().SetOpacity(picture.solid_opacity)
    actor.GetProperty().SetEdgeVisibility(not picture.cut)  # cuts go through elements
    actor.GetProperty().SetEdgeColor(0.45, 0.42, 0.42)
    return actor, made_bar


def lines(path, picture):
    """@return [(actor, bar)], empty for a frame without lines: tubes, thick where the force is large"""
    data = read(path)
    if data.GetNumberOfCells() == 0:
        return []
    thin, thick = picture.line_radius
    shown = with_value(data, "normal_force", True)
    limits = shown.GetCellData().GetArray("value").GetRange()
    largest = max(abs(limits[0]), abs(limits[1]), 1e-300)
    at_points = vtkCellDataToPointData()
    at_points.SetInputData(shown)
    sized = vtkArrayCalculator()
    sized.SetInputConnection(at_points.GetOutputPort())
    sized.SetAttributeType(vtkDataObject.POINT)
    sized.AddScalarArrayName("value")
    sized.SetFunction(f"{thin} + {thick - thin} * abs(value) / {largest}")
    sized.SetResultArrayName("thickness")
    tubes = vtkTubeFilter()
    tubes.SetInputConnection(sized.GetOutputPort())
    tubes.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, "thickness")
    tubes.SetVaryRadiusToVaryRadiusByAbsoluteScalar()
    tubes.SetNumberOfSides(8)
    tubes.Update()
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(tubes.GetOutputPort())
    made_bar = coloured(mapper, "normal_force", picture, limits)
    mapper.SetScalarModeToUsePointFieldData()
    actor = vtkActor()
    actor.SetMapper(mapper)
    return [(actor, made_bar)]
