// Data on grids that [velocity], [density] and effects name.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/number.hpp"
#include "field/gridded/around_sphere.hpp"
#include "field/gridded/grid_data.hpp"
#include "input/data_files.hpp"
#include "input/tables/tables.hpp"
#include "read/calendar.hpp"
#include "read/grid_file.hpp"
#include "read/missing_data.hpp"

namespace gaussdrift::input {

std::vector<Key> grid_file_keys(std::string_view outside, const std::string& missing) {
  return {
      {.name = "array",
       .meaning = "name of the array in the file. It may be left out if the file has only one",
       .with = "file"},
      {.name = "interpolation",
       .type = Type::choice,
       .fallback = "linear",
       .choices = {interpolation_names.begin(), interpolation_names.end()},
       .meaning = "between grid points: `linear`, or `cubic` with continuous derivatives",
       .with = "file"},
      {.name = "time_interpolation",
       .type = Type::choice,
       .fallback = "linear",
       .choices = {interpolation_names.begin(), interpolation_names.end()},
       .meaning = "between the times of the data: `linear`, or `cubic`, by four times instead of two",
       .with = "file"},
      {.name = "time",
       .type = Type::clock,
       .meaning =
           "the clock of the scene. `start` is the date, or the time of the file, at which it shows 0: \"2020-01-03 "
           "12:00\". `unit` is its unit: \"s\", \"min\", \"h\" or \"d\", and velocities become lengths per that "
           "unit; or a number, how much of the file's time is 1, and velocities stay as written. Without `time`, "
           "NetCDF counts in its own unit from its first time, and a series of ParaView keeps its times",
       .with = "file"},
      {.name = "level",
       .type = Type::number,
       .meaning = "in NetCDF with a further dimension, such as a depth: the layer that is read, by its coordinate",
       .with = "file"},
      {.name = "outside",
       .type = Type::choice,
       .fallback = outside,
       .choices = {outside_names.begin(), outside_names.end()},
       .meaning = "what holds outside the grid: `error` stops the run there, `clamp` takes the value at the nearest "
                  "point of the surface of the grid, `zero` takes 0. Samples have the box around them, enlarged by "
                  "their spacing, in place of a grid",
       .with = "file",
       .or_with = "samples"},
      {.name = "missing",
       .type = Type::choice,
       .fallback = "error",
       .choices = {read::missing_names.begin(), read::missing_names.end() - 1},  // land: of a velocity
       .meaning = missing,
       .with = "file"},
      {.name = "missing_value",
       .type = Type::number,
       .meaning = "a number that marks missing data. The usual marks are recognised without it",
       .with = "file"},
      {.name = "mask",
       .meaning =
           "name of an array of the file that says where the data mean something: 0 is land, other numbers are water, "
           "as in most models of oceans. On land the file has no value, and `missing` says what happens there",
       .with = "file"},
      {.name = "mask_is",
       .type = Type::choice,
       .choices = {read::mask_names.begin() + 1, read::mask_names.end()},
       .meaning = "what numbers other than 0 of `mask` are. Without it they are `water`, unless the `standard_name` or "
                  "the `flag_meanings` of the mask say that they are land",
       .with = "file"},
      {.name = "gaps",
       .type = Type::choice,
       .fallback = "warn",
       .choices = {read::gaps_names.begin(), read::gaps_names.end()},
       .meaning = "what to do where a snapshot is missing in an even series: `warn`, or `error`. `bridge` interpolates "
                  "over it, also over files that a series names and that are not there, and over snapshots without any "
                  "value",
       .with = "file"},
      {.name = "duplicates",
       .type = Type::choice,
       .fallback = "error",
       .choices = {read::duplicates_names.begin(), read::duplicates_names.end()},
       .meaning = "what to do with two snapshots for one time: `error`, or take the `first` or the `last`",
       .with = "file"}};
}

Key arrays_key() {
  return {.name = "arrays",
          .type = Type::texts,
          .meaning = "names of arrays with one component each, such as `[\"u\", \"v\"]`. They replace `array`",
          .with = "file"};
}

using Kind = Value::Kind;

namespace {

/// Particles start in the whole domain, so a density must be known there.
void check_covers_domain(Reader& in, const GridData& data, const Place& place) {
  for (int k = 0; in.facts.domain_valid && k < in.facts.dimension; ++k) {
    const double least = data.axis[k].front(), most = data.axis[k].back();
    const double rounding = std::max(data.rounding[k], 1e-12 * (most - least));
    const auto axis = static_cast<std::size_t>(k);
    if (in.facts.box.min[axis] >= least - rounding && in.facts.box.max[axis] <= most + rounding) continue;
    in.diagnostics.error(
        place,
        fmt::format("{} reaches from {} to {} along {}, the domain from {} to {}", data.name,
                    base::told_apart(least, in.facts.box.min[axis]), base::told_apart(most, in.facts.box.max[axis]),
                    "xyz"[k], base::told_apart(in.facts.box.min[axis], least),
                    base::told_apart(in.facts.box.max[axis], most)),
        "outside = \"zero\" or \"clamp\" says what stands beyond the data; or make the domain smaller");
    return;
  }
}

/// What data on a curvilinear grid cannot do.
void check_curved(Reader& in, std::string_view table_name, const GridFileSpec& spec, bool is_density,
                  const Place& place) {
  if (spec.interpolation == "cubic")
    in.diagnostics.error(place,
                         fmt::format("{} is on a curvilinear grid, and interpolation = \"cubic\"", spec.data->name),
                         "interpolation = \"linear\", or resample the data to a grid along the axes");
  if (spec.outside == "clamp")
    in.diagnostics.error(place, fmt::format("{} is on a curvilinear grid, and outside = \"clamp\"", spec.data->name),
                         "outside = \"zero\" or \"error\", or resample the data to a grid along the axes");
  if (is_density && spec.outside == "error")
    in.diagnostics.error(place,
                         fmt::format("{} is on a curvilinear grid, which need not cover the domain", spec.data->name),
                         fmt::format("outside = \"zero\" in [[{}]]", table_name));
}

/// "array", or "arrays" where several have one component each.
std::vector<std::string> array_names(Reader& in, std::string_view table_name, int most_components) {
  const Entry* single = in.find(table_name, "array");
  const Entry* several = most_components > 1 ? in.find(table_name, "arrays") : nullptr;
  if (single && several) {
    in.diagnostics.error(comes_before(single->place, several->place) ? several->place : single->place,
                         fmt::format("[{}] has both \"array\" and \"arrays\"", table_name),
                         "\"array\" names one array with all components, \"arrays\" one for each");
    return {};
  }
  if (!several) {
    const std::string name = in.text(table_name, "array");
    return name.empty() ? std::vector<std::string>{} : std::vector{name};
  }
  const Key& key = find_key(table_name, "arrays");
  std::vector<std::string> names;
  for (const Value& item : several->value.items) names.push_back(item.kind == Kind::text ? item.text : "");
  if (several->value.kind != Kind::list || std::find(names.begin(), names.end(), "") != names.end()) {
    in.wrong_type(several->value, in.label_of(key), "a list of names in strings");
    return {};
  }
  if (in.facts.dimension) in.has_entries(several->value, key, "name");
  return names;
}

/// A date, or a number.
void read_start(Reader& in, const Value& value, FileClock& clock) {
  if (value.kind == Kind::text)
    clock.start = value.text;
  else if (value.kind == Kind::whole || value.kind == Kind::number)
    clock.start_number = value.number;
  else
    in.wrong_type(value, "time.start", "a date in a string, as \"2020-01-03 12:00\", or a number");
}

/// A unit of time, or a number.
void read_unit(Reader& in, const Value& value, FileClock& clock) {
  const bool is_number = value.kind == Kind::whole || value.kind == Kind::number;
  if (value.kind == Kind::text && read::seconds_of_unit(value.text))
    clock.unit = value.text;
  else if (value.kind == Kind::text)
    in.diagnostics.error(value.place, fmt::format("\"{}\" is no unit of time that is known", value.text),
                         "known units: \"s\", \"min\", \"h\", \"d\", or a number of the file's own unit");
  else if (is_number && value.number > 0 && std::isfinite(value.number))
    clock.unit_number = value.number;
  else if (is_number)
    in.diagnostics.error(value.place, fmt::format("time.unit must be greater than 0, found {}", value.number));
  else
    in.wrong_type(value, "time.unit", "a unit in a string, as \"h\", or a number");
}

std::optional<FileClock> read_clock(Reader& in, std::string_view table_name) {
  const Entry* entry = in.find(table_name, "time");
  if (!entry) return std::nullopt;
  const Key& key = find_key(table_name, "time");
  if (entry->value.kind != Kind::table) {
    in.wrong_type(entry->value, in.label_of(key), type_text(key));
    return std::nullopt;
  }
  FileClock clock;
  for (const Entry& part : entry->value.entries) {
    if (part.name == "start")
      read_start(in, part.value, clock);
    else if (part.name == "unit")
      read_unit(in, part.value, clock);
    else
      in.diagnostics.error(part.place, fmt::format("unknown key \"{}\" in {}", part.name, in.label_of(key)),
                           "known keys: start, unit");
  }
  return clock;
}

/// An array that names the land.
void read_mask(Reader& in, std::string_view table_name, GridFileSpec& spec) {
  spec.mask = in.text(table_name, "mask");
  spec.mask_is = in.choice(table_name, "mask_is");
  const Entry* is = in.find(table_name, "mask_is");
  const Entry* mask = in.find(table_name, "mask");
  if (is && !mask)
    in.diagnostics.error(is->place, "\"mask_is\" goes with \"mask\"", "mask = \"tmask\" names the array");
  if (mask && spec.missing == "keep")
    in.diagnostics.error(mask->place, "missing = \"keep\" takes every number as it is, so a mask has no effect",
                         "another choice of \"missing\" says what happens on land");
}

/// The choice of that name, or the first one after a complaint.
template <class Choice, std::size_t n>
Choice choice_of(const std::array<std::string_view, n>& names, const std::string& name) {
  const auto at = std::find(names.begin(), names.end(), name);
  return at == names.end() ? Choice{} : static_cast<Choice>(at - names.begin());
}

}  // namespace

/// Data on a grid, read at once so that everything wrong with it has its place in the case file.
template <class FileSpec>
FileSpec grid_file(Reader& in, std::string_view table_name, const Value& value, int least_components,
                   int most_components) {
  FileSpec spec;
  spec.arrays = array_names(in, table_name, most_components);
  spec.interpolation = in.choice(table_name, "interpolation");
  spec.time_interpolation = in.choice(table_name, "time_interpolation");
  spec.clock = read_clock(in, table_name);
  if (const auto level = in.number(table_name, "level")) spec.level = level->number;
  spec.gaps = in.choice(table_name, "gaps");
  spec.duplicates = in.choice(table_name, "duplicates");
  spec.outside = in.choice(table_name, "outside");
  spec.missing = in.choice(table_name, "missing");
  if (const auto mark = in.number(table_name, "missing_value")) spec.missing_value = mark->number;
  read_mask(in, table_name, spec);
  if (value.kind != Kind::text) {
    in.wrong_type(value, in.label_of(find_key(table_name, "file")), "the name of a file in a string");
    return spec;
  }
  if (!in.facts.dimension) return spec;
  spec.file = find_data_file(in.folder, value.text);
  try {
    std::optional<read::SceneClock> clock;
    if (spec.clock) clock = {spec.clock->start, spec.clock->start_number, spec.clock->unit, spec.clock->unit_number};
    std::optional<read::Frame> frame;  // of a picture: the domain
    if (most_components == 1 && in.facts.domain_valid) frame = {in.facts.box.min, in.facts.box.max};
    spec.data = read::read_grid(
        spec.file, {.arrays = spec.arrays,
                    .dimension = in.facts.dimension,
                    .least_components = static_cast<std::size_t>(least_components),
                    .most_components = static_cast<std::size_t>(most_components),
                    .missing = choice_of<read::Missing>(read::missing_names, spec.missing),
                    .missing_value = spec.missing_value,
                    .mask = spec.mask,
                    .mask_is = choice_of<read::MaskIs>(read::mask_names, spec.mask_is),
                    .decays = most_components == 1,
                    .frame = frame,
                    .clock = clock,
                    .level = spec.level,
                    .on_sphere = in.facts.on_sphere,
                    .gaps = choice_of<read::Gaps>(read::gaps_names, spec.gaps),
                    .duplicates = choice_of<read::Duplicates>(read::duplicates_names, spec.duplicates),
                    .times_at_once = times_of(choice_of<Interpolation>(interpolation_names, spec.time_interpolation))});
    if (in.facts.on_sphere && in.facts.domain_valid)
      spec.data = around_sphere(spec.data, (in.facts.box.min[0] + in.facts.box.max[0]) / 2);
    for (const DataWarning& warning : spec.data->warnings)
      in.diagnostics.warning(value.place, warning.message, warning.remedy);
    in.facts.grid_files.push_back({value.place, spec.data});
    if (spec.data->curved)
      check_curved(in, table_name, spec, most_components == 1, value.place);
    else if (spec.outside == "error" && most_components == 1)
      check_covers_domain(in, *spec.data, value.place);
  } catch (const read::GridFileError& error) {
    const std::string was = where_data_file_was(in.folder, value.text);
    in.diagnostics.error(value.place, error.what(), was.empty() ? error.remedy() : was);
  } catch (const std::invalid_argument& error) {
    in.diagnostics.error(value.place, error.what(), "without domain.coordinates all coordinates are lengths");
  }
  return spec;
}

template FileVelocitySpec grid_file(Reader&, std::string_view, const Value&, int, int);
template FileDensitySpec grid_file(Reader&, std::string_view, const Value&, int, int);
template GridFileSpec grid_file(Reader&, std::string_view, const Value&, int, int);

/// Data at several times must cover the run.
void check_times_of_files(Reader& in, const TimeSpec& time) {
  if (!in.facts.end) return;
  const double start = time.start, end = time.at(time.end),
               length = same_time * std::max(std::abs(start), std::abs(end));
  for (const auto& [place, data] : in.facts.grid_files) {
    const double first = data->times.front(), last = data->times.back();
    if (data->times.size() > 1 && (first > std::min(start, end) + length || last < std::max(start, end) - length))
      in.diagnostics.error(place,
                           fmt::format("{} covers the times {} to {}, but the run goes from {} to {}", data->name,
                                       first, last, start, end),
                           time.start == 0 && !time.backwards
                               ? "shorten time.end, or let the data cover the run"
                               : "change time.start or time.end, or let the data cover the run");
  }
}

namespace {

std::string written(const FileClock& clock) {
  std::vector<std::string> parts;
  if (!clock.start.empty()) parts.push_back("start = " + input::written(clock.start));
  if (clock.start_number) parts.push_back("start = " + input::written(*clock.start_number));
  if (!clock.unit.empty()) parts.push_back("unit = " + input::written(clock.unit));
  if (clock.unit_number) parts.push_back("unit = " + input::written(*clock.unit_number));
  return fmt::format("{{ {} }}", fmt::join(parts, ", "));
}

}  // namespace

template <class FileSpec>
void write_grid_file(Writer& out, const FileSpec& spec) {
  out.entry("file", out.data_file(spec.file));
  if (spec.arrays.size() == 1) out.entry("array", written(spec.arrays[0]));
  if (spec.arrays.size() > 1) out.entry("arrays", written(spec.arrays));
  out.entry("interpolation", written(spec.interpolation));
  out.entry("time_interpolation", written(spec.time_interpolation));
  if (spec.clock) out.entry("time", written(*spec.clock));
  if (spec.level) out.entry("level", written(*spec.level));
  out.entry("outside", written(spec.outside));
  out.entry("missing", written(spec.missing));
  if (spec.missing_value) out.entry("missing_value", written(*spec.missing_value));
  if (!spec.mask.empty()) out.entry("mask", written(spec.mask));
  if (!spec.mask_is.empty()) out.entry("mask_is", written(spec.mask_is));
  out.entry("gaps", written(spec.gaps));
  out.entry("duplicates", written(spec.duplicates));
}

template void write_grid_file(Writer&, const FileVelocitySpec&);
template void write_grid_file(Writer&, const FileDensitySpec&);
template void write_grid_file(Writer&, const GridFileSpec&);

}  // namespace gaussdrift::input
