"""Opens results of halfshade in ParaView with the right arrays, scale and curves.

As a macro (Macros > Import new macro): shows the selected source, and as curves every other source
that has an array `kind`. As a script, also without a display:

    pvbatch halfshade_view.py room.vtu [--curves curves.vtp] [--quantity radiosity] [--log] -o room.png

Results are .vtu, .vtp or .ply of `halfshade solve`, or the .pvd of its --progressive; curves are the
.vtp of `halfshade mesh --curves`.
"""

import argparse
import sys

from paraview import simple

CHANNELS = "RGB"
# Kinds of curves by what breaks along them, as in the pictures of halfshade.
CURVES = (
    ("D0", (0.85, 0.1, 0.1)),
    ("D1", (0.15, 0.4, 1.0)),
    ("D2 at a vertex", (1.0, 0.4, 0.8)),
    ("D2 at three edges", (1.0, 0.85, 0.1)),
)
CAMERA_NUMBERS = 10  # position, direction, up, vertical field of view in degrees
SUBDIVISION = 3  # of curved elements, so that polynomials look like what they are


def arrays_of(data):
    return [data.GetArray(k).Name for k in range(data.GetNumberOfArrays())]


def has_curves(source):
    return "kind" in arrays_of(source.CellData) and "jump" in arrays_of(source.CellData)


def mean_of_channels(source, quantity):
    """Adds the mean of R, G and B, which is what halfshade's estimates and legends are of."""
    on_points = quantity in arrays_of(source.PointData)
    if not on_points and quantity not in arrays_of(source.CellData):
        raise SystemExit(f"there is no array '{quantity}' in this file")
    data = source.PointData if on_points else source.CellData
    if data.GetArray(quantity).GetNumberOfComponents() != 3:
        return source, quantity, on_points
    mean = simple.Calculator(Input=source)
    mean.AttributeType = "Point Data" if on_points else "Cell Data"
    mean.ResultArrayName = f"{quantity} (mean)"
    mean.Function = "(" + "+".join(f'"{quantity}_{c}"' for c in CHANNELS) + ")/3"
    return mean, mean.ResultArrayName, on_points


def show_light(source, view, quantity, logarithmic):
    shown, name, on_points = mean_of_channels(source, quantity)
    display = simple.Show(shown, view)
    display.Representation = "Surface"
    if hasattr(display, "NonlinearSubdivisionLevel"):
        display.NonlinearSubdivisionLevel = SUBDIVISION
    display.Ambient, display.Diffuse, display.Specular = 1, 0, 0  # the light is in the colours
    simple.ColorBy(display, ("POINTS" if on_points else "CELLS", name))
    table = simple.GetColorTransferFunction(name)
    table.ApplyPreset("Viridis (matplotlib)", True)
    low, high = (shown.PointData if on_points else shown.CellData).GetArray(name).GetRange()
    if logarithmic and high > 0:
        table.RescaleTransferFunction(max(low, high / 1e4), high)
        table.MapControlPointsToLogSpace()
        table.UseLogScale = 1
    else:
        low = low if low < -0.05 * high else 0  # polynomials undershoot a little
        table.RescaleTransferFunction(low, high if high > 0 else 1)
    display.SetScalarBarVisibility(view, True)
    bar = simple.GetScalarBar(table, view)
    bar.ScalarBarLength = 0.6  # room for the labels of a logarithmic one
    bar.Title, bar.ComponentTitle = f"{quantity.replace('_', ' ')}, W/m²", ""
    return display


def show_curves(source, view):
    kinds = simple.Calculator(Input=source)
    kinds.AttributeType = "Cell Data"
    kinds.ResultArrayName = "curve"
    # Curves of order 2 are at a vertex (kinds 1 and 2) or at three edges (3).
    kinds.Function = "if(order<0.5,0,if(order<1.5,1,if(kind<2.5,2,3)))"
    display = simple.Show(kinds, view)
    simple.ColorBy(display, ("CELLS", "curve"))
    display.LineWidth = 2
    display.Ambient, display.Diffuse = 1, 0
    table = simple.GetColorTransferFunction("curve")
    table.InterpretValuesAsCategories = 1
    table.Annotations = [word for k, (name, _) in enumerate(CURVES) for word in (str(k), name)]
    table.IndexedColors = [c for _, colour in CURVES for c in colour]
    display.SetScalarBarVisibility(view, True)
    simple.GetScalarBar(table, view).Title = "curves"
    return display


def look_through_camera(source, view):
    """The first camera of the scene; all of it if there is none."""
    simple.ResetCamera(view)
    numbers = source.FieldData.GetArray("cameras") if "cameras" in arrays_of(source.FieldData) else None
    if numbers is None or numbers.GetNumberOfTuples() == 0:
        return
    values = [numbers.GetRange(k)[0] for k in range(CAMERA_NUMBERS)]
    if numbers.GetNumberOfTuples() > 1:  # ranges are over all cameras; the data itself has the first
        from paraview import servermanager

        first = servermanager.Fetch(source).GetFieldData().GetArray("cameras").GetTuple(0)
        values = list(first)
    position, direction, up = values[0:3], values[3:6], values[6:9]
    view.CameraPosition = position
    view.CameraFocalPoint = [p + d for p, d in zip(position, direction)]
    view.CameraViewUp = up
    view.CameraViewAngle = values[9]


def go_to_last_stage(source):
    """Of a series: at first there is no light, at the end the scale is that of all stages."""
    if len(getattr(source, "TimestepValues", [])) > 1:
        scene = simple.GetAnimationScene()
        scene.UpdateAnimationUsingDataTimeSteps()
        scene.GoToLast()


def show(source, curves=None, quantity="irradiance", logarithmic=False):
    """Shows a result, and curves over it, in the active view; returns the view."""
    view = simple.GetActiveViewOrCreate("RenderView")
    go_to_last_stage(source)
    source.UpdatePipeline()
    show_light(source, view, quantity, logarithmic)
    if curves is not None:
        curves.UpdatePipeline()
        show_curves(curves, view)
    look_through_camera(source, view)
    simple.Render(view)
    return view


def from_command_line(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("result")
    parser.add_argument("--curves")
    parser.add_argument("--quantity", default="irradiance")
    parser.add_argument("--log", action="store_true")
    parser.add_argument("--size", type=int, nargs=2, default=(1000, 750))
    parser.add_argument("-o", "--output", help="a picture (.png) or a state (.pvsm)")
    options = parser.parse_args(arguments)
    source = simple.OpenDataFile(options.result)
    if source is None:
        raise SystemExit(f"{options.result}: ParaView cannot open this")
    curves = simple.OpenDataFile(options.curves) if options.curves else None
    view = show(source, curves, options.quantity, options.log)
    view.ViewSize = options.size
    view.OrientationAxesVisibility = 0
    if not options.output:
        return
    if options.output.endswith(".pvsm"):
        simple.SaveState(options.output)
    else:
        simple.SaveScreenshot(options.output, view, ImageResolution=options.size)


def from_macro():
    source = simple.GetActiveSource()
    if source is None:
        raise SystemExit("select a result of halfshade in the pipeline first")
    others = [s for s in simple.GetSources().values() if s != source and has_curves(s)]
    simple.HideAll()
    show(source, others[0] if others else None)


if len(sys.argv) > 1:
    from_command_line(sys.argv[1:])
elif __name__ == "__main__" or simple.GetActiveSource() is not None:
    from_macro()
