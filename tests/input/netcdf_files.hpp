// NetCDF files for tests, written by the library itself.
#pragma once

#include <netcdf.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace gaussdrift {

class NetcdfWriter {
 public:
  explicit NetcdfWriter(const std::filesystem::path& file, int format = NC_NETCDF4) {
    check(nc_create(file.c_str(), NC_CLOBBER | format, &id_));
  }
  ~NetcdfWriter() { nc_close(id_); }
  NetcdfWriter(const NetcdfWriter&) = delete;
  NetcdfWriter& operator=(const NetcdfWriter&) = delete;

  /// 0: it grows.
  void dimension(const std::string& name, std::size_t length) {
    int made = 0;
    check(nc_def_dim(id_, name.c_str(), length == 0 ? NC_UNLIMITED : length, &made));
  }
  void variable(const std::string& name, nc_type type, const std::vector<std::string>& dimensions) {
    std::vector<int> along;
    for (const std::string& dimension : dimensions) {
      along.push_back(0);
      check(nc_inq_dimid(id_, dimension.c_str(), &along.back()));
    }
    int made = 0;
    check(nc_def_var(id_, name.c_str(), type, static_cast<int>(along.size()), along.data(), &made));
  }
  void text(const std::string& variable, const std::string& attribute, const std::string& value) {
    check(nc_put_att_text(id_, find(variable), attribute.c_str(), value.size(), value.c_str()));
  }
  void number(const std::string& variable, const std::string& attribute, double value, nc_type type = NC_DOUBLE) {
    check(nc_put_att_double(id_, find(variable), attribute.c_str(), type, 1, &value));
  }
  /// All numbers of a variable that does not grow, or the first `rows` of one that does.
  void values(const std::string& variable, const std::vector<double>& numbers, std::size_t rows = 0) {
    nc_enddef(id_);
    const int at = find(variable);
    int rank = 0;
    check(nc_inq_varndims(id_, at, &rank));
    std::vector<int> along(static_cast<std::size_t>(rank));
    check(nc_inq_vardimid(id_, at, along.data()));
    std::vector<std::size_t> start(along.size(), 0), count(along.size());
    for (std::size_t k = 0; k < along.size(); ++k) check(nc_inq_dimlen(id_, along[k], &count[k]));
    if (rows > 0) count[0] = rows;
    check(nc_put_vara_double(id_, at, start.data(), count.data(), numbers.data()));
  }

 private:
  static void check(int status) {
    if (status != NC_NOERR) throw std::runtime_error(nc_strerror(status));
  }
  int find(const std::string& variable) const {
    int at = 0;
    check(nc_inq_varid(id_, variable.c_str(), &at));
    return at;
  }
  int id_ = 0;
};

}  // namespace gaussdrift
