#include "gaussdrift/read_case.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/printable.hpp"
#include "base/text_file.hpp"
#include "input/reader.hpp"
#include "input/tables/tables.hpp"
#include "read/grid_file.hpp"

namespace gaussdrift {

using namespace input;  // this is the public face of that module

namespace {

// A case is a few kilobytes; a long list of output times may take more. Data belong into files of their own.
constexpr std::size_t largest_case_file = 4'000'000;

/// Titles go to terminals, pages and pictures.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return base::printable(text);
}

/// Complains about everything that is wrong, table after table.
Case read_tables(Reader& in) {
  Case scene;
  in.check_names();
  in.read_version();
  in.check_tables();
  scene.title = one_line(in.text("case", "title"));
  scene.cite = one_line(in.text("case", "cite"));
  read_params(in, scene.params);
  read_domain(in, scene.domain);
  read_velocity(in, scene.velocity);
  read_density(in, scene.density);
  read_particles(in, scene.particles, scene.domain);
  read_time(in, scene.time);
  check_times_of_files(in);
  read_evaluate(in, scene.evaluate, scene.domain);
  read_output(in, scene.output, scene.time);
  read_effects(in, scene);
  read_reference(in, scene);
  read_accuracy(in, scene);
  read_checks(in, scene);
  if (in.diagnostics.errors() == 0) warn_unused_params(in);
  return scene;
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
  if (kind == ".vti" || kind == ".vtr" || kind == ".pvd")
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
