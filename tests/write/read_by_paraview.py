"""Opens a ParaView collection with ParaView's own reader, and prints the same lines as read_series.py does of it.

Usage: pvpython read_by_paraview.py FILE.pvd. tools/open_in_paraview compares the two.
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from paraview import servermanager, simple

import read_series

reader = simple.PVDReader(FileName=sys.argv[1])
listed = list(read_series.entries(sys.argv[1]))
known = list(reader.TimestepValues)
if [time for time, _ in listed] != known:
    sys.exit("ParaView knows the times %s, the file has %s" % (known, [time for time, _ in listed]))
for time, file in listed:
    print("timestep", "%.17g" % time, file)
    reader.UpdatePipeline(time)
    data = servermanager.Fetch(reader)
    while data.IsA("vtkMultiBlockDataSet"):
        assert data.GetNumberOfBlocks() == 1, "one block for one file"
        data = data.GetBlock(0)
    read_series.show_data(data)
