// gaussdrift field: the velocity of a case alone, and what follows from it, on the grid of its outputs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/suggest.hpp"
#include "cli/asked_case.hpp"
#include "cli/laid_out.hpp"
#include "cli/output_name.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "gaussdrift/error.hpp"
#include "sim/fields_on_grid.hpp"
#include "sim/grid_fields.hpp"
#include "sim/grid_pieces.hpp"
#include "sim/make_fields.hpp"
#include "sim/scene.hpp"
#include "write/atomic_file.hpp"
#include "write/result_folder.hpp"
#include "write/vtk_files.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

struct FieldOptions {
  CaseOptions case_options;
  std::vector<double> times;        // empty: those of the outputs
  std::vector<std::string> fields;  // empty: all of the flow
  fs::path folder;                  // --out; empty: output/field_<case name>
  bool force = false;
};

std::vector<std::string> fields_of_flow() {
  std::vector<std::string> names;
  for (const GridFieldKind& kind : grid_fields())
    if (kind.of_flow) names.emplace_back(kind.about.name);
  return names;
}

void declare(OptionList& options, FieldOptions& given) {
  declare_case(options, given.case_options);
  options.add("--times", given.times, "T,...", "times of the scene; those of the outputs by default").separated_by(',');
  options
      .add("--fields", given.fields, "NAME,...",
           fmt::format("some of {}; all by default", fmt::join(fields_of_flow(), ", ")))
      .separated_by(',');
  options.add("--out", given.folder, "DIR", "folder for the files; output/field_<case> by default");
  options.flag("--force", given.force, "replace earlier fields in that folder");
}

std::vector<GridField> asked_fields(const std::vector<std::string>& asked) {
  const std::vector<std::string> known = fields_of_flow();
  std::vector<GridField> fields;
  for (const std::string& name : asked.empty() ? known : asked) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      const auto near = base::suggest(name, known);
      throw CommandLineError(fmt::format("--fields {}: it does not follow from the velocity{}; there are {}", name,
                                         near ? fmt::format("; did you mean {}?", *near) : "", fmt::join(known, ", ")));
    }
    if (std::none_of(fields.begin(), fields.end(), [&](const GridField& field) { return field.name == name; }))
      fields.push_back(find_grid_field(name).about);
  }
  return fields;
}

struct Extremes {
  std::string name;
  double least = INFINITY, most = -INFINITY;  // of a vector, of its length
  std::size_t unknown = 0;                    // values that are not numbers
};

void look_at(const FieldOnGrid& field, Extremes& extremes) {
  const auto components = static_cast<std::size_t>(field.components);
  for (std::size_t j = 0; j < field.values.size(); j += components) {
    double value = field.values[j];
    if (components > 1) value = std::hypot(value, field.values[j + 1], components > 2 ? field.values[j + 2] : 0);
    extremes.unknown += std::isnan(value);
    extremes.least = std::min(extremes.least, value), extremes.most = std::max(extremes.most, value);  // not of NaN
  }
}

ExitCode field(const FieldOptions& options) {
  check_folder_name(options.folder, "fields are written into a folder, as field_0000.vti and so on");
  Case spec = read(options.case_options);
  spec.output.fields = asked_fields(options.fields);
  if (!options.times.empty()) spec.output.times = options.times;
  for (const double time : spec.output.times)
    if (!std::isfinite(time)) throw CommandLineError("--times: a time is a number");
  const Lattice lattice = evaluation_lattice(spec);
  if (pieces_of_grid(spec).count() > 1)
    throw InputError(
        fmt::format("the evaluation lattice has {} points and would be written in pieces, which `field` "
                    "does not do. Lower evaluate.per_axis, or raise evaluate.piece_points",
                    lattice.size()));
  const auto velocity = make_velocity(spec, options.case_options.threads);
  const fs::path folder = options.folder.empty()
                              ? fs::path("output") / ("field_" + options.case_options.file.stem().string())
                              : options.folder;
  using Earlier = write::ResultFolder::Earlier;
  write::ResultFolder place(folder, "field", options.force ? Earlier::replace : Earlier::refuse);
  std::vector<Extremes> extremes;
  for (const GridField& one : spec.output.fields) extremes.push_back({.name = std::string(one.name)});
  write::Collection collection(place.claim("field.pvd"));
  for (std::size_t i = 0; i < spec.output.times.size(); ++i) {
    const double time = spec.output.times[i];
    const std::vector<FieldOnGrid> fields =
        fields_on_grid(spec.output, lattice, {{}, lattice.points}, {}, *velocity, time, options.case_options.threads);
    for (std::size_t k = 0; k < fields.size(); ++k) look_at(fields[k], extremes[k]);
    const fs::path file = place.claim(fmt::format("field_{:04}.vti", i));
    write::write_text(file, write::fields_text(file, lattice, fields, time));
    collection.add(time, file);
    place.has_result();
  }
  place.complete();
  nlohmann::ordered_json told = nlohmann::ordered_json::object();
  for (const Extremes& one : extremes) {
    const bool none = one.least > one.most;
    // JSON has no infinity: where nothing is known there is null.
    told[one.name] = {{"least", one.least}, {"most", one.most}, {"unknown", one.unknown}};
    if (options.case_options.json) continue;
    say("{:<11}{}{}\n", one.name, none ? "not known anywhere" : fmt::format("{:.6g} to {:.6g}", one.least, one.most),
        one.unknown > 0 && !none ? fmt::format(", not known at {} points of all times", one.unknown) : "");
  }
  if (options.case_options.json)
    put(stdout, laid_out(nlohmann::ordered_json{{"folder", folder.string()}, {"fields", told}}) + "\n");
  else
    say("open   {} in ParaView\n", (folder / "field.pvd").string());
  return ExitCode::ok;
}

}  // namespace

Verb field_verb() {
  return make_verb<FieldOptions>(
      "field", "the velocity of a case alone, its curl and divergence, as files for ParaView", declare, field);
}

}  // namespace gaussdrift::cli
