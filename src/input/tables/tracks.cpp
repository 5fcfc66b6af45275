// [output.tracks]: which particles are followed, and what is told along their paths.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/catalogue.hpp"
#include "effect/catalogue.hpp"
#include "gaussdrift/error.hpp"
#include "input/data_files.hpp"
#include "input/points_table.hpp"
#include "input/tables/tables.hpp"
#include "sim/grid_fields.hpp"
#include "write/track_files.hpp"

namespace gaussdrift::input {

namespace {

constexpr const char* table_name = "output.tracks";

std::string joined_defaults() {
  std::string names;
  for (const write::TrackFileKind& kind : write::track_files())
    if (kind.about.by_default) names += fmt::format("{}{}", names.empty() ? "" : ", ", kind.about.name);
  return names;
}

std::string meaning_of_files() {
  std::string text = "what is written beside tracks.csv when the run has ended";
  for (const write::TrackFileKind& kind : write::track_files())
    text += fmt::format(". `{}` is {}", kind.about.name, kind.about.meaning);
  return text;
}

/// Fields that are known at any place.
std::vector<std::string_view> names_of_fields() {
  std::vector<std::string_view> names;
  for (const GridFieldKind& kind : grid_fields())
    if (!kind.about.is_of_particles) names.push_back(kind.about.name);
  return names;
}

bool is_of_density(const GridField& field) { return !field.is_of_flow; }

}  // namespace

Section tracks_section() {
  return {
      Table{.name = table_name,
            .required = false,
            .meaning = "particles that are followed. tracks.csv gets a row for each look at one of them: id, time, "
                       "place, values of fields, and in the last row of one that leaves the run the reason. At least "
                       "one of `ids`, `every` and `points` says who is followed"},
      {{.name = "ids",
        .type = Type::numbers,
        .range = {0, 9007199254740992.0},
        .meaning = "ids of particles, as the files of the particles tell them"},
       {.name = "every",
        .type = Type::whole,
        .range = {1, 1e9},
        .meaning = "every n-th particle: along each axis of the particle lattice, and of those that sources release"},
       {.name = "points",
        .meaning = "a table of points that go with the flow from the start and carry no weight, with the columns x, y "
                   "and, in space, z: text, .npy or .vtp. The path is relative to the case file. Their "
                   "ids are -1, -2, ... in the order of the table"},
       {.name = "steps",
        .type = Type::whole,
        .range = {1, 1e9},
        .meaning = "a look after every so many steps of the run, beside those at its start, at outputs and at "
                   "releases"},
       {.name = "fields",
        .type = Type::choices,
        .fallback = " ",
        .choices = names_of_fields(),
        .meaning = "what is told at each place. The density and its derivatives are told at the start, at outputs and "
                   "at releases"},
       {.name = "files",
        .type = Type::choices,
        .fallback = kept(joined_defaults()),
        .choices = base::names_of(write::track_files()),
        .meaning = meaning_of_files()}}};
}

namespace {

std::vector<std::int64_t> read_ids(Reader& in, const Entry& entry) {
  std::vector<std::int64_t> ids;
  const auto list = in.numbers(entry, find_key(table_name, "ids"));
  if (!list) return ids;
  for (std::size_t k = 0; k < list->size(); ++k) {
    const double id = (*list)[k];
    const Value& written = entry.value.items[k];
    if (id < 0 || id != std::floor(id))
      in.diagnostics.error(written.place,
                           fmt::format("entry {} of output.tracks.ids is {}; ids are whole numbers from 0", k + 1,
                                       found_number(id, written)));
    else if (std::find(ids.begin(), ids.end(), static_cast<std::int64_t>(id)) != ids.end())
      in.diagnostics.error(written.place, fmt::format("{} appears twice in output.tracks.ids", id));
    else
      ids.push_back(static_cast<std::int64_t>(id));
  }
  return ids;
}

void read_points(Reader& in, const Value& value, TracksSpec& tracks) {
  constexpr std::size_t memory_limit = std::size_t{1} << 30;
  if (value.kind != Value::Kind::text)
    return in.wrong_type(value, in.label_of(find_key(table_name, "points")), "the name of a file in a string");
  if (!in.facts.dimension || !in.facts.domain_valid) return;
  tracks.file = find_data_file(in.folder, value.text);
  std::vector<std::string> columns{"x", "y"};
  if (in.facts.dimension == 3) columns.emplace_back("z");
  try {
    NamedColumns read = read_named_columns(tracks.file, columns, memory_limit);
    const std::size_t width = columns.size();
    for (std::size_t row = 0; row < read.rows.size() / width; ++row)
      if (!is_in_domain(in, read.rows.data() + row * width))
        throw InputError(fmt::format("{}:{}:1: the point lies outside the domain; leave it out, or enlarge the domain",
                                     tracks.file.string(), read.lines.line_of(row)));
    tracks.points = std::make_shared<const std::vector<double>>(std::move(read.rows));
  } catch (const Error& error) {
    in.diagnostics.error(value.place, error.what(), where_data_file_was(in.folder, value.text));
  }
}

/// Particles that are followed must stay who they are, and what is told of the flow must be what moves them.
void refuse_effects(Reader& in, const TracksSpec& tracks, const Case& spec) {
  for (const auto& [effect, values] : effects_of(spec.effects)) {
    const EffectTraits& traits = effect->traits;
    const auto refuse = [&](const char* key, const std::string& what, const std::string& remedy) {
      if (const Entry* entry = in.find(table_name, key)) in.diagnostics.error(entry->place, what, remedy);
    };
    const std::string table = table_of(*effect);
    if (traits.replaces_particles.of(values, spec.domain.dimension))
      for (const char* key : {"ids", "every"})
        refuse(key, fmt::format("no particle can be followed with [{}]: {}", table, traits.replaces_particles.words),
               "points = \"points.csv\" follows points that go with the flow");
    if (!traits.particles_interact) continue;
    refuse("points",
           fmt::format("points go with the prescribed flow alone, and with [{}] particles move each other", table),
           "follow particles: every = 10, or ids = [...]");
    for (const GridField& field : tracks.fields)
      if (field.is_of_flow)
        refuse("fields",
               fmt::format("\"{}\" is known of the prescribed flow alone, and with [{}] particles move each other",
                           field.name, table),
               "leave it out; differences of the places tell the velocity");
  }
}

}  // namespace

void read_tracks(Reader& in, Case& spec) {
  const Value* table = in.table(table_name);
  if (!table) return;
  TracksSpec tracks;
  const Entry *ids = in.find(table_name, "ids"), *every = in.find(table_name, "every"),
              *points = in.find(table_name, "points"), *steps = in.find(table_name, "steps");
  const auto is_meant = [&](const char* name) { return in.is_meant(fmt::format("{}.{}", table_name, name)); };
  if (!ids && !every && !points && !is_meant("ids") && !is_meant("every") && !is_meant("points"))
    in.diagnostics.error(table->place, "[output.tracks] does not say who is followed",
                         "every = 10 follows every tenth particle along each axis of the lattice; ids = [...] and "
                         "points = \"points.csv\" are others");
  if (ids) tracks.ids = read_ids(in, *ids);
  if (every)
    if (const auto number = in.number(table_name, "every")) tracks.every = to_int(*number);
  if (points) read_points(in, points->value, tracks);
  if (steps)
    if (const auto number = in.number(table_name, "steps")) tracks.steps = to_int(*number);
  for (const std::size_t k : in.choices(table_name, "fields"))
    tracks.fields.push_back(find_grid_field(find_key(table_name, "fields").choices[k]).about);
  for (const std::size_t k : in.choices(table_name, "files")) tracks.files.push_back(write::track_files()[k].about);
  refuse_effects(in, tracks, spec);
  const Entry* fields = in.find(table_name, "fields");
  if (steps && fields && std::all_of(tracks.fields.begin(), tracks.fields.end(), is_of_density) &&
      !tracks.fields.empty())
    in.diagnostics.warning(fields->value.place,
                           "weights are known at outputs and releases, so that the density is not a number in rows "
                           "between them",
                           "leave out output.tracks.steps, or add output.times");
  spec.output.tracks = std::move(tracks);
}

void write_tracks(Writer& out, const OutputSpec& output) {
  if (!output.tracks) return;
  const TracksSpec& tracks = *output.tracks;
  const auto names = [](const auto& things) {
    std::vector<std::string> list;
    for (const auto& thing : things) list.emplace_back(thing.name);
    return written(list);
  };
  out.table(table_name);
  if (!tracks.ids.empty()) out.entry("ids", written(std::vector<double>(tracks.ids.begin(), tracks.ids.end())));
  if (tracks.every > 0) out.entry("every", fmt::format("{}", tracks.every));
  if (!tracks.file.empty()) out.entry("points", out.data_file(tracks.file));
  if (tracks.steps > 0) out.entry("steps", fmt::format("{}", tracks.steps));
  if (!tracks.fields.empty()) out.entry("fields", names(tracks.fields));
  out.entry("files", names(tracks.files));
}

}  // namespace gaussdrift::input
