"""Prints a .vti or .vtp of gaussdrift as VTK's own writer would write it: read, taken apart, built anew, written.

Usage: written_by_vtk.py FILE
"""
import sys

from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkPoints, vtkTypeInt64Array
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData
from vtkmodules.vtkIOXML import (vtkXMLImageDataReader, vtkXMLImageDataWriter, vtkXMLPolyDataReader,
                                 vtkXMLPolyDataWriter)


def anew(array):
    """Without what VTK remembers of the file."""
    copy = vtkDoubleArray() if array.GetDataTypeAsString() == "double" else vtkTypeInt64Array()
    copy.SetName(array.GetName())
    copy.SetNumberOfComponents(array.GetNumberOfComponents())
    copy.SetNumberOfTuples(array.GetNumberOfTuples())
    for i in range(array.GetNumberOfValues()):
        copy.SetValue(i, array.GetValue(i))
    return copy


def image(read):
    data = vtkImageData()
    data.SetExtent(read.GetExtent())
    data.SetOrigin(read.GetOrigin())
    data.SetSpacing(read.GetSpacing())
    return data


def cloud(read):
    count = read.GetNumberOfPoints()
    positions, offsets, connectivity = vtkDoubleArray(), vtkTypeInt64Array(), vtkTypeInt64Array()
    positions.SetNumberOfComponents(3)
    for j in range(count):
        positions.InsertNextTuple(read.GetPoint(j))
        offsets.InsertNextValue(j)
        connectivity.InsertNextValue(j)
    offsets.InsertNextValue(count)
    points, vertices, data = vtkPoints(), vtkCellArray(), vtkPolyData()
    points.SetData(positions)
    vertices.SetData(offsets, connectivity)
    data.SetPoints(points)
    data.SetVerts(vertices)
    return data


def main(name):
    of_image = name.endswith(".vti")
    reader = vtkXMLImageDataReader() if of_image else vtkXMLPolyDataReader()
    reader.SetFileName(name)
    reader.Update()
    read = reader.GetOutput()
    data = image(read) if of_image else cloud(read)
    for i in range(read.GetPointData().GetNumberOfArrays()):
        array = anew(read.GetPointData().GetArray(i))
        add = {"rho": data.GetPointData().SetScalars, "alpha": data.GetPointData().SetScalars,
               "u": data.GetPointData().SetVectors}.get(array.GetName(), data.GetPointData().AddArray)
        add(array)
    data.GetFieldData().AddArray(anew(read.GetFieldData().GetArray(0)))
    writer = vtkXMLImageDataWriter() if of_image else vtkXMLPolyDataWriter()
    writer.WriteToOutputStringOn()
    writer.SetInputData(data)
    writer.SetDataModeToBinary()
    writer.SetCompressorTypeToNone()
    writer.SetHeaderTypeToUInt64()
    writer.Write()
    sys.stdout.write(writer.GetOutputString())


if __name__ == "__main__":
    main(sys.argv[1])
