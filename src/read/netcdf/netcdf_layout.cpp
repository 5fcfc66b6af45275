#include "read/netcdf/netcdf_layout.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <string_view>

#include "read/grid_file_error.hpp"
#include "read/stored_grid.hpp"
#include "read/vector_names.hpp"

namespace gaussdrift::read {

namespace {

constexpr std::string_view letters = "xyz";

std::string lower(std::string_view text) {
  std::string all;
  for (const char c : text) all += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return all;
}

bool among(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

enum class Role { x, y, z, time, other };

Role role_by_attributes(const NetcdfVariable& coordinate) {
  const std::string axis = lower(coordinate.text("axis"));
  if (axis == "x") return Role::x;
  if (axis == "y") return Role::y;
  if (axis == "z") return Role::z;
  if (axis == "t") return Role::time;
  const std::string standard = coordinate.text("standard_name"), units = lower(coordinate.text("units"));
  if (among(standard, {"longitude", "projection_x_coordinate", "grid_longitude"})) return Role::x;
  if (among(standard, {"latitude", "projection_y_coordinate", "grid_latitude"})) return Role::y;
  if (among(standard, {"depth", "height", "altitude", "air_pressure", "ocean_sigma_coordinate", "model_level_number"}))
    return Role::z;
  if (standard == "time" || units.find(" since ") != std::string::npos) return Role::time;
  if (among(standard, {"realization", "forecast_reference_time"})) return Role::other;
  if (among(units, {"degrees_east", "degree_east", "degree_e", "degrees_e"})) return Role::x;
  if (among(units, {"degrees_north", "degree_north", "degree_n", "degrees_n"})) return Role::y;
  if (!coordinate.text("positive").empty() || among(units, {"pa", "hpa", "mbar", "millibar", "bar"})) return Role::z;
  return Role::other;
}

Role role_by_name(std::string_view name) {
  const std::string word = lower(name);
  if (among(word, {"x", "lon", "longitude", "xc", "rlon", "nav_lon", "easting"})) return Role::x;
  if (among(word, {"y", "lat", "latitude", "yc", "rlat", "nav_lat", "northing"})) return Role::y;
  if (among(word, {"z", "depth", "lev", "level", "levels", "height", "altitude", "deptht", "depthu", "depthv", "depthw",
                   "plev", "zc"}))
    return Role::z;
  if (among(word, {"time", "t", "times", "time_counter", "ocean_time", "valid_time"})) return Role::time;
  return Role::other;
}

/// One file while it is understood.
class Reading {
 public:
  Reading(const NetcdfFile& file, const GridRequest& request) : file_(file), request_(request) {}

  NetcdfLayout layout() {
    choose_arrays();
    check_same_dimensions();
    const NetcdfVariable& array = *arrays_[0];
    for (const std::size_t k : array.dimensions) layout_.lengths.push_back(file_.dimensions()[k].length);
    layout_.start.assign(array.dimensions.size(), 0);
    find_roles();
    read_times();
    choose_layers();
    for (int k = 0; k < request_.dimension; ++k) read_axis(static_cast<std::size_t>(k));
    if (request_.dimension == 3) find_direction_of_depth();
    if (!request_.mask.empty()) layout_.mask = netcdf_mask(file_, layout_, request_);
    double points = 1;
    for (const NetcdfAxis& axis : layout_.axes) points *= static_cast<double>(axis.points.size());
    if (points * static_cast<double>(arrays_.size()) > most_numbers)
      throw GridFileError(fmt::format("{} has {:.3g} points at a time; at most {:.3g} numbers are read", file_.name(),
                                      points, most_numbers),
                          "leave points out");
    return std::move(layout_);
  }

 private:
  std::string dimension_name(std::size_t k) const { return file_.dimensions()[k].name; }

  /// "u" (time x lat x lon)
  std::string shown(const NetcdfVariable& variable) const {
    std::vector<std::string> names;
    for (const std::size_t k : variable.dimensions) names.push_back(dimension_name(k));
    return fmt::format("\"{}\" ({})", variable.name, fmt::join(names, " x "));
  }

  bool is_coordinate(const NetcdfVariable& variable) const {
    if (variable.dimensions.size() == 1 && dimension_name(variable.dimensions[0]) == variable.name) return true;
    const auto names_it = [&](const std::string& list) {
      return (" " + list + " ").find(" " + variable.name + " ") != std::string::npos;
    };
    return std::any_of(file_.variables().begin(), file_.variables().end(), [&](const NetcdfVariable& other) {
      return names_it(other.text("coordinates")) || names_it(other.text("bounds")) ||
             names_it(other.text("climatology"));
    });
  }

  /// Arrays that may be meant.
  std::vector<const NetcdfVariable*> candidates() const {
    std::vector<const NetcdfVariable*> some;
    for (const NetcdfVariable& variable : file_.variables())
      if (variable.holds_numbers && variable.dimensions.size() >= static_cast<std::size_t>(request_.dimension) &&
          !is_coordinate(variable) && variable.name != request_.mask)
        some.push_back(&variable);
    return some;
  }

  std::string list_of_candidates() const {
    std::vector<std::string> names;
    const auto some = candidates();
    constexpr std::size_t most_shown = 20;
    for (std::size_t i = 0; i < std::min(some.size(), most_shown); ++i) names.push_back(shown(*some[i]));
    if (some.size() > most_shown) names.push_back(fmt::format("and {} more", some.size() - most_shown));
    return names.empty() ? "it has no arrays on a grid" : fmt::format("it has {}", fmt::join(names, ", "));
  }

  /// Where a case names none: the only one, or those whose names say that they are a velocity.
  std::vector<std::string> meant() const {
    const auto some = candidates();
    std::vector<std::string> names, standard;
    for (const NetcdfVariable* variable : some) {
      names.push_back(variable->name);
      standard.push_back(variable->text("standard_name"));
    }
    const std::size_t count = request_.least_components;
    if (count == 1) return some.size() == 1 ? names : std::vector<std::string>{};
    std::vector<std::string> found;
    for (const std::string& name : usual_standard_names(standard, count)) {
      if (std::count(standard.begin(), standard.end(), name) != 1) return {};
      found.push_back(
          names[static_cast<std::size_t>(std::find(standard.begin(), standard.end(), name) - standard.begin())]);
    }
    return found.empty() ? usual_components(names, count) : found;
  }

  void choose_arrays() {
    const std::vector<std::string> names = request_.arrays.empty() ? meant() : request_.arrays;
    const std::string example =
        request_.least_components == 1
            ? "array = \"...\" names it"
            : fmt::format("arrays = {} names the components",
                          request_.least_components == 2 ? "[\"u\", \"v\"]" : "[\"u\", \"v\", \"w\"]");
    if (names.empty())
      throw GridFileError(
          fmt::format("{} does not say by names which array is meant; {}", file_.name(), list_of_candidates()),
          example);
    for (const std::string& name : names) {
      const NetcdfVariable* array = file_.find(name);
      if (!array || !array->holds_numbers)
        throw GridFileError(fmt::format("{} has no array \"{}\"{}; {}", file_.name(), name, array ? " of numbers" : "",
                                        list_of_candidates()),
                            example);
      arrays_.push_back(array);
      layout_.arrays.push_back(name);
      layout_.units.push_back(array->text("units"));
      layout_.signs.push_back(1);
    }
    if (names.size() < request_.least_components || names.size() > request_.most_components)
      throw GridFileError(
          fmt::format("{} array{} of {} {} named, needed: {}", names.size(), names.size() == 1 ? "" : "s", file_.name(),
                      names.size() == 1 ? "is" : "are", request_.least_components),
          example);
  }

  void check_same_dimensions() const {
    for (const NetcdfVariable* array : arrays_)
      if (array->dimensions != arrays_[0]->dimensions)
        throw GridFileError(
            fmt::format("{} has {} and {} on different grids", file_.name(), shown(*arrays_[0]), shown(*array)),
            "bring them to common points first: in a staggered grid, average them to the middles of cells");
  }

  /// The coordinates along a dimension; null where there are none.
  const NetcdfVariable* coordinate_of(std::size_t dimension) const {
    const auto lies_along = [&](const NetcdfVariable& variable) {
      return variable.holds_numbers && variable.dimensions == std::vector<std::size_t>{dimension};
    };
    if (const NetcdfVariable* same = file_.find(dimension_name(dimension)); same && lies_along(*same)) return same;
    const std::string list = " " + arrays_[0]->text("coordinates") + " ";
    for (const NetcdfVariable& variable : file_.variables())
      if (lies_along(variable) &&
          (list.find(" " + variable.name + " ") != std::string::npos || !variable.text("axis").empty()))
        return &variable;
    return nullptr;
  }

  void find_roles() {
    const auto& dimensions = arrays_[0]->dimensions;
    for (std::size_t k = 0; k < dimensions.size(); ++k) {
      const NetcdfVariable* coordinate = coordinate_of(dimensions[k]);
      Role role = coordinate ? role_by_attributes(*coordinate) : Role::other;
      if (role == Role::other && coordinate) role = role_by_name(coordinate->name);
      if (role == Role::other) role = role_by_name(dimension_name(dimensions[k]));
      coordinates_.push_back(coordinate);
      roles_.push_back(role);
    }
    for (const Role role : {Role::x, Role::y, Role::z, Role::time})
      if (std::count(roles_.begin(), roles_.end(), role) > 1)
        throw GridFileError(
            fmt::format(
                "two dimensions of {} in {} are both along {}", shown(*arrays_[0]), file_.name(),
                role == Role::time ? std::string("time") : std::string(1, letters[static_cast<std::size_t>(role)])),
            "the attribute axis = \"X\", \"Y\", \"Z\" or \"T\" of the coordinates says which is which");
    for (int k = 0; k < request_.dimension; ++k)
      if (std::find(roles_.begin(), roles_.end(), static_cast<Role>(k)) == roles_.end()) fail_without_axis(k);
  }

  [[noreturn]] void fail_without_axis(int k) const {
    const char letter = letters[static_cast<std::size_t>(k)];
    for (const NetcdfVariable& variable : file_.variables()) {
      const Role role = role_by_attributes(variable);
      if (variable.dimensions.size() == 2 &&
          (role == static_cast<Role>(k) || role_by_name(variable.name) == static_cast<Role>(k)))
        throw GridFileError(fmt::format("{} lies on a curvilinear grid: its coordinates {} depend on two dimensions",
                                        file_.name(), shown(variable)),
                            "bring it to a grid with straight axes first, as by: cdo remapbil,r720x360 in.nc out.nc");
    }
    throw GridFileError(
        fmt::format("no dimension of {} in {} is known to be along {}", shown(*arrays_[0]), file_.name(), letter),
        fmt::format("the coordinates need axis = \"{}\", a standard_name, units, or the name {}; as by: ncatted -a "
                    "axis,NAME,c,c,{} in.nc",
                    static_cast<char>(std::toupper(letter)), letter, static_cast<char>(std::toupper(letter))));
  }

  void read_times() {
    const auto at = std::find(roles_.begin(), roles_.end(), Role::time);
    const NetcdfVariable* coordinate = nullptr;
    if (at != roles_.end()) {
      layout_.time = static_cast<std::size_t>(at - roles_.begin());
      coordinate = coordinates_[*layout_.time];
      const std::size_t length = layout_.lengths[*layout_.time];
      if (length == 0) throw GridFileError(fmt::format("{} has no snapshot: its time has length 0", file_.name()));
      if (!coordinate && length > 1)
        throw GridFileError(fmt::format("{} has {} snapshots, and no variable with their times", file_.name(), length));
    } else {
      for (const NetcdfVariable& variable : file_.variables())  // a time of the whole file
        if (variable.dimensions.empty() && variable.holds_numbers &&
            (role_by_attributes(variable) == Role::time || role_by_name(variable.name) == Role::time))
          coordinate = &variable;
    }
    if (!coordinate) {
      layout_.times = {0};
      return;
    }
    layout_.times = coordinate->dimensions.empty() ? file_.read(*coordinate, {}, {}) : file_.read_all(*coordinate);
    unpack(*coordinate, layout_.times);
    for (std::size_t i = 0; i < layout_.times.size(); ++i) {
      if (!std::isfinite(layout_.times[i]) || layout_.times[i] == file_.usual_fill(*coordinate))
        throw GridFileError(fmt::format("snapshot {} of {} has no time", i + 1, file_.name()));
      if (i > 0 && layout_.times[i] < layout_.times[i - 1])
        throw GridFileError(fmt::format("the times of {} do not ascend: {} after {}", file_.name(), layout_.times[i],
                                        layout_.times[i - 1]));
    }
    layout_.time_units = coordinate->text("units");
    const std::string calendar = coordinate->text("calendar");
    const auto known = find_calendar(calendar);
    if (!known)
      throw GridFileError(fmt::format("{} has the calendar \"{}\"", file_.name(), calendar),
                          "known calendars: standard, gregorian, proleptic_gregorian, noleap, 365_day, 360_day");
    layout_.calendar = *known;
    layout_.clock = read_time_units(layout_.time_units, layout_.calendar);
    if (!layout_.clock && layout_.time_units.find(" since ") != std::string::npos)
      throw GridFileError(
          fmt::format("{} has times in \"{}\", which is not understood", file_.name(), layout_.time_units),
          "known: days, hours, minutes, seconds or milliseconds since a date of the calendar, as \"hours since "
          "2000-01-01 00:00\". Months and years have no one length");
  }

  static void unpack(const NetcdfVariable& variable, std::vector<double>& numbers) {
    const auto number = [&](const char* name, double usual) {
      const NetcdfAttribute* attribute = variable.find(name);
      return attribute && attribute->numbers.size() == 1 ? attribute->numbers[0] : usual;
    };
    const double scale = number("scale_factor", 1), offset = number("add_offset", 0);
    if (scale == 1 && offset == 0) return;
    for (double& value : numbers) value = value * scale + offset;
  }

  /// Along dimensions that are no axis of the grid one layer is read.
  void choose_layers() {
    std::optional<std::size_t> thick;
    for (std::size_t k = 0; k < roles_.size(); ++k) {
      const bool is_axis = roles_[k] == Role::time || static_cast<int>(roles_[k]) < request_.dimension;
      if (is_axis || layout_.lengths[k] == 1) continue;
      if (layout_.lengths[k] == 0)
        throw GridFileError(
            fmt::format("{} has no values: a dimension of {} has length 0", file_.name(), shown(*arrays_[0])));
      if (thick)
        throw GridFileError(fmt::format("{} of {} has two dimensions of several layers besides the grid and its time",
                                        shown(*arrays_[0]), file_.name()),
                            "take a layer out first, as by: ncks -d level,0 in.nc out.nc");
      thick = k;
    }
    if (!thick) {
      if (request_.level)
        throw GridFileError(
            fmt::format("{} has one layer only, and level = {} chooses one", file_.name(), *request_.level),
            "leave level out");
      return;
    }
    const std::size_t count = layout_.lengths[*thick];
    std::vector<double> levels(count);
    const NetcdfVariable* coordinate = coordinates_[*thick];
    if (coordinate) {
      levels = file_.read_all(*coordinate);
      unpack(*coordinate, levels);
    } else {
      for (std::size_t i = 0; i < count; ++i) levels[i] = static_cast<double>(i);
    }
    const std::string what = dimension_name(arrays_[0]->dimensions[*thick]);
    std::vector<std::string> some;
    for (std::size_t i = 0; i < std::min<std::size_t>(count, 8); ++i) some.push_back(fmt::format("{:.7g}", levels[i]));
    const std::string list = fmt::format("{}{}", fmt::join(some, ", "), count > 8 ? ", ..." : "");
    if (!request_.level)
      throw GridFileError(fmt::format("{} has {} layers along {}, and the domain has {} dimensions", file_.name(),
                                      count, what, request_.dimension),
                          fmt::format("level = {} takes the first one; {} is one of {}", some[0], what, list));
    for (std::size_t i = 0; i < count; ++i)
      if (std::abs(levels[i] - *request_.level) <= 1e-6 * std::abs(levels[i])) {
        layout_.start[*thick] = i;
        return;
      }
    throw GridFileError(fmt::format("{} has no layer {} along {}", file_.name(), *request_.level, what),
                        fmt::format("{} is one of {}", what, list));
  }

  void read_axis(std::size_t k) {
    const auto along =
        static_cast<std::size_t>(std::find(roles_.begin(), roles_.end(), static_cast<Role>(k)) - roles_.begin());
    const NetcdfVariable* coordinate = coordinates_[along];
    const std::string name = dimension_name(arrays_[0]->dimensions[along]);
    if (!coordinate)
      throw GridFileError(fmt::format("{} has no coordinates along {}", file_.name(), name),
                          fmt::format("a variable {}({}) holds them", name, name));
    NetcdfAxis axis{name, coordinate->text("units"), file_.read_all(*coordinate), false, 0, along};
    unpack(*coordinate, axis.points);
    std::vector<double>& x = axis.points;
    if (x.size() < 2)
      throw GridFileError(fmt::format("the grid of {} has {} point along {}", file_.name(), x.size(), letters[k]),
                          "a grid has at least 2 points along each axis");
    if (k == 2 && lower(coordinate->text("positive")) == "down")
      for (double& z : x) z = -z;
    axis.descends = x[1] < x[0];
    if (axis.descends) std::reverse(x.begin(), x.end());
    double largest = 0, narrowest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!std::isfinite(x[i]))
        throw GridFileError(fmt::format("the coordinates {} of {} have {}", name, file_.name(), x[i]));
      if (i > 0 && !(x[i] > x[i - 1]))
        throw GridFileError(fmt::format("the coordinates {} of {} neither ascend nor descend: {} is beside {}", name,
                                        file_.name(), x[i], x[i - 1]),
                            "longitudes that jump from 180 to -180 or from 360 to 0 are turned by: cdo "
                            "sellonlatbox,0,360,-90,90 in.nc out.nc");
      largest = std::max(largest, std::abs(x[i]));
      if (i > 0) narrowest = std::min(narrowest, x[i] - x[i - 1]);
    }
    if (coordinate->is_single)
      axis.rounding = std::min(4 * double(std::numeric_limits<float>::epsilon()) * largest, narrowest / 10);
    layout_.axes.push_back(std::move(axis));
  }

  /// A velocity along depth that counts downwards is turned with its axis.
  void find_direction_of_depth() {
    for (std::size_t c = 0; c < arrays_.size(); ++c)
      if (arrays_[c]->text("standard_name").rfind("downward", 0) == 0) layout_.signs[c] = -1;
  }

  const NetcdfFile& file_;
  const GridRequest& request_;
  std::vector<const NetcdfVariable*> arrays_, coordinates_;
  std::vector<Role> roles_;
  NetcdfLayout layout_;
};

}  // namespace

std::size_t NetcdfLayout::points() const {
  std::size_t count = 1;
  for (const NetcdfAxis& axis : axes) count *= axis.points.size();
  return count;
}

NetcdfLayout netcdf_layout(const NetcdfFile& file, const GridRequest& request) {
  return Reading(file, request).layout();
}

}  // namespace gaussdrift::read
