// Files of tracks: the table grows and goes on after a stop, and others hold what it holds.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "scratch_folder.hpp"
#include "sim/grid_fields.hpp"
#include "write/python_with_vtk.hpp"
#include "write/track_files.hpp"
#include "write/vtk_files.hpp"

namespace gaussdrift::write {
namespace {

constexpr double nan_number = std::numeric_limits<double>::quiet_NaN();

Case followed(std::vector<TrackFile> files) {
  Case spec;
  spec.title = "Two that part";
  spec.domain.min = {0, 0, 0}, spec.domain.max = {2, 1, 0};
  spec.domain.edges[0] = {Edge::open, Edge::open};
  TracksSpec tracks;
  tracks.every = 1;
  tracks.fields = {find_grid_field("velocity").about, find_grid_field("rho").about};
  tracks.files = std::move(files);
  spec.output.tracks = tracks;
  return spec;
}

/// Two looks: the second one tells that particle 7 has left between them, and has a new one.
std::vector<TrackSamples> looks() {
  TrackSamples first{2, {{"velocity", 2}, {"rho", 1}}, {"x_min", "x_max"}, {}, {}, {}, {}, {}};
  TrackSamples second = first;
  first.id = {-1, 7}, first.time = {0, 0}, first.place = {0.1, 0.2, 1.9, 1. / 3};
  first.values = {1, -0.5, 2.5, 1, 1e-300, nan_number}, first.end = {0, 0};
  second.id = {7, -1, 9}, second.time = {0.15, 0.25, 0.25}, second.place = {2.05, 1. / 3, 0.35, 0.075, 0.5, 0.5};
  second.values = {1, 0, nan_number, 1, -0.5, 2.25, 0, 0, 0}, second.end = {2, 0, 0};
  return {first, second};
}

const std::string table =
    "id,t,x,y,velocity_x,velocity_y,rho,end\n"
    "-1,0,0.1,0.2,1,-0.5,2.5,\n"
    "7,0,1.9,0.3333333333333333,1,1e-300,nan,\n"
    "7,0.15,2.05,0.3333333333333333,1,0,nan,x_max\n"
    "-1,0.25,0.35,0.075,1,-0.5,2.25,\n"
    "9,0.25,0.5,0.5,0,0,0,\n";

void show(Observer& writer, const TrackSamples& samples) {
  writer.tracks(samples);
  writer.frame(Frame{});
}

TEST(TrackTable, GrowsAndGoesOnWhereAStateWas) {
  const ScratchFolder folder;
  const Case spec = followed({});
  std::string state;
  {
    const auto writer = track_writer(folder.path(), spec);
    show(*writer, looks()[0]);
    EXPECT_EQ(read_file(folder / "tracks.csv"), table.substr(0, table.find("7,0.15")));
    state = writer->state();
    show(*writer, looks()[1]);  // rows that the state does not know
    EXPECT_EQ(read_file(folder / "tracks.csv"), table);
  }
  for (const bool waits : {false, true}) {
    auto writer = track_writer(folder.path(), spec);
    writer->restore({}, state);
    if (waits) {  // rows that have not come to the disk are in the state
      writer->tracks(looks()[1]);
      const std::string later = writer->state();
      EXPECT_EQ(read_file(folder / "tracks.csv").find("x_max"), std::string::npos);
      writer = track_writer(folder.path(), spec);
      writer->restore({}, later);
    } else {
      show(*writer, looks()[1]);
    }
    writer->finish();
    EXPECT_EQ(read_file(folder / "tracks.csv"), table);
  }
  std::ofstream(folder / "tracks.csv") << "id,t\n";  // somebody has cut it
  const auto writer = track_writer(folder.path(), spec);
  EXPECT_NE(message_of<FileError>([&] { writer->restore({}, state); }).find("tracks.csv"), std::string::npos);
}

TEST(TrackLines, AreReadByParaviewAsLines) {
  const std::string python = python_with_vtk();
  if (python.empty()) GTEST_SKIP() << "no Python with VTK (Debian: python3-vtk9)";
  const ScratchFolder folder;
  const auto writer = track_writer(folder.path(), followed({find_track_file("vtp").about}));
  for (const TrackSamples& samples : looks()) show(*writer, samples);
  writer->finish();
  Collection(folder / "tracks.pvd").add(0, folder / "tracks.vtp");
  const std::string text = read_series(python, folder / "tracks.pvd");
  for (const char* line :
       {"vertices 4\n", "line 0 3\nline 1 2\n", "cells id long long 1 9 -1 7\n", "cells end long long 1 0 0 2\n",
        "array t double 1 0 0 0.14999999999999999 0.25 0.25\n",
        "array velocity double 3 1 -0.5 0 1 1e-300 0 1 0 0 1 -0.5 0 0 0 0\n", "array rho double 1 2.5 nan nan 2.25 0\n",
        "points double 0.10000000000000001 0.20000000000000001 0 1.8999999999999999 0.33333333333333331 0 "})
    EXPECT_NE(text.find(line), std::string::npos) << line << "\nin\n" << text;
}

TEST(TrackNetcdf, IsReadByScipyAsTrajectories) {
  const std::string python = "/usr/bin/python3";
  if (std::system((python + " -c 'import scipy.io' 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << "no Python with SciPy (Debian: python3-scipy)";
  const ScratchFolder folder;
  const auto writer = track_writer(folder.path(), followed({find_track_file("netcdf").about}));
  for (const TrackSamples& samples : looks()) show(*writer, samples);
  writer->finish();
  const std::string text = output_of(python + " " SOURCE_DIR "/tests/write/read_trajectories.py '" +
                                     (folder / "tracks.nc").string() + "' 2>&1");
  EXPECT_EQ(text,
            "CF-1.8 trajectory 'Two that part'\n"
            "trajectory trajectory_id -1 7 9\n"
            "end it_goes_on_to_the_end x_min x_max 0 1 2: 0 2 0\n"
            "trajectory_index of trajectory 0 1 1 0 2\n"
            "time in 1: 0.0 0.0 0.15 0.25 0.25\n"
            "x 0.1 1.9 2.05 0.35 0.5\n"
            "y 0.2 0.3333333333333333 0.3333333333333333 0.075 0.5\n"
            "velocity_x at time x y 1.0 1.0 1.0 1.0 0.0\n"
            "velocity_y at time x y -0.5 1e-300 0.0 -0.5 0.0\n"
            "rho at time x y 2.5 nan nan 2.25 0.0\n");
}

}  // namespace
}  // namespace gaussdrift::write
