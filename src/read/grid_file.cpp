#include "read/grid_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "read/file_bytes.hpp"
#include "read/matrix.hpp"
#include "read/netcdf/netcdf_grid.hpp"
#include "read/stored_grid.hpp"
#include "read/vector_names.hpp"

namespace gaussdrift::read {

namespace {

std::string name_of(const std::filesystem::path& file) { return file.filename().string(); }

constexpr const char* resampling =
    "ParaView opens the file: apply its filter Resample To Image and save the data as .vti";

StoredGrid open_grid(const std::filesystem::path& file) {
  check_readable(file);
  if (const std::string kind = file.extension().string();
      kind != ".vti" && kind != ".vtr" && kind != ".vts" && kind != ".pvti" && kind != ".vtk") {
    const std::string way = way_to_read(file);
    throw GridFileError(
        kind == ".pvd" ? fmt::format("{} is a series of files; one file is needed here", name_of(file))
        : kind.empty() ? fmt::format("{} has no ending", name_of(file))
                       : fmt::format("{} has the ending \"{}\"", name_of(file), kind),
        fmt::format("{}known files: .vti and .pvti (image data), .vtr (rectilinear grid), .vts (structured grid), "
                    ".vtk (legacy, the first two), .pvd (a series of these); for a velocity or density of a case also "
                    ".nc (NetCDF)",
                    way.empty() ? "" : way + "; "));
  }
  return StoredGrid(file);
}

std::string with_components(const ArrayInfo& array) {
  return fmt::format("\"{}\" ({}{})", array.name,
                     array.components == 1 ? "1 component" : fmt::format("{} components", array.components),
                     array.on_cells ? ", of cells" : "");
}

/// Arrays of one component that could be those of a vector, by the names that are usual.
std::vector<std::string> parts_of_a_vector(const std::vector<ArrayInfo>& arrays, std::size_t count) {
  std::vector<std::string> scalars;
  for (const ArrayInfo& array : arrays)
    if (array.components == 1) scalars.push_back(array.name);
  if (std::vector<std::string> usual = usual_components(scalars, count); !usual.empty()) return usual;
  return scalars.size() == count ? scalars : std::vector<std::string>{};
}

/// Suggests what could be written instead.
std::string array_remedy(const std::vector<ArrayInfo>& arrays, const GridRequest& request) {
  for (const ArrayInfo& array : arrays)
    if (array.components >= request.least_components && array.components <= request.most_components)
      return fmt::format("for example \"{}\"", array.name);
  if (const auto parts = parts_of_a_vector(arrays, request.least_components);
      request.least_components > 1 && !parts.empty())
    return fmt::format("arrays = {} takes the components from arrays of their own", in_brackets(parts));
  return "";
}

/// The arrays that are asked for. Throws if they do not exist or do not fit.
std::vector<ArrayInfo> chosen(const StoredGrid& grid, const std::filesystem::path& file, const GridRequest& request) {
  std::vector<ArrayInfo> arrays = grid.arrays();
  if (!request.mask.empty() && request.arrays.empty())
    std::erase_if(arrays, [&](const ArrayInfo& array) { return array.name == request.mask; });
  constexpr std::size_t most_shown = 20;
  std::vector<std::string> shown;
  for (std::size_t i = 0; i < std::min(arrays.size(), most_shown); ++i) shown.push_back(with_components(arrays[i]));
  if (arrays.size() > most_shown) shown.push_back(fmt::format("and {} more", arrays.size() - most_shown));
  const std::string list =
      shown.empty() ? "it has no arrays with names" : fmt::format("it has {}", fmt::join(shown, ", "));
  if (request.arrays.empty()) {
    if (arrays.size() == 1 && arrays[0].components >= request.least_components &&
        arrays[0].components <= request.most_components)
      return {arrays[0]};
    if (arrays.size() != 1)
      throw GridFileError(
          fmt::format("{} does not have exactly one array; say which one is meant: {}", name_of(file), list),
          array_remedy(arrays, request));
  }
  std::vector<ArrayInfo> found;
  const std::vector<std::string> names = request.arrays.empty() ? std::vector{arrays[0].name} : request.arrays;
  for (const std::string& name : names) {
    const auto same = [&](bool cells) {
      return std::find_if(arrays.begin(), arrays.end(),
                          [&](const ArrayInfo& array) { return array.name == name && array.on_cells == cells; });
    };
    auto array = same(false);
    if (array == arrays.end()) array = same(true);
    if (array == arrays.end())
      throw GridFileError(fmt::format("{} has no array \"{}\"; {}", name_of(file), name, list),
                          array_remedy(arrays, request));
    found.push_back(*array);
  }
  std::size_t components = 0;
  for (const ArrayInfo& array : found) {
    components += array.components;
    if (found.size() > 1 && array.components != 1)
      throw GridFileError(fmt::format("the array \"{}\" of {} has {} components, needed: 1 of each of several arrays",
                                      array.name, name_of(file), array.components));
    if (array.on_cells != found[0].on_cells)
      throw GridFileError(fmt::format("of {}, \"{}\" belongs to cells and \"{}\" to points", name_of(file),
                                      (array.on_cells ? array : found[0]).name,
                                      (array.on_cells ? found[0] : array).name));
  }
  if (components < request.least_components || components > request.most_components)
    throw GridFileError(
        fmt::format("the array{} {} of {} {} {} component{}, needed: {}", found.size() > 1 ? "s" : "",
                    found.size() > 1 ? in_brackets(names) : fmt::format("\"{}\"", names[0]), name_of(file),
                    found.size() > 1 ? "have" : "has", components, components == 1 ? "" : "s",
                    request.least_components == request.most_components
                        ? fmt::format("{}", request.least_components)
                        : fmt::format("{} or {}", request.least_components, request.most_components)),
        array_remedy(arrays, request));
  return found;
}

/// The mask, which lies where the arrays do.
ArrayInfo chosen_mask(const StoredGrid& grid, const std::filesystem::path& file, const GridRequest& request,
                      bool on_cells) {
  const ArrayInfo* other = nullptr;
  for (const ArrayInfo& array : grid.arrays()) {
    if (array.name != request.mask) continue;
    if (array.on_cells == on_cells && array.components == 1) return array;
    other = &array;
  }
  if (!other) throw GridFileError(fmt::format("{} has no array \"{}\", which mask names", name_of(file), request.mask));
  throw GridFileError(fmt::format("the mask of {} is {}, and the data belong to {}", name_of(file),
                                  with_components(*other), on_cells ? "cells" : "points"),
                      "a mask has one component, at the same places as the data");
}

void check_shape(const StoredGrid& grid, const std::filesystem::path& file, int dimension) {
  const auto& points = grid.points();
  const bool flat = points[2] == 1;
  std::string thin;
  for (int k = 0; k < dimension; ++k)
    if (points[static_cast<std::size_t>(k)] == 1) thin = fmt::format(": 1 point along {} is no grid", "xyz"[k]);
  if (!thin.empty() || (dimension == 2 && !flat))
    throw GridFileError(fmt::format("the grid of {} has {} x {} x {} points, but the domain has {} dimensions{}",
                                    name_of(file), points[0], points[1], points[2], dimension,
                                    dimension == 3 && flat && points[0] > 1 && points[1] > 1 ? "" : thin),
                        dimension == 2
                            ? "a 2D grid lies in the plane of x and y: it has 1 point along z, and at least 2 "
                              "along x and y; ParaView's filter Extract Subset takes a layer out"
                            : "a 3D grid has at least 2 points along each axis");
}

/// Where the numbers of the file go: axes ascend, and data of cells stand at their middles.
struct Layout {
  std::array<std::vector<double>, max_dimension> axis;
  std::array<std::vector<std::size_t>, max_dimension> from;  // index along the axis of the file
  std::array<std::size_t, max_dimension> length{1, 1, 1};    // of the axis of the file
  std::array<double, max_dimension> rounding{};

  std::size_t source(std::size_t point, int dimension) const {
    std::size_t index = 0, stride = 1;
    for (int k = 0; k < dimension; ++k) {
      index += from[k][point % axis[k].size()] * stride;
      point /= axis[k].size();
      stride *= length[k];
    }
    return index;
  }
};

Layout layout_of(const StoredGrid& grid, int dimension, bool cells) {
  Layout layout;
  for (int k = 0; k < dimension; ++k) {
    std::vector<double> x = grid.axis(static_cast<std::size_t>(k));
    const bool descends = x.size() > 1 && x.front() > x.back();
    if (descends) std::reverse(x.begin(), x.end());
    const bool middles = cells && x.size() > 1;
    const std::size_t length = layout.length[k] = x.size() - (middles ? 1 : 0);
    auto& from = layout.from[k];
    for (std::size_t i = 0; i < length; ++i) from.push_back(descends ? length - 1 - i : i);
    if (middles) {
      auto& axis = layout.axis[k];
      axis.push_back(x.front());
      for (std::size_t i = 0; i < length; ++i) axis.push_back(x[i] + (x[i + 1] - x[i]) / 2);
      axis.push_back(x.back());
      from.insert(from.begin(), from.front());
      from.push_back(from.back());
    } else {
      layout.axis[k] = x;
    }
    double narrowest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < x.size(); ++i) narrowest = std::min(narrowest, x[i] - x[i - 1]);
    layout.rounding[k] = std::min(grid.rounding(static_cast<std::size_t>(k)), narrowest / 10);
  }
  return layout;
}

/// "u", or "[u, v]".
std::string title_of(const std::vector<ArrayInfo>& arrays) {
  std::vector<std::string> names;
  for (const ArrayInfo& array : arrays) names.push_back(array.name);
  return names.size() == 1 ? names[0] : fmt::format("[{}]", fmt::join(names, ", "));
}

/// Coordinates that differ by no more than they are rounded are the same.
bool same_grid(const GridData& a, const Layout& b) {
  for (int k = 0; k < a.dimension; ++k) {
    if (a.axis[k].size() != b.axis[k].size()) return false;
    for (std::size_t i = 0; i < a.axis[k].size(); ++i)
      if (!(std::abs(a.axis[k][i] - b.axis[k][i]) <= a.rounding[k] + b.rounding[k])) return false;
  }
  return true;
}

}  // namespace

std::string way_to_read(const std::filesystem::path& file) {
  std::string kind = file.extension().string();
  if (kind.empty()) kind = file.filename().string();
  if (!kind.empty() && kind[0] == '.') kind.erase(0, 1);
  std::transform(kind.begin(), kind.end(), kind.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* name) { return kind == name; });
  };
  if (is({"grib", "grb", "grib2", "h5", "hdf", "hdf5"})) return resampling;
  if (is({"png", "jpg", "jpeg", "tif", "tiff", "bmp", "gif"}))
    return "ParaView opens the picture as image data: save it as .vti, with the coordinates that its pixels should "
           "have";
  if (is({"vtu", "vtp", "vtm", "pvtr", "pvts", "pvtu", "xmf", "xdmf", "foam", "case", "vtkhdf"})) return resampling;
  if (is({"csv", "txt", "dat"})) return "scattered points of a velocity are read from a table by gaussians = \"...\"";
  return "";
}

GridSnapshot read_snapshot(const std::filesystem::path& file, const std::string& array,
                           std::optional<std::size_t> component) {
  if (file.extension() == ".vts")
    throw GridFileError(
        fmt::format("{} is a curvilinear grid, which is read only as a velocity or density of a case", name_of(file)),
        resampling);
  StoredGrid grid = open_grid(file);
  const std::vector<ArrayInfo> arrays = chosen(grid, file, {.arrays = {array}, .most_components = 3});
  grid.load(arrays);
  GridSnapshot result;
  result.components = arrays[0].components;
  if (component && *component >= result.components)
    throw GridFileError(fmt::format("\"{}\" of {} has {} components", array, name_of(file), result.components), "");
  result.dimension = grid.points()[2] > 1 ? 3 : 2;
  Layout layout = layout_of(grid, result.dimension, arrays[0].on_cells);
  std::size_t points = 1;
  for (int k = 0; k < result.dimension; ++k) points *= layout.axis[k].size();
  result.values.resize(points);
  for (std::size_t p = 0; p < points; ++p) {
    const double* value = &grid.values()[0].numbers[layout.source(p, result.dimension) * result.components];
    if (component || result.components == 1)
      result.values[p] = value[component.value_or(0)];
    else
      result.values[p] = std::hypot(value[0], value[1], result.components > 2 ? value[2] : 0);
  }
  result.axis = std::move(layout.axis);
  if (const double time = grid.time(); std::isfinite(time)) result.time = time;
  result.sphere = grid.sphere();
  return result;
}

namespace {

/// Throws GridFileError if so many numbers at every point of so many such grids are more than is read.
void check_size(const StoredGrid& grid, std::size_t components, std::size_t times, const std::filesystem::path& file) {
  double numbers = double(components) * double(times);
  for (const std::size_t length : grid.points()) numbers *= static_cast<double>(length);
  if (numbers > most_numbers)
    throw GridFileError(fmt::format("{} holds {:.3g} numbers at {} times; at most {:.3g} are read", name_of(file),
                                    numbers, times, most_numbers),
                        "leave times or points out");
}

/// What a grid holds in the order of the result, whose axes are known: the numbers of all points, and which are hidden.
/// With a mask that is the last array.
std::pair<std::vector<double>, std::vector<std::uint8_t>> in_order(const StoredGrid& grid, const Layout& layout,
                                                                   bool on_cells, const GridData& result,
                                                                   bool has_mask) {
  std::vector<double> values(result.points() * result.components);
  const std::size_t arrays = grid.values().size() - (has_mask ? 1 : 0);
  const std::vector<std::uint8_t>& mask = grid.hidden(on_cells);
  std::vector<std::uint8_t> hides(mask.empty() ? 0 : result.points());
  for (std::size_t p = 0; p < result.points(); ++p) {
    const std::size_t source = layout.source(p, result.dimension);
    double* at = values.data() + p * result.components;
    for (std::size_t i = 0; i < arrays; ++i) {
      const std::size_t count = arrays == 1 ? result.components : 1;
      at = std::copy_n(grid.values()[i].numbers.data() + source * count, count, at);
    }
    if (!hides.empty()) hides[p] = mask[source];
  }
  return {std::move(values), std::move(hides)};
}

/// The same of the points that the mask names, the last array.
std::vector<std::uint8_t> land_in_order(const StoredGrid& grid, const Layout& layout, const GridData& result,
                                        const GridRequest& request, const std::filesystem::path& file) {
  std::vector<double> numbers(result.points());
  for (std::size_t p = 0; p < numbers.size(); ++p)
    numbers[p] = grid.values().back().numbers[layout.source(p, result.dimension)];
  return points_on_land(numbers, request.mask_is == MaskIs::land, fmt::format("{} of {}", request.mask, name_of(file)));
}

}  // namespace

namespace {

/// The places of a curvilinear grid; nothing of other grids.
std::shared_ptr<const CurvedGrid> curved_grid(const StoredGrid& grid, const std::filesystem::path& file, bool cells,
                                              const GridRequest& request) {
  const std::vector<double>& all = grid.places();
  if (all.empty()) return nullptr;
  if (cells)
    throw GridFileError(fmt::format("{} has its values on the cells of a curvilinear grid", name_of(file)),
                        "ParaView's filter Cell Data to Point Data brings them to its points");
  const auto d = static_cast<std::size_t>(request.dimension);
  std::vector<double> places;
  places.reserve(all.size() / 3 * d);
  for (std::size_t i = 0; i < all.size(); i += 3) {
    if (d == 2 && std::abs(all[i + 2] - all[2]) > 2 * grid.rounding_of_places())
      throw GridFileError(fmt::format("the points of {} are no plane: z is {} at point 1 and {} at point {}",
                                      name_of(file), all[2], all[i + 2], i / 3 + 1),
                          "a 2D grid lies in a plane of x and y");
    places.insert(places.end(), all.begin() + static_cast<std::ptrdiff_t>(i),
                  all.begin() + static_cast<std::ptrdiff_t>(i + d));
  }
  try {
    return std::make_shared<const CurvedGrid>(request.dimension, grid.points(), std::move(places),
                                              grid.rounding_of_places());
  } catch (const std::invalid_argument& error) {
    throw GridFileError(fmt::format("of the grid of {} {}", name_of(file), error.what()),
                        "every place must lie in one cell: leave those cells out, or put the points in order; a polar "
                        "grid begins at a radius above 0");
  }
}

}  // namespace

bool is_netcdf(const std::filesystem::path& file) {
  const std::string kind = file.extension().string();
  return kind == ".nc" || kind == ".nc4" || kind == ".cdf" || kind == ".netcdf";
}

namespace {

/// The files of a series, those that are there and count.
std::vector<SeriesEntry> entries_of(const std::filesystem::path& file, const GridRequest& request, GridData& result) {
  if (file.extension() != ".pvd") return {{file, 0, 0}};
  const std::vector<SeriesEntry> all = read_series(file, request.duplicates == Duplicates::error);
  std::vector<Stamp> stamps;
  std::size_t left_out = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::error_code error; !std::filesystem::exists(all[i].file, error)) {
      if (request.gaps != Gaps::bridge)
        throw GridFileError(fmt::format("there is no file {}, which line {} of {} names for t = {}",
                                        all[i].file.string(), all[i].line, name_of(file), all[i].time),
                            "paths in a series are relative to its folder");
      ++left_out;
      continue;
    }
    stamps.push_back({all[i].time, fmt::format("t = {}", all[i].time), i, 0});
  }
  if (stamps.empty()) throw GridFileError(fmt::format("no file that {} names is there", name_of(file)));
  settle_duplicates(stamps, request.duplicates, name_of(file));
  look_for_gaps(stamps, request.gaps, name_of(file), result.warnings);
  std::vector<SeriesEntry> entries;
  for (const Stamp& stamp : stamps) entries.push_back(all[stamp.file]);
  if (left_out > 0)
    result.clock = fmt::format("{} snapshot{} left out that {} not there", left_out, left_out == 1 ? "" : "s",
                               left_out == 1 ? "is" : "are");
  return entries;
}

/// The times of a series of ParaView are numbers without a unit.
void set_clock(GridData& data, const SceneClock& clock, const std::string& name) {
  if (!clock.start.empty())
    throw GridFileError(fmt::format("{} has no dates, and time.start is \"{}\"", name, clock.start),
                        "time = { start = NUMBER } names a time as the file has it");
  if (!clock.unit.empty())
    throw GridFileError(fmt::format("the times of {} have no unit, and time.unit is \"{}\"", name, clock.unit),
                        "time = { unit = NUMBER } says how much of them is 1 in the scene");
  const double start = clock.start_number.value_or(data.times.front()), unit = clock.unit_number.value_or(1);
  for (double& time : data.times) time = (time - start) / unit;
  data.clock += fmt::format("{}t = 0 at time {:.10g} of the file", data.clock.empty() ? "" : ", ", start);
}

/// Each number is the value of a cell of the frame.
GridData in_frame(const Matrix& matrix, const Frame& frame, const std::string& name) {
  GridData data;
  data.name = name;
  data.times = {0};
  std::array<std::vector<std::size_t>, 2> from;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t cells = k == 0 ? matrix.columns : matrix.rows;
    const double length = (frame.max[k] - frame.min[k]) / static_cast<double>(cells);
    data.axis[k].push_back(frame.min[k]);
    from[k].push_back(0);
    for (std::size_t i = 0; i < cells; ++i) {
      data.axis[k].push_back(frame.min[k] + length * (static_cast<double>(i) + 0.5));
      from[k].push_back(i);
    }
    data.axis[k].push_back(frame.max[k]);
    from[k].push_back(cells - 1);
  }
  data.values.emplace_back();
  for (const std::size_t row : from[1])
    for (const std::size_t column : from[0]) data.values[0].push_back(matrix.values[row * matrix.columns + column]);
  return data;
}

std::shared_ptr<const GridData> read_matrix(const std::filesystem::path& file, const GridRequest& request) {
  const std::string name = name_of(file);
  if (request.dimension != 2)
    throw GridFileError(fmt::format("{} has two dimensions, the domain has {}", name, request.dimension));
  const bool is_picture = file.extension() == ".png";
  if (!request.arrays.empty() || !request.mask.empty())
    throw GridFileError(fmt::format("{} has no arrays with names", name), "leave array and mask out");
  auto data = std::make_shared<GridData>(
      in_frame(is_picture ? read_grey_png(file) : read_csv_matrix(file), *request.frame, name));
  std::vector<double> named;
  if (request.missing_value) named.push_back(*request.missing_value);
  settle_missing(*data, {{}}, request.missing == Missing::keep ? Marks{} : recognise_marks(*data, named, true),
                 request.missing, {name});
  return data;
}

}  // namespace

std::shared_ptr<const GridData> read_grid(const std::filesystem::path& file, const GridRequest& request) {
  if (is_netcdf(file)) return read_netcdf_grid(file, request);
  if (request.frame && (file.extension() == ".png" || file.extension() == ".csv")) return read_matrix(file, request);
  auto result = std::make_shared<GridData>();
  const std::vector<SeriesEntry> entries = entries_of(file, request, *result);
  const int dimension = result->dimension = request.dimension;
  HiddenPoints hidden;
  std::vector<std::string> names;
  std::vector<double> fills;
  if (request.missing_value) fills.push_back(*request.missing_value);
  for (const SeriesEntry& entry : entries) {
    StoredGrid grid = open_grid(entry.file);
    check_shape(grid, entry.file, dimension);
    const std::vector<ArrayInfo> arrays = chosen(grid, entry.file, request);
    std::size_t components = 0;
    for (const ArrayInfo& array : arrays) components += array.components;
    check_size(grid, components, entries.size(), file);
    const bool cells = arrays[0].on_cells, has_mask = !request.mask.empty();
    std::vector<ArrayInfo> wanted = arrays;
    if (has_mask) wanted.push_back(chosen_mask(grid, entry.file, request, cells));
    grid.load(wanted);
    Layout layout = layout_of(grid, dimension, cells);
    if (result->times.empty()) {
      result->name = fmt::format("{} of {}", title_of(arrays), name_of(file));
      result->components = components;
      result->axis = layout.axis;
      result->rounding = layout.rounding;
      result->curved = curved_grid(grid, entry.file, cells, request);
    }
    const auto curved = result->times.empty() ? result->curved : curved_grid(grid, entry.file, cells, request);
    if (components != result->components || !same_grid(*result, layout) || !curved != !result->curved ||
        (curved && !curved->same_places(*result->curved)))
      throw GridFileError(
          fmt::format("the grid of {} differs from that of {}", name_of(entry.file), name_of(entries.front().file)),
          "all times of a series share one grid");
    auto [values, hides] = in_order(grid, layout, cells, *result, has_mask);
    for (std::size_t i = 0; i < arrays.size(); ++i)
      fills.insert(fills.end(), grid.values()[i].fill_values.begin(), grid.values()[i].fill_values.end());
    if (has_mask) hides = hidden_by_either(std::move(hides), land_in_order(grid, layout, *result, request, entry.file));
    result->times.push_back(entry.time);
    result->values.push_back(std::move(values));
    hidden.push_back(std::move(hides));
    names.push_back(name_of(entry.file));
  }
  const bool keep = request.missing == Missing::keep;
  settle_missing(*result, hidden, keep ? Marks{} : recognise_marks(*result, fills, request.decays), request.missing,
                 names);
  if (result->curved && result->land)
    throw GridFileError(
        fmt::format("{} is curvilinear with {}, and land is known on other grids only", name_of(file), result->filled),
        fmt::format("missing = \"zero\" makes a coast of it; or {}", resampling));
  if (request.clock) set_clock(*result, *request.clock, name_of(file));
  return result;
}

}  // namespace gaussdrift::read
