"""Opens a ParaView collection the way ParaView does, with VTK's own readers, and prints all that is in it.

Usage: read_series.py FILE.pvd. Floating-point numbers have 17 digits, so equal lines mean equal numbers.
"""
import os
import sys
import xml.etree.ElementTree as ElementTree

from vtkmodules.vtkIOXML import (vtkXMLImageDataReader, vtkXMLPImageDataReader, vtkXMLPolyDataReader,
                                 vtkXMLPPolyDataReader)


def numbers(values):
    return " ".join("%.17g" % v if isinstance(v, float) else str(v) for v in values)


def show_array(where, array):
    tuples = [array.GetTuple(i) for i in range(array.GetNumberOfTuples())]
    whole = array.GetDataTypeAsString() not in ("double", "float")
    flat = [int(v) if whole else v for t in tuples for v in t]
    print(where, array.GetName(), array.GetDataTypeAsString(), array.GetNumberOfComponents(), numbers(flat))


def show(name):
    kinds = {".vti": vtkXMLImageDataReader, ".pvti": vtkXMLPImageDataReader, ".vtp": vtkXMLPolyDataReader,
             ".pvtp": vtkXMLPPolyDataReader}
    reader = kinds[os.path.splitext(name)[1]]()
    reader.SetFileName(name)
    reader.Update()
    if reader.GetErrorCode() != 0:
        sys.exit("%s: error %d" % (name, reader.GetErrorCode()))
    show_data(reader.GetOutput())


def show_data(data):
    print(data.GetClassName())
    if data.GetClassName() == "vtkImageData":
        print("extent", numbers(data.GetExtent()))
        print("origin", numbers(data.GetOrigin()))
        print("spacing", numbers(data.GetSpacing()))
    else:
        points = data.GetPoints()
        if points and points.GetNumberOfPoints():
            print("points", points.GetData().GetDataTypeAsString(),
                  numbers(c for i in range(points.GetNumberOfPoints()) for c in points.GetPoint(i)))
        print("vertices", numbers(data.GetCell(c).GetPointId(0) for c in range(data.GetNumberOfVerts())))
        print("single", all(data.GetCell(c).GetNumberOfPoints() == 1 for c in range(data.GetNumberOfVerts())))
        for i in range(data.GetNumberOfLines()):
            cell = data.GetCell(data.GetNumberOfVerts() + i)
            print("line", numbers(cell.GetPointId(p) for p in range(cell.GetNumberOfPoints())))
        for i in range(data.GetCellData().GetNumberOfArrays()):
            show_array("cells", data.GetCellData().GetArray(i))
    attributes = data.GetPointData()
    print("scalars", attributes.GetScalars().GetName() if attributes.GetScalars() else None)
    for i in range(attributes.GetNumberOfArrays()):
        show_array("array", attributes.GetArray(i))
    for i in range(data.GetFieldData().GetNumberOfArrays()):
        show_array("field", data.GetFieldData().GetArray(i))


def entries(collection):
    """Time and file of each data set."""
    root = ElementTree.parse(collection).getroot()
    assert root.tag == "VTKFile" and root.get("type") == "Collection", root.attrib
    for entry in root.find("Collection"):
        assert entry.tag == "DataSet" and not os.path.isabs(entry.get("file")), entry.attrib
        yield float(entry.get("timestep")), entry.get("file")


if __name__ == "__main__":
    for time, file in entries(sys.argv[1]):
        print("timestep", "%.17g" % time, file)
        show(os.path.join(os.path.dirname(sys.argv[1]), file))
