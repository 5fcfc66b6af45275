#include "read/netcdf/netcdf_file.hpp"

#include <fmt/format.h>
#include <netcdf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/shared_module.hpp"
#include "read/file_bytes.hpp"
#include "read/grid_file_error.hpp"
#include "read/stored_grid.hpp"

namespace gaussdrift::read {

namespace {

/// The library. It is loaded for the first file, because it brings HDF5, a client for the network, and what these need.
struct Library {
  const base::SharedModule& module;
#define NETCDF_FUNCTION(name) decltype(::name)* const name = module.find<decltype(::name)>(#name)
  NETCDF_FUNCTION(nc_close);
  NETCDF_FUNCTION(nc_free_string);
  NETCDF_FUNCTION(nc_get_att_double);
  NETCDF_FUNCTION(nc_get_att_string);
  NETCDF_FUNCTION(nc_get_att_text);
  NETCDF_FUNCTION(nc_get_vara_double);
  NETCDF_FUNCTION(nc_inq);
  NETCDF_FUNCTION(nc_inq_att);
  NETCDF_FUNCTION(nc_inq_attname);
  NETCDF_FUNCTION(nc_inq_dim);
  NETCDF_FUNCTION(nc_inq_dimids);
  NETCDF_FUNCTION(nc_inq_format);
  NETCDF_FUNCTION(nc_inq_libvers);
  NETCDF_FUNCTION(nc_inq_natts);
  NETCDF_FUNCTION(nc_inq_unlimdim);
  NETCDF_FUNCTION(nc_inq_var);
  NETCDF_FUNCTION(nc_inq_varndims);
  NETCDF_FUNCTION(nc_inq_vartype);
  NETCDF_FUNCTION(nc_open);
  NETCDF_FUNCTION(nc_strerror);
#undef NETCDF_FUNCTION
};

const base::SharedModule& module() {
  static const base::SharedModule loaded({NETCDF_NAME, NETCDF_FILE});
  return loaded;
}

/// Throws GridFileError where the library is gone.
const Library& netcdf() {
  if (!module().is_there())
    throw GridFileError("NetCDF files cannot be read: " + module().reason(),
                        "install the library again (Debian: libnetcdf19)");
  static const Library library{module()};
  return library;
}

constexpr std::size_t most_of_an_attribute = 1 << 20;

// The library is not made for several threads.
std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

void check(int status, const std::string& file, const std::string& what) {
  if (status == NC_NOERR) return;
  throw GridFileError(fmt::format("{} {}: {}", file, what, netcdf().nc_strerror(status)),
                      "the file may be damaged or cut off: copy it again, or look at it with ncdump -h");
}

bool holds_numbers(nc_type type) {
  constexpr std::array types{NC_BYTE, NC_UBYTE, NC_SHORT,  NC_USHORT, NC_INT,
                             NC_UINT, NC_INT64, NC_UINT64, NC_FLOAT,  NC_DOUBLE};
  return std::find(types.begin(), types.end(), type) != types.end();
}

std::size_t bytes_of(nc_type type) {
  switch (type) {
    case NC_SHORT:
    case NC_USHORT:
      return 2;
    case NC_INT:
    case NC_UINT:
    case NC_FLOAT:
      return 4;
    case NC_INT64:
    case NC_UINT64:
    case NC_DOUBLE:
      return 8;
    default:
      return 1;
  }
}

}  // namespace

std::string netcdf_library() {
  if (!module().is_there()) return "";
  const std::string text = netcdf().nc_inq_libvers();
  return "netCDF " + text.substr(0, text.find(' '));
}

struct NetcdfFile::Handle {
  int id = -1;
  ~Handle() {
    const std::lock_guard<std::mutex> lock(one_at_a_time());
    if (id >= 0) netcdf().nc_close(id);
  }
  NetcdfAttribute attribute(const std::string& file, int variable, int index) const {
    std::array<char, NC_MAX_NAME + 1> name{};
    const std::string what = "has an attribute that cannot be read";
    check(netcdf().nc_inq_attname(id, variable, index, name.data()), file, what);
    NetcdfAttribute attribute{name.data(), {}, {}};
    nc_type type = 0;
    std::size_t length = 0;
    check(netcdf().nc_inq_att(id, variable, name.data(), &type, &length), file, what);
    if (length > most_of_an_attribute)
      throw GridFileError(fmt::format("the attribute {} of {} has {} entries", attribute.name, file, length));
    if (type == NC_CHAR) {
      attribute.text.resize(length);
      check(netcdf().nc_get_att_text(id, variable, name.data(), attribute.text.data()), file, what);
      while (!attribute.text.empty() && attribute.text.back() == '\0') attribute.text.pop_back();
    } else if (type == NC_STRING && length > 0) {
      std::vector<char*> texts(length, nullptr);
      check(netcdf().nc_get_att_string(id, variable, name.data(), texts.data()), file, what);
      if (texts[0]) attribute.text = texts[0];
      netcdf().nc_free_string(length, texts.data());
    } else if (holds_numbers(type)) {
      attribute.numbers.resize(length);
      check(netcdf().nc_get_att_double(id, variable, name.data(), attribute.numbers.data()), file, what);
    }
    return attribute;
  }
};

NetcdfFile::NetcdfFile(const std::filesystem::path& file)
    : name_(file.filename().string()), handle_(std::make_unique<Handle>()) {
  check_readable(file);
  const std::unique_lock<std::mutex> lock(one_at_a_time());
  const std::string path = std::filesystem::absolute(file).string();
  if (const int status = netcdf().nc_open(path.c_str(), NC_NOWRITE, &handle_->id); status != NC_NOERR) {
    handle_->id = -1;
    throw GridFileError(fmt::format("{} is no NetCDF file that can be read: {}", name_, netcdf().nc_strerror(status)),
                        "the file may be damaged, cut off, or of another kind: ncdump -h shows what is in it");
  }
  const std::string what = "cannot be read";
  int dimensions = 0, variables = 0;
  check(netcdf().nc_inq(handle_->id, &dimensions, &variables, nullptr, nullptr), name_, what);
  std::vector<int> ids(static_cast<std::size_t>(dimensions));
  check(netcdf().nc_inq_dimids(handle_->id, &dimensions, ids.data(), 0), name_, what);
  std::array<char, NC_MAX_NAME + 1> name{};
  for (const int id : ids) {
    std::size_t length = 0;
    check(netcdf().nc_inq_dim(handle_->id, id, name.data(), &length), name_, what);
    dimensions_.push_back({name.data(), length});
  }
  for (int id = 0; id < variables; ++id) {
    NetcdfVariable variable;
    variable.id = id;
    nc_type type = 0;
    int rank = 0, attributes = 0;
    std::array<int, NC_MAX_VAR_DIMS> along{};
    check(netcdf().nc_inq_varndims(handle_->id, id, &rank), name_, what);
    if (rank > NC_MAX_VAR_DIMS) throw GridFileError(fmt::format("{} has a variable with {} dimensions", name_, rank));
    check(netcdf().nc_inq_var(handle_->id, id, name.data(), &type, &rank, along.data(), &attributes), name_, what);
    variable.name = name.data();
    variable.holds_numbers = holds_numbers(type);
    variable.is_single = type == NC_FLOAT;
    variable.is_byte = type == NC_BYTE || type == NC_UBYTE;
    for (int k = 0; k < rank; ++k) {
      const auto at = std::find(ids.begin(), ids.end(), along[static_cast<std::size_t>(k)]);
      if (at == ids.end())
        throw GridFileError(fmt::format("{} {}: a dimension of {} is none", name_, what, name.data()));
      variable.dimensions.push_back(static_cast<std::size_t>(at - ids.begin()));
    }
    for (int index = 0; index < attributes; ++index)
      variable.attributes.push_back(handle_->attribute(name_, id, index));
    if (variable.text("_Unsigned") == "true" && (type == NC_BYTE || type == NC_SHORT || type == NC_INT))
      variable.unsigned_span = std::ldexp(1.0, static_cast<int>(8 * bytes_of(type)));
    variables_.push_back(std::move(variable));
  }
  check_is_whole(file);
}

NetcdfFile::~NetcdfFile() = default;

namespace {

double padded(double bytes) { return 4 * std::ceil(bytes / 4); }

/// Bytes of the header of a classic file, without what is left free behind it.
class Header {
 public:
  Header(int file, int format)
      : file_(file), count_(format == NC_FORMAT_CDF5 ? 8 : 4), offset_(format == NC_FORMAT_CLASSIC ? 4 : 8) {}

  double bytes(const std::vector<NetcdfDimension>& dimensions, const std::vector<NetcdfVariable>& variables) const {
    double all = 4 + count_ + 3 * list();
    for (const NetcdfDimension& dimension : dimensions) all += name(dimension.name) + count_;
    int global = 0;
    netcdf().nc_inq_natts(file_, &global);
    all += attributes(NC_GLOBAL, global);
    for (const NetcdfVariable& variable : variables)
      all += name(variable.name) + count_ * static_cast<double>(2 + variable.dimensions.size()) + list() +
             attributes(variable.id, static_cast<int>(variable.attributes.size())) + 4 + offset_;
    return all;
  }

 private:
  double list() const { return 4 + count_; }
  double name(const std::string& text) const { return count_ + padded(static_cast<double>(text.size())); }
  double attributes(int variable, int number) const {
    double all = 0;
    std::array<char, NC_MAX_NAME + 1> text{};
    for (int i = 0; i < number; ++i) {
      nc_type type = 0;
      std::size_t length = 0;
      if (netcdf().nc_inq_attname(file_, variable, i, text.data()) != NC_NOERR ||
          netcdf().nc_inq_att(file_, variable, text.data(), &type, &length) != NC_NOERR)
        continue;
      all += name(text.data()) + 4 + count_ + padded(static_cast<double>(length * bytes_of(type)));
    }
    return all;
  }

  int file_;
  double count_, offset_;
};

}  // namespace

// The library reads zeros behind the end of a classic file. HDF5 complains itself.
void NetcdfFile::check_is_whole(const std::filesystem::path& file) const {
  int format = 0, unlimited = -1;
  check(netcdf().nc_inq_format(handle_->id, &format), name_, "cannot be read");
  if (format == NC_FORMAT_NETCDF4 || format == NC_FORMAT_NETCDF4_CLASSIC) return;
  check(netcdf().nc_inq_unlimdim(handle_->id, &unlimited), name_, "cannot be read");
  double fixed = 0, padded_record = 0, record = 0, records = 0;
  int of_records = 0;
  for (const NetcdfVariable& variable : variables_) {
    nc_type type = 0;
    check(netcdf().nc_inq_vartype(handle_->id, variable.id, &type), name_, "cannot be read");
    auto bytes = static_cast<double>(bytes_of(type));
    bool grows = false;
    for (const std::size_t k : variable.dimensions) {
      if (static_cast<int>(k) == unlimited) {
        grows = true;
        records = static_cast<double>(dimensions_[k].length);
      } else {
        bytes *= static_cast<double>(dimensions_[k].length);
      }
    }
    if (grows)
      padded_record += padded(bytes), record += bytes, ++of_records;
    else
      fixed += padded(bytes);
  }
  const double needed = Header(handle_->id, format).bytes(dimensions_, variables_) + fixed +
                        records * (of_records == 1 ? record : padded_record);
  const auto there = static_cast<double>(std::filesystem::file_size(file));
  if (there < needed - 3)  // the last bytes may be padding
    throw GridFileError(
        fmt::format("{} is cut off: it has {:.0f} bytes, and its variables need {:.0f}", name_, there, needed),
        "copy the file again");
}

std::vector<double> NetcdfFile::read(const NetcdfVariable& variable, const std::vector<std::size_t>& start,
                                     const std::vector<std::size_t>& count) const {
  double numbers = 1;
  for (const std::size_t length : count) numbers *= static_cast<double>(length);
  if (numbers > most_numbers)
    throw GridFileError(fmt::format("{} has {:.3g} numbers in \"{}\"; at most {:.3g} are read at once", name_, numbers,
                                    variable.name, most_numbers),
                        "leave points out");
  std::vector<double> values(static_cast<std::size_t>(numbers));
  if (values.empty()) return values;
  const std::lock_guard<std::mutex> lock(one_at_a_time());
  const int status = netcdf().nc_get_vara_double(handle_->id, variable.id, start.data(), count.data(), values.data());
  if (status != NC_ERANGE)  // of the numbers one is beyond doubles; none is
    check(status, name_, fmt::format("cannot be read at \"{}\"", variable.name));
  return values;
}

std::vector<double> NetcdfFile::read_all(const NetcdfVariable& variable) const {
  return read(variable, {0}, {dimensions_[variable.dimensions.at(0)].length});
}

double NetcdfFile::usual_fill(const NetcdfVariable& variable) const {
  nc_type type = 0;
  const std::lock_guard<std::mutex> lock(one_at_a_time());
  check(netcdf().nc_inq_vartype(handle_->id, variable.id, &type), name_, "cannot be read");
  switch (type) {
    case NC_SHORT:
      return NC_FILL_SHORT;
    case NC_USHORT:
      return NC_FILL_USHORT;
    case NC_INT:
      return NC_FILL_INT;
    case NC_UINT:
      return NC_FILL_UINT;
    case NC_INT64:
      return static_cast<double>(NC_FILL_INT64);
    case NC_UINT64:
      return static_cast<double>(NC_FILL_UINT64);
    case NC_FLOAT:
      return static_cast<double>(NC_FILL_FLOAT);
    case NC_DOUBLE:
      return NC_FILL_DOUBLE;
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace gaussdrift::read
