"""Prints all that is in a NetCDF file of tracks, read by SciPy.

Usage: read_trajectories.py FILE.nc
"""
import sys

from scipy.io import netcdf_file


def text(value):
    return value.decode()


def numbers(values):
    return " ".join(repr(v) for v in values.tolist())


with netcdf_file(sys.argv[1], mmap=False) as file:
    print(text(file.Conventions), text(file.featureType), repr(text(file.title)))
    v = file.variables
    print("trajectory", text(v["trajectory"].cf_role), numbers(v["trajectory"].data))
    end = v["end"]
    print("end", text(end.flag_meanings), numbers(end.flag_values) + ":", numbers(end.data))
    index = v["trajectory_index"]
    print("trajectory_index of", text(index.instance_dimension), numbers(index.data))
    print("time in", text(v["time"].units) + ":", numbers(v["time"].data))
    for name in list(v)[list(v).index("time") + 1:]:
        where = "at " + text(v[name].coordinates) + " " if hasattr(v[name], "coordinates") else ""
        print(name, where + numbers(v[name].data))
