// gaussdrift check: what a case will do, found without running it.
#include "accuracy/forecast.hpp"
#include "cli/asked_case.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"

namespace gaussdrift::cli {

namespace {

ExitCode check(const CaseOptions& options) {
  const double memory = most_memory(options.memory);
  const Case spec = settled(read(options), options);
  accuracy::Forecast forecast;
  {
    ProgressLine line(1);
    forecast = accuracy::forecast(
        spec, options.threads, [&](const std::string& what) { line.show("check: " + what); }, memory);
  }
  say("{}", options.json ? accuracy::to_json(spec, forecast) : accuracy::to_text(spec, forecast));
  return ExitCode::ok;
}

}  // namespace

Verb check_verb() {
  return make_verb<CaseOptions>("check", "describe a case and predict what it costs, without running it", declare_case,
                                check);
}

}  // namespace gaussdrift::cli
