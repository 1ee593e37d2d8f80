"""Loads files as others would: VTK's readers and meshio find meshes, arrays and units in them.
Usage: ecosystem.py FILE..."""
import sys

import meshio
import vtk

READERS = {
    "vtu": vtk.vtkXMLUnstructuredGridReader,
    "vtp": vtk.vtkXMLPolyDataReader,
    "ply": vtk.vtkPLYReader,
    "png": vtk.vtkPNGReader,
}


def check_vtk(name):
    reader = READERS[name.rsplit(".", 1)[1]]()
    reader.SetFileName(name)
    reader.Update()
    data = reader.GetOutput()
    assert reader.GetErrorCode() == 0, name
    assert data.GetNumberOfPoints() > 0 and data.GetNumberOfCells() > 0, name
    field = data.GetFieldData()
    for k in range(field.GetNumberOfArrays()):
        assert field.GetArray(k) is not None, (name, "an array that is not of numbers")


def check_meshio(name):
    mesh = meshio.read(name)
    assert len(mesh.points) > 0, name
    # Curved ones are "triangle6" or "VTK_LAGRANGE_TRIANGLE".
    triangles = sum(len(block.data) for block in mesh.cells if "triangle" in block.type.lower())
    assert triangles > 0, name
    for array, blocks in mesh.cell_data.items():
        assert sum(len(block) for block in blocks) == triangles, (name, array)
    if name.endswith(".vtu"):
        assert "exitance" in mesh.cell_data, name
        assert mesh.cell_data["exitance"][0].shape[1] == 3, name


for file in sys.argv[1:]:
    check_vtk(file)
    # meshio knows no .vtp.
    if file.endswith((".vtu", ".ply")):
        check_meshio(file)
print("read", len(sys.argv) - 1)
