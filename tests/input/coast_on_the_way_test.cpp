// Land is looked for before the run, so data that are read during it know no coast.
#ifdef HAS_NETCDF
#include <vector>

#include "grid_files.hpp"
#include "netcdf_files.hpp"

namespace gaussdrift::input {
namespace {

class LongSeries : public GridFile {
 protected:
  /// Some hours of 200 x 200 points, of which the first is written: 640 kB an hour.
  std::string said(const std::string& name, std::size_t hours) const {
    constexpr std::size_t n = 200;
    {
      NetcdfWriter file(folder_ / name, NC_NETCDF4);
      file.dimension("time", 0);
      file.dimension("lat", n);
      file.dimension("lon", n);
      file.variable("time", NC_DOUBLE, {"time"});
      file.text("time", "units", "hours since 2000-01-01");
      file.variable("lat", NC_FLOAT, {"lat"});
      file.variable("lon", NC_FLOAT, {"lon"});
      for (const char* array : {"u", "v"}) {
        file.variable(array, NC_FLOAT, {"time", "lat", "lon"});
        file.text(array, "units", "m h-1");
      }
      std::vector<double> axis(n), times(hours);
      for (std::size_t i = 0; i < n; ++i) axis[i] = -2 + 4. * static_cast<double>(i) / (n - 1);
      for (std::size_t i = 0; i < hours; ++i) times[i] = static_cast<double>(i);
      file.values("lat", axis);
      file.values("lon", axis);
      file.values("time", times, hours);
      for (const char* array : {"u", "v"})
        file.values(array, std::vector<double>(n * n * std::min<std::size_t>(hours, 2)),
                    std::min<std::size_t>(hours, 2));
    }
    try {
      parse_case(case_with("file = \"" + name + "\""), folder_ / "cone.toml",
                 {"time.end=1", "output.times=[1]", "domain.coast=\"stop\"", "reference.kind=\"none\""});
    } catch (const CaseError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(LongSeries, KnowsNoCoast) {
  constexpr const char* refused =
      "domain.coast needs to know where land is, and [u, v] of long.nc is too long to be held";
  EXPECT_NE(said("long.nc", 500).find(refused), std::string::npos);
  EXPECT_EQ(said("short.nc", 2).find("too long to be held"), std::string::npos);
}

}  // namespace
}  // namespace gaussdrift::input
#endif
