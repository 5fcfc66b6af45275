#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/json_file.hpp"
#include "cli/carry_out.hpp"
#include "cli/films.hpp"
#include "cli/owed_files.hpp"
#include "cli/run_page.hpp"
#include "cli/terminal.hpp"
#include "write/run_folder.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

/// What summary.json says of the checks.
bool has_failed_check(const fs::path& folder) {
  const auto summary = base::json_if_there(folder / "summary.json", base::most_json_of_numbers, "run it again");
  const auto checks = summary ? summary->value("checks", nlohmann::ordered_json()) : nlohmann::ordered_json();
  return std::any_of(checks.begin(), checks.end(), [](const nlohmann::ordered_json& check) {
    const auto passed = check.is_object() ? check.find("passed") : check.end();
    return check.is_object() && passed != check.end() && *passed == false;
  });
}

}  // namespace

ExitCode finish(const Case& spec, const fs::path& folder) {
  write::RunFolder own_folder(folder, spec, {.go_on = true, .films = film_names(spec)});
  OwedFiles owed;
  put(stdout, make_films(folder, spec, 0, owed));
  if (spec.output.report) put(stdout, write_page(folder, spec, owed));
  owed.attempt([&] { own_folder.complete(); });
  for (const std::string& why : owed.missing()) note("error: {}\n", why);
  if (has_failed_check(folder)) return ExitCode::check;
  return owed.code();
}

}  // namespace gaussdrift::cli
