#include "cli/asked_case.hpp"

#include <fmt/format.h>

#include "accuracy/memory_limits.hpp"
#include "accuracy/target.hpp"
#include "base/printable.hpp"
#include "base/size_text.hpp"
#include "cli/films.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "input/explain.hpp"

namespace gaussdrift::cli {

std::vector<std::string> settings_to_begin() {
  std::vector<std::string> settings;
  for (const std::string& key : input::key_paths()) settings.push_back(key + "=");
  return settings;
}

void declare_case(OptionList& options, CaseOptions& given) {
  options.add("case", given.file, "CASE", "case file (TOML), see docs/cases.md").required();
  options.add("--set", given.overrides, "KEY=VALUE", "set a key of the case: --set time.step=0.01. Repeatable")
      .repeatable()
      .offers(settings_to_begin);
  options.add("--accuracy", given.accuracy, "X",
              "error that you accept at the end, relative to the largest density. Settings are chosen for it");
  declare_memory(options, given.memory);
  options.threads(given.threads);
  options.json(given.json);
}

void declare_memory(OptionList& options, std::string& value) {
  options.add("--memory", value, "SIZE",
              "refuse what is predicted to take more memory (\"2 GiB\", \"500 MB\"); by default what there is");
}

double most_memory(const std::string& value) {
  if (value.empty()) return accuracy::no_limit;
  if (const auto bytes = base::read_size(value)) return *bytes;
  throw CommandLineError(fmt::format("--memory {} is no size; give {}", base::in_quotes(value), base::size_form));
}

Case read(const CaseOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.accuracy.empty()) overrides.push_back("accuracy.target=" + options.accuracy);
  ReadResult result = read_case(options.file, overrides, options.threads);
  for (const std::string& warning : result.warnings) note("{}\n", warning);
  return std::move(result.spec);
}

Case settled(Case spec, const CaseOptions& options) {
  refuse_films_without_their_program(spec);
  if (!spec.accuracy.target) return spec;
  accuracy::AccuracyChoice choice;
  {
    ProgressLine line(1);
    choice = accuracy::choose_for_accuracy(spec, *spec.accuracy.target, options.threads,
                                           [&](const std::string& what) { line.show(what); });
  }
  put(options.json ? stderr : stdout, accuracy::to_text(choice));
  return std::move(choice.spec);
}

}  // namespace gaussdrift::cli
