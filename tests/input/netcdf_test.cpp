// NetCDF: what the CF conventions say of axes, units, marks and times, and what is refused.
#include <cmath>
#include <string>
#include <vector>

#include "field/gridded/gridded.hpp"
#include "grid_files.hpp"
#include "message_of.hpp"
#include "read/netcdf/netcdf_file.hpp"

#ifdef HAS_NETCDF
#include "netcdf_files.hpp"
#endif

namespace gaussdrift::input {
namespace {

#ifndef HAS_NETCDF

class Netcdf : public GridFile {};

TEST_F(Netcdf, is_refused_by_a_program_that_was_built_without_it) {
  std::ofstream(folder_ / "wind.nc") << "CDF";
  EXPECT_EQ(read::netcdf_library(), "");
  EXPECT_NE(refusal("wind.nc", vector_of()).find("built without NetCDF\ninstall libnetcdf-dev"), std::string::npos);
}

#else

using read::Missing;

class Netcdf : public GridFile {
 protected:
  struct Wanted {
    int format = NC_NETCDF4;
    std::vector<double> times = {0, 1, 2};
    std::string time_units = "hours since 2000-01-01", calendar{};
    std::string units = "m s-1";
    std::vector<double> y = {10, 20, 30};
  };

  /// u = 100 t + 10 i_y + i_x, v = -u on 4 x 3 points: lon, lat, time.
  void write_wind(const std::string& name, const Wanted& wanted) const {
    NetcdfWriter file(folder_ / name, wanted.format);
    file.dimension("time", 0);
    file.dimension("lat", wanted.y.size());
    file.dimension("lon", 4);
    file.variable("time", NC_DOUBLE, {"time"});
    if (!wanted.time_units.empty()) file.text("time", "units", wanted.time_units);
    if (!wanted.calendar.empty()) file.text("time", "calendar", wanted.calendar);
    file.variable("lat", NC_FLOAT, {"lat"});
    file.variable("lon", NC_FLOAT, {"lon"});
    for (const char* array : {"u", "v"}) {
      file.variable(array, NC_FLOAT, {"time", "lat", "lon"});
      if (!wanted.units.empty()) file.text(array, "units", wanted.units);
    }
    file.values("lat", wanted.y);
    file.values("lon", {1, 2, 3, 4});
    std::vector<double> u, v;
    for (std::size_t t = 0; t < wanted.times.size(); ++t)
      for (std::size_t j = 0; j < wanted.y.size(); ++j)
        for (std::size_t i = 0; i < 4; ++i)
          u.push_back(100. * double(t) + 10. * double(j) + double(i)), v.push_back(-u.back());
    file.values("time", wanted.times, wanted.times.size());
    file.values("u", u, wanted.times.size());
    file.values("v", v, wanted.times.size());
  }
  void write_wind(const std::string& name) const { write_wind(name, Wanted()); }

  std::shared_ptr<const GridData> wind(const std::string& name, read::GridRequest request = vector_of()) const {
    return read::read_grid(folder_ / name, request);
  }
  std::vector<double> times_of(const std::string& name, const std::optional<read::SceneClock>& clock = {}) const {
    read::GridRequest request = vector_of();
    request.clock = clock;
    return wind(name, request)->times;
  }
};

using Numbers = std::vector<double>;

TEST_F(Netcdf, holds_a_velocity_in_classic_files_and_in_those_of_hdf5) {
  for (const int format : {NC_NETCDF4, NC_CLASSIC_MODEL | NC_NETCDF4, NC_CLOBBER, NC_64BIT_OFFSET, NC_64BIT_DATA}) {
    write_wind("wind.nc", {.format = format});
    const auto data = wind("wind.nc");
    EXPECT_EQ(data->name, "[u, v] of wind.nc");
    EXPECT_EQ(data->axis[0], (Numbers{1, 2, 3, 4}));
    EXPECT_EQ(data->axis[1], (Numbers{10, 20, 30}));
    EXPECT_EQ(data->times, (Numbers{0, 1, 2}));
    ASSERT_EQ(data->values.size(), 3u);
    EXPECT_EQ(data->values[2][2 * (4 * 1 + 3)], 213);
    EXPECT_EQ(data->values[2][2 * (4 * 1 + 3) + 1], -213);
  }
}

TEST_F(Netcdf, axes_that_descend_are_turned) {
  write_wind("wind.nc", {.y = {30, 20, 10}});
  const auto data = wind("wind.nc");
  EXPECT_EQ(data->axis[1], (Numbers{10, 20, 30}));
  EXPECT_EQ(data->values[0][0], 20);
  EXPECT_EQ(data->values[0][2 * 4 * 2], 0);
}

TEST_F(Netcdf, axes_are_known_by_attributes_in_any_order_of_dimensions) {
  for (const auto& [attribute, of_a, of_b] :
       std::vector<std::array<std::string, 3> >{{"axis", "X", "Y"},
                                                {"standard_name", "projection_x_coordinate", "projection_y_coordinate"},
                                                {"units", "degrees_east", "degrees_north"}}) {
    {
      NetcdfWriter file(folder_ / "permuted.nc");
      file.dimension("a", 2);
      file.dimension("b", 3);
      for (const char* name : {"a", "b"}) file.variable(name, NC_DOUBLE, {name});
      file.text("a", attribute, of_a);
      file.text("b", attribute, of_b);
      file.variable("east", NC_DOUBLE, {"a", "b"});
      file.variable("north", NC_DOUBLE, {"a", "b"});
      file.text("east", "standard_name", "eastward_wind");
      file.text("north", "standard_name", "northward_wind");
      file.values("a", {0, 1});
      file.values("b", {5, 6, 7});
      file.values("east", {0, 1, 2, 10, 11, 12});
      file.values("north", {0, -1, -2, -10, -11, -12});
    }
    const auto data = wind("permuted.nc");
    EXPECT_EQ(data->axis[0], (Numbers{0, 1}));
    EXPECT_EQ(data->axis[1], (Numbers{5, 6, 7}));
    EXPECT_EQ(data->values[0], (Numbers{0, 0, 10, -10, 1, -1, 11, -11, 2, -2, 12, -12}));
  }
}

TEST_F(Netcdf, packed_numbers_are_unpacked_and_marks_are_missing) {
  const read::GridRequest request{.most_components = 1, .missing = Missing::zero};
  {
    NetcdfWriter file(folder_ / "rho.nc");
    file.dimension("y", 2);
    file.dimension("x", 3);
    for (const char* name : {"y", "x"}) file.variable(name, NC_DOUBLE, {name});
    file.variable("rho", NC_SHORT, {"y", "x"});
    file.number("rho", "scale_factor", 0.25);
    file.number("rho", "add_offset", 10);
    file.number("rho", "_FillValue", -1, NC_SHORT);
    file.number("rho", "missing_value", -2, NC_SHORT);
    file.number("rho", "valid_max", 1000, NC_SHORT);
    file.values("y", {0, 1});
    file.values("x", {0, 1, 2});
    file.values("rho", {0, 4, -1, -2, 2000, 100});
  }
  EXPECT_EQ(wind("rho.nc", request)->values[0], (Numbers{10, 11, 0, 0, 0, 35}));
  EXPECT_EQ(wind("rho.nc", request)->filled, "3 of 6 values missing, taken as zero");
  EXPECT_NE(refusal("rho.nc", {}).find("rho of rho.nc has no value at (2, 0): the file hides this point (3 of 6"),
            std::string::npos);
  EXPECT_EQ(wind("rho.nc", {.missing = Missing::keep})->values[0], (Numbers{10, 11, 9.75, 9.5, 510, 35}));
}

TEST_F(Netcdf, what_was_never_written_is_missing) {
  {
    NetcdfWriter file(folder_ / "rho.nc");
    file.dimension("y", 2);
    file.dimension("x", 2);
    for (const char* name : {"y", "x"}) file.variable(name, NC_DOUBLE, {name});
    file.variable("rho", NC_FLOAT, {"y", "x"});
    file.values("y", {0, 1});
    file.values("x", {0, 1});
    file.values("rho", {1, 2}, 1);
  }
  EXPECT_NE(refusal("rho.nc", {}).find("no value at (0, 1): the file hides this point (2 of 4"), std::string::npos);
}

TEST_F(Netcdf, unsigned_bytes_are_read_as_they_are_meant) {
  {
    NetcdfWriter file(folder_ / "rho.nc", NC_CLOBBER);
    file.dimension("y", 2);
    file.dimension("x", 2);
    for (const char* name : {"y", "x"}) file.variable(name, NC_DOUBLE, {name});
    file.variable("rho", NC_BYTE, {"y", "x"});
    file.text("rho", "_Unsigned", "true");
    file.values("y", {0, 1});
    file.values("x", {0, 1});
    file.values("rho", {0, 127, -128, -1});
  }
  EXPECT_EQ(wind("rho.nc", {})->values[0], (Numbers{0, 127, 128, 255}));
}

TEST_F(Netcdf, a_layer_is_taken_where_there_is_one_and_asked_for_where_there_are_several) {
  const auto write = [&](const Numbers& depths) {
    NetcdfWriter file(folder_ / "sea.nc");
    file.dimension("depth", depths.size());
    file.dimension("y", 2);
    file.dimension("x", 2);
    for (const char* name : {"depth", "y", "x"}) file.variable(name, NC_DOUBLE, {name});
    file.variable("rho", NC_DOUBLE, {"depth", "y", "x"});
    file.values("depth", depths);
    file.values("y", {0, 1});
    file.values("x", {0, 1});
    Numbers rho;
    for (const double depth : depths)
      for (int i = 0; i < 4; ++i) rho.push_back(depth + i);
    file.values("rho", rho);
  };
  write({5});
  EXPECT_EQ(wind("sea.nc", {})->values[0], (Numbers{5, 6, 7, 8}));
  write({5, 50});
  EXPECT_NE(refusal("sea.nc", {})
                .find("2 layers along depth, and the domain has 2 dimensions\nlevel = 5 takes the first "
                      "one; depth is one of 5, 50"),
            std::string::npos);
  EXPECT_EQ(wind("sea.nc", {.level = 50})->values[0], (Numbers{50, 51, 52, 53}));
  EXPECT_NE(refusal("sea.nc", {.level = 20}).find("no layer 20 along depth"), std::string::npos);
}

TEST_F(Netcdf, depth_that_counts_downwards_becomes_height) {
  {
    NetcdfWriter file(folder_ / "sea.nc");
    file.dimension("depth", 2);
    file.dimension("y", 2);
    file.dimension("x", 2);
    for (const char* name : {"depth", "y", "x"}) file.variable(name, NC_DOUBLE, {name});
    file.text("depth", "positive", "down");
    for (const char* name : {"u", "v", "w"}) file.variable(name, NC_DOUBLE, {"depth", "y", "x"});
    file.text("w", "standard_name", "downward_sea_water_velocity");
    file.values("depth", {0, 10});
    file.values("y", {0, 1});
    file.values("x", {0, 1});
    for (const char* name : {"u", "v", "w"}) file.values(name, {1, 1, 1, 1, 2, 2, 2, 2});
  }
  const auto data = read::read_grid(
      folder_ / "sea.nc", {.arrays = {"u", "v", "w"}, .dimension = 3, .least_components = 3, .most_components = 3});
  EXPECT_EQ(data->axis[2], (Numbers{-10, 0}));
  EXPECT_EQ((Numbers{data->values[0][0], data->values[0][1], data->values[0][2]}), (Numbers{2, 2, -2}));
}

TEST_F(Netcdf, time_counts_from_the_first_one_or_as_the_scene_says) {
  write_wind("wind.nc", {.times = {12, 24, 36}, .time_units = "hours since 1999-12-31 12:00", .units = "m hour-1"});
  EXPECT_EQ(times_of("wind.nc"), (Numbers{0, 12, 24}));
  EXPECT_EQ(times_of("wind.nc", read::SceneClock{.start = "2000-01-01 12:00"}), (Numbers{-12, 0, 12}));
  EXPECT_EQ(times_of("wind.nc", read::SceneClock{.unit = "d"}), (Numbers{0, 0.5, 1}));
  EXPECT_EQ(times_of("wind.nc", read::SceneClock{.start_number = 0, .unit_number = 6}), (Numbers{2, 4, 6}));
  EXPECT_EQ(wind("wind.nc")->clock, "t = 0 at 2000-01-01 00:00, in hours");
  read::GridRequest request = vector_of();
  request.clock = read::SceneClock{.start = "2000-13-01"};
  EXPECT_NE(refusal("wind.nc", request).find("\"2000-13-01\" is no date"), std::string::npos);
}

TEST_F(Netcdf, days_in_decimals_are_whole_hours) {
  Numbers days;
  for (int hour = 0; hour < 30; ++hour) days.push_back(43830 + hour / 24.);
  write_wind("wind.nc", {.times = days, .time_units = "days since 1900-01-01"});
  const Numbers times = times_of("wind.nc", read::SceneClock{.unit = "h"});
  for (int hour = 0; hour < 30; ++hour) EXPECT_EQ(times[static_cast<std::size_t>(hour)], hour);
}

TEST_F(Netcdf, velocities_follow_a_unit_of_the_scene_and_a_warning_tells_where_units_do_not_fit) {
  write_wind("wind.nc", {.time_units = "days since 2000-01-01", .units = "cm/s"});
  const auto plain = wind("wind.nc");
  EXPECT_EQ(plain->values[1][0], 100);
  ASSERT_EQ(plain->warnings.size(), 1u);
  EXPECT_EQ(plain->warnings[0].message, "wind.nc has velocities in \"cm/s\", and its times count in days");
  read::GridRequest request = vector_of();
  request.clock = read::SceneClock{.unit = "h"};
  EXPECT_EQ(wind("wind.nc", request)->values[1][0], 360000);
  EXPECT_TRUE(wind("wind.nc", request)->warnings.empty());
  request.clock = read::SceneClock{.unit_number = 2};
  EXPECT_EQ(wind("wind.nc", request)->values[1][0], 100);
}

TEST_F(Netcdf, calendars_count_their_own_days) {
  // From 28 February to 1 March of a leap year.
  for (const auto& [calendar, hours] : std::vector<std::pair<std::string, double> >{{"", 48},
                                                                                    {"gregorian", 48},
                                                                                    {"proleptic_gregorian", 48},
                                                                                    {"noleap", 24},
                                                                                    {"365_day", 24},
                                                                                    {"360_day", 72}}) {
    write_wind("wind.nc", {.times = {0, 100}, .time_units = "hours since 2000-02-28", .calendar = calendar});
    EXPECT_EQ(times_of("wind.nc", read::SceneClock{.start = "2000-03-01"}), (Numbers{-hours, 100 - hours})) << calendar;
  }
  write_wind("wind.nc", {.calendar = "lunar"});
  EXPECT_NE(refusal("wind.nc", vector_of()).find("calendar \"lunar\""), std::string::npos);
  write_wind("wind.nc", {.time_units = "months since 2000-01-01"});
  EXPECT_NE(refusal("wind.nc", vector_of()).find("\"months since 2000-01-01\", which is not understood"),
            std::string::npos);
}

TEST_F(Netcdf, a_pattern_is_a_series_in_the_order_of_time) {
  write_wind("wind_a.nc", {.times = {0, 1}, .time_units = "hours since 2000-01-02"});
  write_wind("wind_b.nc", {.times = {22, 23}, .time_units = "hours since 2000-01-01"});
  write_wind("calm.nc");
  const auto data = wind("wind_*.nc");
  EXPECT_EQ(data->times, (Numbers{0, 1, 2, 3}));
  EXPECT_EQ(data->clock, "t = 0 at 2000-01-01 22:00, in hours");
  EXPECT_EQ(data->values[3][0], 100);
  EXPECT_NE(refusal("breeze_*.nc", vector_of()).find("there is no file breeze_*.nc in"), std::string::npos);
  write_wind("wind_c.nc", {.y = {10, 20, 31}});
  EXPECT_NE(refusal("wind_*.nc", vector_of()).find("the grid of wind_c.nc differs from that of wind_a.nc"),
            std::string::npos);
}

TEST_F(Netcdf, two_snapshots_for_one_time_are_refused_or_one_is_taken) {
  write_wind("wind.nc", {.times = {0, 1, 1, 2}});
  EXPECT_NE(
      refusal("wind.nc", vector_of()).find("wind.nc has two snapshots for 2000-01-01 01:00\nduplicates = \"first\""),
      std::string::npos);
  read::GridRequest request = vector_of();
  request.duplicates = read::Duplicates::first;
  EXPECT_EQ(wind("wind.nc", request)->values[1][0], 100);
  request.duplicates = read::Duplicates::last;
  EXPECT_EQ(wind("wind.nc", request)->values[1][0], 200);
  EXPECT_EQ(wind("wind.nc", request)->times, (Numbers{0, 1, 2}));
}

TEST_F(Netcdf, a_gap_is_told_refused_or_bridged) {
  write_wind("wind.nc", {.times = {0, 1, 2, 4, 5}, .units = "m h-1"});
  const std::string gap = "wind.nc misses 1 snapshot: between 2000-01-01 02:00 and 2000-01-01 04:00 is a gap";
  ASSERT_EQ(wind("wind.nc")->warnings.size(), 1u);
  EXPECT_EQ(wind("wind.nc")->warnings[0].message, gap);
  read::GridRequest request = vector_of();
  request.gaps = read::Gaps::error;
  EXPECT_NE(refusal("wind.nc", request).find(gap), std::string::npos);
  request.gaps = read::Gaps::bridge;
  EXPECT_TRUE(wind("wind.nc", request)->warnings.empty());
}

TEST_F(Netcdf, a_snapshot_without_values_is_a_missing_one) {
  {
    NetcdfWriter file(folder_ / "rho.nc");
    file.dimension("time", 0);
    file.dimension("y", 2);
    file.dimension("x", 2);
    for (const char* name : {"time", "y", "x"}) file.variable(name, NC_DOUBLE, {name});
    file.variable("rho", NC_DOUBLE, {"time", "y", "x"});
    file.values("time", {0, 1, 2}, 3);
    file.values("y", {0, 1});
    file.values("x", {0, 1});
    file.values("rho", {1, 1, 1, 1, NC_FILL_DOUBLE, NC_FILL_DOUBLE, NC_FILL_DOUBLE, NC_FILL_DOUBLE, 3, 3, 3, 3}, 3);
  }
  EXPECT_NE(refusal("rho.nc", {.missing = Missing::zero}).find("rho.nc at time 1 has no values at all"),
            std::string::npos);
  const auto data = wind("rho.nc", {.gaps = read::Gaps::bridge});
  EXPECT_EQ(data->times, (Numbers{0, 2}));
  EXPECT_EQ(data->filled, "1 snapshot without values left out");
}

TEST_F(Netcdf, long_series_are_read_on_the_way_with_the_same_values) {
  Numbers hours;
  for (int i = 0; i < 40; ++i) hours.push_back(i);
  write_wind("wind.nc", {.times = hours, .units = "m h-1"});
  const auto held = wind("wind.nc");
  for (const Interpolation in_time : {Interpolation::linear, Interpolation::cubic}) {
    read::GridRequest request = vector_of();
    request.most_held = 1;
    request.times_at_once = gaussdrift::times_of(in_time);
    const auto read = wind("wind.nc", request);
    ASSERT_TRUE(read->levels);
    EXPECT_TRUE(read->values.empty());
    EXPECT_EQ(read->levels->most_held(), in_time == Interpolation::linear ? 3u : 5u);
    const GridInterpolator a(held, Interpolation::linear, Outside::error, in_time);
    const GridInterpolator b(read, Interpolation::linear, Outside::error, in_time);
    const std::array<double, 2> x{1.25, 3.5}, y{29, 11};
    for (const double t : {0., 0.5, 17.25, 3., 39., 38.75}) {
      std::array<std::array<double, 2>, 2> sums_a{}, sums_b{};
      const PointsView points{2, 2, {x.data(), y.data()}};
      double* const to_a[] = {sums_a[0].data(), sums_a[1].data()};
      double* const to_b[] = {sums_b[0].data(), sums_b[1].data()};
      a.add(t, points, 2, to_a);
      b.add(t, points, 2, to_b);
      EXPECT_EQ(sums_a, sums_b) << t;
    }
    EXPECT_TRUE(std::isinf(a.held_until(0)));
    EXPECT_EQ(b.held_until(7.5), 9);
    EXPECT_TRUE(std::isinf(b.held_until(38.5)));
    EXPECT_TRUE(std::isinf(a.held_since(39)));
    EXPECT_EQ(b.held_since(7.5), 6) << "the same as seen from the end";
    EXPECT_TRUE(std::isinf(b.held_since(0.5)));
  }
}

TEST_F(Netcdf, values_that_are_missing_on_the_way_end_the_run_with_their_place) {
  {
    NetcdfWriter file(folder_ / "wind.nc");
    file.dimension("time", 0);
    file.dimension("y", 2);
    file.dimension("x", 2);
    for (const char* name : {"time", "y", "x"}) file.variable(name, NC_DOUBLE, {name});
    for (const char* name : {"u", "v"}) file.variable(name, NC_DOUBLE, {"time", "y", "x"});
    file.text("time", "units", "hours since 2000-01-01");
    file.values("time", {0, 1, 2}, 3);
    file.values("y", {0, 1});
    file.values("x", {0, 1});
    for (const char* name : {"u", "v"}) file.values(name, {1, 1, 1, 1, 2, NC_FILL_DOUBLE, 2, 2, 3, 3, 3, 3}, 3);
  }
  read::GridRequest request = vector_of();
  request.most_held = 1;
  const auto data = wind("wind.nc", request);
  try {
    data->levels->at(1);
    ADD_FAILURE() << "the missing value was not seen";
  } catch (const InputError& error) {
    EXPECT_NE(
        std::string(error.what()).find("in wind.nc at 2000-01-01 01:00: [u, v] of wind.nc has no value at (1, 0)"),
        std::string::npos)
        << error.what();
  }
  // Taken for land, it ends the run of a particle that reaches it.
  request.missing = read::Missing::land;
  const GriddedVelocity u(GridInterpolator(wind("wind.nc", request), Interpolation::linear, Outside::error));
  EXPECT_EQ(u.why_not_finite(0, {0.9, 0.1, 0}), "");
  const std::string reason = u.why_not_finite(1, {0.9, 0.1, 0});
  EXPECT_NE(reason.find("it has reached land, where [u, v] of wind.nc has no value"), std::string::npos) << reason;
}

TEST_F(Netcdf, files_that_are_none_are_refused) {
  std::ofstream(folder_ / "text.nc") << "no NetCDF";
  EXPECT_NE(refusal("text.nc", vector_of()).find("text.nc is no NetCDF file that can be read"), std::string::npos);
  EXPECT_NE(refusal("nowhere.nc", vector_of()).find("there is no file"), std::string::npos);
  for (const int format : {NC_CLOBBER, NC_64BIT_DATA, NC_NETCDF4}) {
    write_wind("wind.nc", {.format = format});
    const auto size = fs::file_size(folder_ / "wind.nc");
    for (const std::uintmax_t length : {size - 8, size / 2, size / 8, std::uintmax_t{4}}) {
      fs::resize_file(folder_ / "wind.nc", length);
      EXPECT_NE(refusal("wind.nc", vector_of()), "") << format << ", " << length;
    }
  }
}

TEST_F(Netcdf, what_is_not_on_one_straight_grid_is_refused) {
  {
    NetcdfWriter file(folder_ / "odd.nc");
    for (const char* name : {"x", "y", "xs"}) file.dimension(name, 2);
    for (const char* name : {"x", "y", "xs"}) file.variable(name, NC_DOUBLE, {name});
    file.text("xs", "axis", "X");
    file.variable("u", NC_DOUBLE, {"y", "xs"});
    file.variable("v", NC_DOUBLE, {"y", "x"});
    file.variable("nav_lon", NC_DOUBLE, {"y", "x"});
    file.values("x", {0, 1});
    file.values("y", {0, 1});
  }
  EXPECT_NE(refusal("odd.nc", vector_of()).find("\"u\" (y x xs) and \"v\" (y x x) on different grids"),
            std::string::npos);
  {
    NetcdfWriter file(folder_ / "curved.nc");
    for (const char* name : {"j", "i"}) file.dimension(name, 2);
    for (const char* name : {"nav_lat", "nav_lon", "u", "v"}) file.variable(name, NC_DOUBLE, {"j", "i"});
    for (const char* name : {"u", "v"}) file.text(name, "coordinates", "nav_lat nav_lon");
  }
  EXPECT_NE(refusal("curved.nc", vector_of()).find("lies on a curvilinear grid"), std::string::npos);
}

TEST_F(Netcdf, carries_the_particles_of_a_case) {
  write_wind("wind.nc", {.times = {0, 6}, .units = "m h-1"});
  EXPECT_EQ(message("file = \"wind.nc\""), "");
  EXPECT_EQ(message("file = \"wind.nc\"\ntime = { start = \"2000-01-01 01:00\", unit = \"h\" }"), "");
  EXPECT_NE(message("file = \"wind.nc\"\ntime = { start = \"2000-01-01 06:00\" }").find("covers the times -6 to 0"),
            std::string::npos);
  EXPECT_NE(message("file = \"wind.nc\"\ntime = { unit = \"fortnight\" }").find("\"fortnight\" is no unit of time"),
            std::string::npos);
  EXPECT_NE(message("file = \"wind.nc\"\ntime = { begin = 1 }").find("unknown key \"begin\" in velocity.time"),
            std::string::npos);
  EXPECT_NE(message("file = \"wind.nc\"\ntime = 3").find("velocity.time must be a table"), std::string::npos);
}

TEST_F(Netcdf, the_text_of_a_case_names_its_clock_again) {
  write_wind("wind.nc", {.times = {0, 6}, .units = "m h-1"});
  const ReadResult first = parse_case(
      case_with(
          "file = \"wind.nc\"\ntime = { start = \"2000-01-01 01:00\", unit = \"h\" }\ntime_interpolation = \"cubic\""),
      folder_ / "cone.toml", {"time.end=1", "output.times=[1]"});
  const std::string text = case_text(first.spec);
  EXPECT_NE(text.find("time = { start = \"2000-01-01 01:00\", unit = \"h\" }"), std::string::npos) << text;
  EXPECT_EQ(case_text(parse_case(text, folder_ / "cone.toml").spec), text);
}

TEST_F(Netcdf, times_of_a_case_may_be_dates_of_its_data) {
  write_wind("wind.nc", {.times = {0, 6}, .units = "m h-1"});
  const auto read = [&](const std::string& start, const std::string& end, const std::string& times) {
    return parse_case(case_with("file = \"wind.nc\"\ntime = { unit = \"min\" }"), folder_ / "cone.toml",
                      {"time.start=" + start, "time.end=" + end, "output.times=" + times})
        .spec;
  };
  const Case spec = read("2000-01-01 05:30", "\"2000-01-01 01:00\"", "[\"2000-01-01T05:00\", 60]");
  EXPECT_EQ(spec.time.start, 330);
  EXPECT_TRUE(spec.time.backwards);
  EXPECT_EQ(spec.time.end, 270);
  EXPECT_EQ(spec.output.times, (Numbers{30, 270}));
  EXPECT_EQ(spec.time.date(spec.time.at(30)), "2000-01-01 05:00");
  EXPECT_NE(
      message_of<CaseError>([&] { read("2000-01-32", "60", "[60]"); }).find("time.start is no date of the calendar"),
      std::string::npos);
  EXPECT_NE(message_of<CaseError>([&] {
              read("1999-12-31", "60", "[60]");
            }).find("covers the times 0 to 360, but the run goes from -1440 to 60"),
            std::string::npos);
}

#endif

}  // namespace
}  // namespace gaussdrift::input
