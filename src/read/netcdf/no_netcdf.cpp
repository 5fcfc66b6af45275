// A build without NetCDF.
#include <fmt/format.h>

#include "read/file_bytes.hpp"
#include "read/grid_file_error.hpp"
#include "read/netcdf/netcdf_file.hpp"

namespace gaussdrift::read {

struct NetcdfFile::Handle {};

std::string netcdf_library() { return ""; }

NetcdfFile::NetcdfFile(const std::filesystem::path& file) : name_(file.filename().string()) {
  check_readable(file);
  throw GridFileError(fmt::format("{} is a NetCDF file, and this program was built without NetCDF", name_),
                      "install libnetcdf-dev (Debian), configure and build again");
}

NetcdfFile::~NetcdfFile() = default;

std::vector<double> NetcdfFile::read(const NetcdfVariable&, const std::vector<std::size_t>&,
                                     const std::vector<std::size_t>&) const {
  return {};
}
std::vector<double> NetcdfFile::read_all(const NetcdfVariable&) const { return {}; }
double NetcdfFile::usual_fill(const NetcdfVariable&) const { return 0; }
void NetcdfFile::check_is_whole(const std::filesystem::path&) const {}

}  // namespace gaussdrift::read
