#include "gaussdrift/read_case.hpp"

#include <fmt/format.h>

#include "base/text_file.hpp"
#include "input/reader.hpp"
#include "input/sphere_rules.hpp"
#include "input/tables/tables.hpp"
#include "read/grid_file.hpp"

namespace gaussdrift {

using namespace input;  // this is the public face of that module

namespace {

// A case is a few kilobytes; a long list of output times may take more. Data belong into files of their own.
constexpr std::size_t largest_case_file = 4'000'000;

/// Complains about everything that is wrong, table after table.
Case read_tables(Reader& in) {
  Case spec;
  in.check_names();
  in.read_version();
  in.check_tables();
  read_heading(in, spec);
  read_params(in, spec.params);
  read_domain(in, spec.domain);
  read_velocity(in, spec.velocity);
  read_density(in, spec);
  read_particles(in, spec.particles, spec.domain);
  read_time(in, spec.time);
  check_times_of_files(in, spec.time);
  read_sources(in, spec);
  read_evaluate(in, spec.evaluate, spec.domain);
  read_output(in, spec.output, spec.time);
  read_pictures(in, spec.output, spec.domain);
  read_effects(in, spec);
  read_tracks(in, spec);
  check_tracers(in, spec);
  read_reference(in, spec);
  read_accuracy(in, spec);
  read_checks(in, spec);
  check_sphere(in, spec);
  if (in.diagnostics.errors() == 0) warn_unused_params(in);
  return spec;
}

}  // namespace

ReadResult parse_case(const std::string& text, const std::filesystem::path& file,
                      const std::vector<std::string>& overrides, int threads) {
  const Source source(file.string(), text, overrides);
  Diagnostics diagnostics(source);
  const auto root = read_document(text, source, diagnostics);
  ReadResult result;
  if (root) {
    Reader reader(*root, source, diagnostics, file.parent_path(), threads);
    result.spec = read_tables(reader);
  }
  if (diagnostics.errors() > 0) throw CaseError(diagnostics.error_text(), diagnostics.errors());
  result.spec.name = file.stem().string();
  result.spec.file = file;
  result.spec.source = text;
  result.warnings = diagnostics.warnings();
  return result;
}

ReadResult read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides, int threads) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw FileError(fmt::format("the case file {} cannot be read: there is no such file", file.string()));
  const std::string kind = file.extension().string();
  if (kind == ".vti" || kind == ".vtr" || kind == ".vts" || kind == ".pvd" || kind == ".pvti" || kind == ".vtk" ||
      read::is_netcdf(file))
    throw InputError(
        fmt::format("{0} is data on a grid, not a case; a case reads it by file = \"{0}\" in [velocity] or "
                    "[density] (gaussdrift new gridded_wind writes one)",
                    file.string()));
  if (const std::string way = read::way_to_read(file); !way.empty() && kind != ".txt" && kind != ".dat")
    throw InputError(
        fmt::format("{} is not a case but data; {}, which a case reads by file = \"...\"", file.string(), way));
  const std::string text = base::read_text_file(file, "a case file", largest_case_file);
  return parse_case(text, file, overrides, threads);
}

}  // namespace gaussdrift
