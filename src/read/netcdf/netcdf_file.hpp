// A NetCDF file as it stands: dimensions, variables, attributes, numbers. netcdf_file.cpp alone knows the library; where the
// program is built without it, no_netcdf.cpp stands in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace gaussdrift::read {

/// "netCDF 4.9.0"; empty in a build without it.
std::string netcdf_library();

struct NetcdfDimension {
  std::string name;
  std::size_t length = 0;
};

struct NetcdfAttribute {
  std::string name;
  std::string text;             // of letters
  std::vector<double> numbers;  // of numbers
};

struct NetcdfVariable {
  int id = 0;
  std::string name;
  std::vector<std::size_t> dimensions;  // as indices, the one that changes fastest comes last
  bool holds_numbers = true;
  bool is_single = false;    // floats
  bool is_byte = false;      // has no usual mark of what is missing
  double unsigned_span = 0;  // is added to negative numbers, which are none (_Unsigned)
  std::vector<NetcdfAttribute> attributes;

  const NetcdfAttribute* find(const std::string& attribute) const;
  /// Its text; empty if it has none.
  std::string text(const std::string& attribute) const;
};

class NetcdfFile {
 public:
  /// Opens the file and reads what it says of itself. Throws GridFileError: no such file, no NetCDF, damaged, cut off.
  explicit NetcdfFile(const std::filesystem::path& file);
  ~NetcdfFile();
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  const std::string& name() const { return name_; }
  const std::vector<NetcdfDimension>& dimensions() const { return dimensions_; }
  const std::vector<NetcdfVariable>& variables() const { return variables_; }
  const NetcdfVariable* find(const std::string& variable) const;

  /// Numbers as they stand in the file, in the file's order: `count[k]` of them along its dimension k, from `start[k]` on.
  /// Throws GridFileError.
  std::vector<double> read(const NetcdfVariable& variable, const std::vector<std::size_t>& start,
                           const std::vector<std::size_t>& count) const;
  /// All numbers of a variable with one dimension.
  std::vector<double> read_all(const NetcdfVariable& variable) const;
  /// What stands where nothing was written.
  double usual_fill(const NetcdfVariable& variable) const;

 private:
  void check_is_whole(const std::filesystem::path& file) const;

  std::string name_;
  std::vector<NetcdfDimension> dimensions_;
  std::vector<NetcdfVariable> variables_;
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace gaussdrift::read
