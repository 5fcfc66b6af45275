// domain.coordinates: what a case on longitudes and latitudes may say, and what it may not; where its particles go in data, as
// an independent program has it (SciPy, tests/reference/scipy-sphere-paths.py).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "case_text.hpp"
#include "cases.hpp"
#include "gaussdrift/particles.hpp"
#include "grid_files.hpp"
#include "sim/make_fields.hpp"
#include "sim/stepper.hpp"

#ifdef HAS_NETCDF
#include "netcdf_files.hpp"
#endif

namespace gaussdrift::input {
namespace {

CaseTables on_earth() {
  return {.domain = "coordinates = \"longitude latitude\"\nmin = [-30, 20]\nmax = [30, 70]",
          .density = shape_of("wendland", "0, 45", "8e5"),
          .particles = "per_axis = 21"};
}

std::string complaint(const CaseTables& tables, const std::string& more = "") {
  return errors(gaussdrift::case_text(tables) + more);
}

std::string with_domain(const std::string& lines) {
  CaseTables tables = on_earth();
  tables.domain = "coordinates = \"longitude latitude\"\n" + lines;
  return complaint(tables);
}

TEST(Coordinates, AreReadAndWritten) {
  const Case spec = parse_case(gaussdrift::case_text(on_earth()), "scene.toml").spec;
  EXPECT_EQ(spec.domain.sphere, 6371000);
  EXPECT_FALSE(spec.domain.has_edges());
  const std::string text = gaussdrift::case_text(spec);
  expect_has(text, "coordinates = \"longitude latitude\"\nradius = 6371000\n");
  EXPECT_EQ(parse_case(text, "again.toml").spec.domain.sphere, 6371000);
  CaseTables moon = on_earth();
  moon.domain += "\nradius = 1737.4e3";
  EXPECT_EQ(parse_case(gaussdrift::case_text(moon), "moon.toml").spec.domain.sphere, 1737400);
  CaseTables round = on_earth();
  round.domain = "coordinates = \"longitude latitude\"\nmin = [0, -60]\nmax = [360, 60]";
  round.particles = "per_axis = 37";
  EXPECT_EQ(parse_case(gaussdrift::case_text(round), "round.toml").spec.domain.edges[0],
            (std::array{Edge::periodic, Edge::periodic}));
  EXPECT_EQ(parse_case(gaussdrift::case_text(), "plane.toml").spec.domain.sphere, 0);
}

TEST(Coordinates, RefuseDomainsThatAreNone) {
  expect_has(with_domain("min = [-30, 20]\nmax = [30, 89.5]"), "reaches to the latitude 89.5, too near to a pole");
  expect_has(with_domain("min = [-30, -90]\nmax = [30, 0]"), "latitudes from -89 to 89");
  expect_has(with_domain("min = [-200, 20]\nmax = [200, 60]"), "over 400 degrees of longitude");
  expect_has(with_domain("min = [-30, 20, 0]\nmax = [30, 60, 1]"), "need a domain of 2 dimensions");
  expect_has(with_domain("min = [-30, 20]\nmax = [30, 60]\nradius = 0"), "domain.radius must be greater than 0");
  expect_has(with_domain("min = [-30, 20]\nmax = [30, 60]\nedges = [\"periodic\", \"open\"]"), "cannot be periodic");
  expect_has(with_domain("min = [-30, 20]\nmax = [30, 60]\nedges = [\"closed\", \"open\"]"),
             "closed edges need blobs mirrored");
  expect_has(with_domain("min = [-180, 20]\nmax = [180, 60]\nedges = [\"open\", \"open\"]"), "goes all the way round");
  expect_has(with_domain("min = [-180, 20]\nmax = [180, 60]\nedges = [\"periodic\", \"periodic\"]"),
             "latitudes are not periodic");
  CaseTables tables = on_earth();
  tables.domain = "min = [-30, 20]\nmax = [30, 60]\nradius = 5";
  expect_has(complaint(tables), "domain.radius is that of a sphere, and there is none");
  tables.domain = "min = [-30, 20]\nmax = [30, 60]\ncoordinates = \"lat lon\"";
  expect_has(complaint(tables), "\"longitude latitude\"");
}

TEST(Coordinates, RefuseWhatKnowsLengthsAlone) {
  CaseTables tables = on_earth();
  EXPECT_EQ(complaint(tables), "");
  tables.velocity = "field = \"rotation\"";
  expect_has(complaint(tables), "the field \"rotation\" is one of lengths");
  tables = on_earth();
  tables.output += "\nfields = [\"gradient\"]";
  expect_has(complaint(tables), "\"gradient\" is a derivative by lengths");
  tables = on_earth();
  tables.output += "\nfields = [\"ftle\"]";
  expect_has(complaint(tables), "\"ftle\" is a derivative by lengths");
  tables = on_earth();
  expect_has(complaint(tables, "[effects.remesh]\nevery = 3\n"), "[effects.remesh] does not go with longitudes");
  expect_has(complaint(tables, "[effects.vortex]\n"), "the velocity of vortices is that of the plane");
  expect_has(complaint(tables, "[effects.charge]\nmobility = 1\n"), "[effects.charge] does not go with longitudes");
  expect_has(complaint(tables, "[effects.diffusion]\nD = 10\nmethod = \"random-walk\"\n"),
             "method = \"core-spreading\" with D");
  expect_has(complaint(tables, "[effects.diffusion]\nD_axes = [10, 20]\n"),
             "of diffusion on a sphere only core spreading");
  EXPECT_EQ(complaint(tables, "[effects.diffusion]\nD = 10\n"), "");
  EXPECT_EQ(complaint(tables, "[effects.reaction]\nrate = \"0.1\"\n"), "");
  tables.velocity = "field = \"sphere_rotation\"\npole = [0, 90]";
  EXPECT_EQ(complaint(tables), "");
  tables.domain = square;
  expect_has(complaint(tables), "coordinates = \"longitude latitude\" in [domain]");
}

#ifdef HAS_NETCDF

class SpherePaths : public GridFile {
 protected:
  /// As in the script; without an end that meets the beginning.
  void write_wind() const {
    NetcdfWriter file(folder_ / "wind.nc");
    std::vector<double> x, y, u, v;
    const std::vector<double> t{0, 2, 4, 7, 10};
    for (int i = 0; i < 24; ++i) x.push_back(15. * i);
    for (int j = 0; j < 21; ++j) y.push_back(-75 + 7.5 * j);
    for (const double time : t)
      for (const double latitude : y)
        for (const double longitude : x) {
          const double along = longitude * std::numbers::pi / 180, c = std::cos(latitude * std::numbers::pi / 180);
          u.push_back(20 * c * (1.5 + std::sin(2 * along + 0.3 * time)));
          v.push_back(12 * c * std::cos(along - 0.2 * time));
        }
    file.dimension("time", 0);
    file.dimension("lat", y.size());
    file.dimension("lon", x.size());
    for (const char* name : {"time", "lat", "lon"}) file.variable(name, NC_DOUBLE, {name});
    for (const char* name : {"u", "v"}) file.variable(name, NC_DOUBLE, {"time", "lat", "lon"});
    file.text("time", "units", "days since 2020-01-01");
    file.text("lat", "units", "degrees_north");
    file.text("lon", "units", "degrees_east");
    for (const char* name : {"u", "v"}) file.text(name, "units", "m s-1");
    file.values("lon", x);
    file.values("lat", y);
    file.values("time", t, t.size());
    file.values("u", u, t.size());
    file.values("v", v, t.size());
  }
};

TEST_F(SpherePaths, AreThoseOfScipyAcrossTheEndOfTheDataAndAcross180) {
  write_wind();
  int compared = 0;
  for (const std::string order : {"linear", "cubic"}) {
    CaseTables tables = on_earth();
    tables.domain = "coordinates = \"longitude latitude\"\nmin = [-180, -70]\nmax = [180, 70]";
    tables.particles = "per_axis = 37";
    tables.velocity = fmt::format(
        "file = \"wind.nc\"\narrays = [\"u\", \"v\"]\ntime = {{ unit = \"d\" }}\ninterpolation = \"{0}\"\n"
        "time_interpolation = \"{0}\"",
        order);
    tables.time = "end = 10\nstep = 0.1";
    const ReadResult read = parse_case(gaussdrift::case_text(tables), folder_ / "scene.toml");
    EXPECT_TRUE(read.warnings.empty()) << read.warnings.front();
    Particles particles;
    std::vector<std::array<double, 2>> ends;
    std::ifstream table(std::string(REFERENCE_DIR) + "/scipy-sphere-paths.csv");
    for (std::string line; std::getline(table, line);) {
      if (line.rfind(order + ",", 0) != 0) continue;
      std::istringstream cells(line.substr(order.size() + 1));
      std::array<double, 4> number{};
      for (double& one : number) {
        std::string cell;
        std::getline(cells, cell, ',');
        one = std::stod(cell);
      }
      for (std::size_t k = 0; k < 2; ++k) particles.position[k].push_back(number[k]);
      particles.alpha.push_back(1);
      particles.id.push_back(static_cast<std::int64_t>(ends.size()));
      ends.push_back({number[2], number[3]});
    }
    ASSERT_EQ(ends.size(), 3u);
    const auto velocity = make_velocity(read.spec, 1);
    const time::Interval interval(0, 10, order == "linear" ? 2e-4 : 2e-3);  // a kink costs the square of a step
    Stepper(*velocity, time::find_tableau("rk4"), 1).advance(particles, interval, 0, interval.steps(), 0);
    for (std::size_t j = 0; j < ends.size(); ++j, ++compared) {
      EXPECT_NEAR(particles.position[0][j], ends[j][0], 1e-7) << order;
      EXPECT_NEAR(particles.position[1][j], ends[j][1], 1e-7) << order;
    }
  }
  EXPECT_EQ(compared, 6);
}

TEST_F(SpherePaths, WarnWhereUnitsAreNoDegrees) {
  NetcdfWriter file(folder_ / "flat.nc");
  file.dimension("y", 3);
  file.dimension("x", 3);
  for (const char* name : {"y", "x"}) file.variable(name, NC_DOUBLE, {name});
  for (const char* name : {"u", "v"}) file.variable(name, NC_DOUBLE, {"y", "x"});
  file.text("x", "units", "km");
  file.text("y", "units", "km");
  for (const char* name : {"u", "v"}) {
    file.text(name, "units", "cm s-1");
    file.values(name, std::vector<double>(9, 1.0));
  }
  file.values("x", {-40, 0, 40});
  file.values("y", {-80, 0, 80});
  CaseTables tables = on_earth();
  tables.velocity = "file = \"flat.nc\"\narrays = [\"u\", \"v\"]";
  const ReadResult read = parse_case(gaussdrift::case_text(tables), folder_ / "scene.toml");
  ASSERT_EQ(read.warnings.size(), 2u);
  expect_has(read.warnings[0], "in the unit of domain.radius");
  expect_has(read.warnings[1], "\"km\"");
}

#endif

}  // namespace
}  // namespace gaussdrift::input
