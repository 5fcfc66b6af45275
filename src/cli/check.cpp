// gaussdrift check: what a case will do, found without running it.
#include <nlohmann/json.hpp>
#include <optional>

#include "accuracy/forecast.hpp"
#include "accuracy/rank_forecast.hpp"
#include "cli/asked_case.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"

namespace gaussdrift::cli {

namespace {

struct CheckOptions {
  CaseOptions case_options{};
  int ranks = 0;  // 0: nothing is said about them
};

void declare(OptionList& options, CheckOptions& given) {
  declare_case(options, given.case_options);
  options
      .add("--ranks", given.ranks, "N",
           "say also what a run on N ranks would be like: balance, memory, bytes. It needs no ranks itself")
      .within(1, 1'000'000);
}

std::string json_of(const Case& spec, const accuracy::Forecast& forecast,
                    const std::optional<accuracy::RankForecast>& ranks) {
  const std::string text = accuracy::to_json(spec, forecast);
  if (!ranks) return text;
  auto document = nlohmann::ordered_json::parse(text);
  document["ranks"] = nlohmann::ordered_json::parse(accuracy::to_json(*ranks));
  return document.dump(2) + "\n";
}

ExitCode check(const CheckOptions& given) {
  const CaseOptions& options = given.case_options;
  const double memory = most_memory(options.memory);
  const Case spec = settled(read(options), options);
  accuracy::Forecast forecast;
  std::optional<accuracy::RankForecast> ranks;
  {
    ProgressLine line(1);
    const auto doing = [&](const std::string& what) { line.show("check: " + what); };
    forecast = accuracy::forecast(spec, options.threads, doing, memory);
    if (given.ranks > 0) {
      doing("sharing the work among ranks");
      ranks = accuracy::forecast_ranks(spec, forecast.particles_at_most, forecast.program_bytes, given.ranks);
    }
  }
  say("{}", options.json ? json_of(spec, forecast, ranks)
                         : accuracy::to_text(spec, forecast) + (ranks ? accuracy::to_text(*ranks) : ""));
  return ExitCode::ok;
}

}  // namespace

Verb check_verb() {
  return make_verb<CheckOptions>("check", "describe a case and predict what it costs, without running it", declare,
                                 check);
}

}  // namespace gaussdrift::cli
