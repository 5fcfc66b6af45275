# Opens this run in ParaView 5.11 or newer:   paraview --script=view.py   (in this folder), or   pvpython view.py
# VIEW_PNG=picture.png pvbatch view.py   writes a picture of the last output.
import json
import math
import os

from paraview.simple import *

try:
    here = os.path.dirname(os.path.abspath(__file__))
except NameError:  # some versions of ParaView do not say where a script lies
    here = os.getcwd()

INK = [0.13, 0.13, 0.13]
AXES = ["x", "y", "z"]
views = []


def told_by_run():
    """What the run has said of itself; nothing while it goes on."""
    try:
        with open(os.path.join(here, "summary.json"), encoding="utf-8") as file:
            told = json.load(file)
        return told if isinstance(told, dict) else {}
    except (OSError, ValueError):
        return {}


TOLD = told_by_run()


def words(name, otherwise):
    """A text of the run, as it stands: no formulas are set in it."""
    text = TOLD.get(name)
    return text.replace("$", r"\$")[:80] if isinstance(text, str) and text else otherwise


def open_series(name):
    series = PVDReader(registrationName=name, FileName=os.path.join(here, name + ".pvd"))
    GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
    GetAnimationScene().GoToLast()
    series.UpdatePipeline(GetAnimationScene().AnimationTime)
    return series


def next_view():
    """The first view, then others beside it."""
    view = GetActiveViewOrCreate("RenderView") if not views else CreateView("RenderView")
    if views:
        AssignViewToLayout(view=view, layout=GetLayout(views[0]), hint=0)
    views.append(view)
    SetActiveView(view)
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility = 0
    grid = view.AxesGrid
    grid.Visibility = 1
    for name in AXES:
        setattr(grid, name.upper() + "Title", name)
        setattr(grid, name.upper() + "TitleColor", INK)
        setattr(grid, name.upper() + "LabelColor", INK)
        setattr(grid, name.upper() + "TitleFontSize", 18)
        setattr(grid, name.upper() + "LabelFontSize", 14)
    grid.GridColor = [0.6, 0.6, 0.6]
    if DIMENSION == 2:  # one face, two of its edges
        grid.FacesToRender = 4
        grid.AxesToLabel = 3
    return view


def range_of(array, source, component=0):
    low, high = source.PointData[array].GetRange(component)
    return (low, high) if low <= high else (0.0, 1.0)


def range_over_time(source):
    """Of the density, over all outputs if the run has told it."""
    frames = [frame for frame in TOLD.get("frames", []) if isinstance(frame, dict)]
    numbers = [frame.get(name) for frame in frames for name in ["minimum", "maximum"]]
    numbers = [number for number in numbers if isinstance(number, (int, float)) and math.isfinite(number)]
    return (min(numbers), max(numbers)) if numbers else range_of("rho", source)


def colour_by(shown, array, low, high, title, view):
    """With white at 0 where values fall well below it. Returns the map."""
    ColorBy(shown, ("POINTS", array))
    colours = GetColorTransferFunction(array)
    signed = low < -0.05 * high
    if signed:
        low, high = -max(-low, high), max(-low, high)
    elif low < 0.3 * high:
        low = 0.0
    colours.ApplyPreset("Cool to Warm" if signed else "Viridis (matplotlib)", True)
    if high > low:
        colours.RescaleTransferFunction(low, high)
        GetOpacityTransferFunction(array).RescaleTransferFunction(low, high)
    shown.SetScalarBarVisibility(view, True)
    bar = GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = INK
    bar.TitleFontSize, bar.LabelFontSize = 15, 14
    bar.HorizontalTitle = 1
    bar.AutoOrient, bar.Orientation = 0, "Vertical"
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = "Any Location", [0.87, 0.3], 0.4
    bar.ScalarBarThickness = 14
    bar.AutomaticLabelFormat = 0
    bar.LabelFormat = bar.RangeLabelFormat = "%-#.3g"
    return low, high


def tell_time(source, view):
    time = AnnotateTimeFilter(registrationName="time of " + str(len(views)), Input=source, Format="t = {time:g}")
    text = Show(time, view)
    text.Color = INK
    text.FontSize = 18
    text.WindowLocation = "Upper Left Corner"


def show_arrows(source, array, view, most):
    """The longest a sixteenth of the domain."""
    fastest = source.PointData[array].GetRange(-1)[1]
    if not fastest > 0 or not math.isfinite(fastest):
        return
    arrows = Glyph(registrationName="velocity of " + str(len(views)), Input=source,
                   GlyphType="2D Glyph" if DIMENSION == 2 else "Arrow")
    if DIMENSION == 2:
        arrows.GlyphType.GlyphType = "Arrow"
        arrows.GlyphType.Filled = 0
    arrows.OrientationArray = ["POINTS", array]
    arrows.ScaleArray = ["POINTS", array]
    arrows.ScaleFactor = SIDE / 16 / fastest
    arrows.GlyphMode = "Uniform Spatial Distribution (Bounds Based)"
    arrows.MaximumNumberOfSamplePoints = most
    shown = Show(arrows, view)
    ColorBy(shown, None)
    shown.AmbientColor = shown.DiffuseColor = INK
    shown.LineWidth = 1.5
    if DIMENSION == 2:  # above what is in the plane
        shown.Position = [0.0, 0.0, SIDE / 100]


def show_density(density, view):
    shown = Show(density, view)
    shown.SetRepresentationType("Surface" if DIMENSION == 2 else "Volume")
    if DIMENSION == 2:
        shown.Ambient, shown.Diffuse = 1.0, 0.0  # colours as in the bar
    else:
        shown.ScalarOpacityUnitDistance = SIDE / 40
    low, high = colour_by(shown, "rho", *range_over_time(density), words("label", "density"), view)
    if DIMENSION == 3 and high > low:  # nothing is clear, much is dense; of signed densities both ends are
        middle = (low + high) / 2
        ends = [low, 0.6, 0.5, 0.0, middle, 0.0, 0.5, 0.0] if low < 0 else [low, 0.0, 0.5, 0.0]
        GetOpacityTransferFunction("rho").Points = ends + [high, 0.6, 0.5, 0.0]
    for array in ["velocity", "u"]:
        if array in density.PointData.keys():
            show_arrows(density, array, view, 400)
            break
    tell_time(density, view)


def show_particles(particles, view):
    """Each as the Gaussian that it stands for: exp(-r^2 / core_radius^2). In space those that weigh a tenth of the
    heaviest at least: the light ones around would hide them."""
    low, high = range_of("alpha", particles)
    source = particles
    if DIMENSION == 3 and low >= 0:
        source = Threshold(registrationName="heavy particles", Input=particles, Scalars=["POINTS", "alpha"],
                           LowerThreshold=0.1 * high, UpperThreshold=high, ThresholdMethod="Between")
        Hide(particles, view)
    shown = Show(source, view)
    shown.SetRepresentationType("Point Gaussian")
    shown.ShaderPreset = "Gaussian Blur"
    if "core_radius" in particles.PointData.keys():
        shown.ScaleByArray = 1
        shown.SetScaleArray = ["POINTS", "core_radius"]
        shown.UseScaleFunction = 0
        shown.GaussianRadius = math.sqrt(0.5)  # ParaView's are exp(-r^2 / (2 radius^2))
    colour_by(shown, "alpha", low, high, "weight", view)
    heaviest = max(abs(low), abs(high))
    if DIMENSION == 3:
        shown.Opacity = 0.5
    elif heaviest > 0:  # light ones are clear
        shown.OpacityByArray = 1
        shown.OpacityArray = ["POINTS", "alpha"]
        both = [-heaviest, 0.6, 0.5, 0.0] if low < 0 else []
        shown.OpacityTransferFunction.Points = both + [0.0, 0.0, 0.5, 0.0, heaviest, 0.6, 0.5, 0.0]
    if "u" in particles.PointData.keys():
        show_arrows(particles, "u", view, 150)
    tell_time(particles, view)


def look():
    """All views show the same part of space, with some room beside it for the colours, and turn together."""
    first = views[0]
    if DIMENSION == 2:
        first.InteractionMode = "2D"
        ResetCamera(first)
        first.CameraParallelScale *= 1.05
    else:
        ResetCamera(first)
        focus = list(first.CameraFocalPoint)
        distance = 1.3 * math.dist(first.CameraPosition, focus)
        first.CameraPosition = [focus[0] + 0.45 * distance, focus[1] - 0.8 * distance, focus[2] + 0.4 * distance]
        first.CameraViewUp = [0.0, 0.0, 1.0]
    for view in views[1:]:
        for name in ["InteractionMode", "CameraPosition", "CameraFocalPoint", "CameraViewUp", "CameraParallelScale"]:
            setattr(view, name, getattr(first, name))
        AddCameraLink(first, view, "camera of view %d" % views.index(view))


