# SPDX-License-Identifier: BSD-3-Clause
# Run by pvbatch: opens the .pvd files of a run as a user would and checks that ParaView really shows something.
import sys

from paraview.simple import OpenDataFile, UpdatePipeline

folder, frames = sys.argv[1], int(sys.argv[2])
expected = {"mechanics": ["displacement", "velocity", "stress", "von_mises", "eqps", "temperature", "rank"],
            "conduction": ["temperature", "rank"]}


def arrays(data):
    names = []
    for kind in (data.PointData, data.CellData):
        names += [kind.GetArray(i).Name for i in range(kind.GetNumberOfArrays())]
    return names


def opened(name):
    reader = OpenDataFile(folder + "/" + name)
    assert reader is not None, name + " has no reader"
    times = list(reader.TimestepValues)
    assert len(times) >= frames and times == sorted(times), (name, times)
    UpdatePipeline(time=times[-1], proxy=reader)
    return reader


cells = 0
for component, fields in expected.items():
    reader = opened(component + ".pvd")
    count = reader.GetDataInformation().GetNumberOfCells()
    assert count > 0, component + ": no cells"
    cells += count
    for field in fields:
        assert field in arrays(reader), (component, field, arrays(reader))
    low, high = reader.PointData["temperature"].GetRange() if component == "conduction" else reader.PointData["displacement"].GetRange(2)
    assert high > low, (component, low, high)
assert opened("all.pvd").GetDataInformation().GetNumberOfCells() == cells
print("1 passed, 0 failed")
