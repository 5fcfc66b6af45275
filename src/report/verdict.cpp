// The first words of the page: how right the run is, what is to blame, and what would help.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "report/sections.hpp"

namespace gaussdrift::report {

namespace {

/// "2.4 %"; parts below a tenth of a per mille as a power of ten.
std::string part_text(double part) {
  return part >= 1e-4 ? fmt::format("{:.2g} %", 100 * part) : fmt::format("{:.1e}", part);
}

/// What the largest of the causes means for somebody who does not know its name.
std::string_view blame(const std::string& cause) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 7> words{
      {{"smoothing", "most of the error is that the blobs are too wide"},
       {"quadrature", "most of the error is that the blobs stand too far apart"},
       {"time stepping", "most of the error is that the time steps are too long"},
       {"Gauss transform", "most of the error is that the sum of the blobs is not sharp enough"},
       {"particles left out", "most of the error is that small particles were left out"},
       {"fit of samples", "most of the error is that the samples are too few or too far apart"},
       {"noise of the walk", "most of the error is chance: too few particles walk"}}};
  for (const auto& [name, meaning] : words)
    if (name == cause) return meaning;
  return "";
}

/// "--accuracy 0.001 costs 0.3 s more"
std::string better(const json& next) {
  const json target = get(next, "target"), more = get(next, "seconds_more");
  if (!target.is_number() || !more.is_number()) return "";
  const double seconds = more.get<double>();
  const std::string cost = std::abs(seconds) < 0.05 ? "takes about as long"
                           : seconds > 0            ? fmt::format("costs about {:.2g} s more", seconds)
                                                    : fmt::format("saves about {:.2g} s", -seconds);
  return fmt::format(" <code>--accuracy {:g}</code> {}.", target.get<double>(), cost);
}

/// One sentence that a reader can act on.
std::string in_short(const json& summary, const json& last) {
  const json budget = get(summary, "budget"), dominates = get(get(budget, "measured"), "dominates");
  if (!last.contains("Linf"))
    return "<b>Not known how right:</b> the density was compared with nothing, so its error is not known.";
  if (!last.at("Linf").is_number()) return "";
  const double error = last.at("Linf").get<double>();
  std::string text = fmt::format("<b>Right to {} of the highest {}</b>", part_text(error), escaped(label_of(summary)));
  if (const std::string_view why = dominates.is_string() ? blame(dominates.get<std::string>()) : ""; !why.empty())
    text += fmt::format("; {}", why);
  return text + "." + better(get(budget, "more_accurate"));
}

}  // namespace

std::string label_of(const json& summary) {
  const json label = get(summary, "label");
  return label.is_string() ? label.get<std::string>() : "density";
}

std::string verdict(const json& summary) {
  const json frames = get(summary, "frames"), checks = get(summary, "checks"), target = get(summary, "accuracy"),
             advice = get(get(summary, "budget"), "advice");
  const json last = frames.empty() ? json() : frames.back();
  std::string text = in_short(summary, last);
  if (!text.empty()) text += "<br>";
  if (last.contains("Linf") && !last.at("Linf").is_number())
    text += fmt::format("At t = {} {}.", time_of(last),
                        get(last, "no_norms").is_string() ? escaped(last.at("no_norms").get<std::string>())
                                                          : "the error is not a number");
  else if (last.contains("Linf"))
    text += fmt::format("At t = {} the largest error is {} of the largest density (L1 {}, L2 {}).", time_of(last),
                        number(last.at("Linf"), "{:.2e}"), number(last.at("L1"), "{:.2e}"),
                        number(last.at("L2"), "{:.2e}"));
  if (const json worst = get(summary, "worst"); worst.is_object() && worst.at("t") != get(last, "t"))
    text += fmt::format(" The output with the largest L1 is that at t = {}: L1 {}, L2 {}, Linf {}.",
                        number(worst.at("t"), "{:.4g}"), number(worst.at("L1"), "{:.2e}"),
                        number(worst.at("L2"), "{:.2e}"), number(worst.at("Linf"), "{:.2e}"));
  if (target.is_object())
    text += fmt::format(" Target {}: {}.", number(target.at("target"), "{:g}"),
                        !target.at("achieved").is_number() ? "not known whether it is met"
                        : target.at("met") == json(true)   ? "<b>met</b>"
                                                           : "<b class=bad>missed</b>");
  std::size_t failed = 0;
  for (const json& check : checks) failed += !check.at("passed").get<bool>();
  if (!checks.empty())
    text += failed && checks.size() == 1 ? " <b class=bad>The check failed.</b>"
            : failed ? fmt::format(" <b class=bad>{} of {} checks failed.</b>", failed, checks.size())
                     : fmt::format(" {} passed.", checks.size() == 1 ? "The check" : "All checks");
  for (std::size_t i = 0; i < advice.size(); ++i)
    text += (i == 0 ? "<br>Advice: " : "; ") + escaped(advice[i].get<std::string>());
  if (!advice.empty()) text += ".";
  return text;
}

}  // namespace gaussdrift::report
