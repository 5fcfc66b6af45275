#include "report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "sim/borders/outside.hpp"

namespace gaussdrift::report {

std::string time_of(const json& frame, const char* format) {
  const std::string time = number(frame.at("t"), format);
  const json date = get(frame, "date");
  return date.is_string() ? fmt::format("{} ({})", time, escaped(date.get<std::string>())) : time;
}

std::string about_comparison(const json& summary, const json& last) {
  const json points = get(get(summary, "evaluate"), "grid_points"), compared = get(last, "compared"),
             untraced = get(last, "untraced"), kind = get(get(summary, "reference"), "kind");
  std::string text = "Relative to the exact density of the same time";
  if (kind == json("characteristics")) text += ", which is traced back along the paths of the flow";
  if (kind == json("exact")) text += ", which the case gives as a formula";
  text += ".";
  if (compared.is_number() && points.is_number() && compared < points)
    text += fmt::format(
        " Compared at a sample, {} of the {} grid points, those around the maximum among them: the largest error is "
        "that "
        "of the sample.",
        number(compared, "{:.0f}"), number(points, "{:.0f}"));
  if (untraced.is_number() && untraced > 0)
    text +=
        fmt::format(" At {} points of the last output the exact density is not known, and the norms leave them out{}.",
                    number(untraced, "{:.0f}"),
                    get(get(summary, "reference"), "trouble").is_string()
                        ? ": " + escaped(summary.at("reference").at("trouble").get<std::string>())
                        : "");
  return text;
}

namespace {

std::string bars(const std::vector<std::pair<std::string, double>>& rows) {
  double total = 0;
  for (const auto& [name, value] : rows) total = std::max(total, value);
  std::string text = "<table class=bars>";
  for (const auto& [name, value] : rows)
    if (value >= 0.001 * total)
      text += fmt::format("<tr><td>{}<td class=n>{:.3g} s<td class=w><div style=\"width:{:.1f}%\"></div>",
                          escaped(name), value, total > 0 ? 100 * value / total : 0);
  return text + "</table>";
}

}  // namespace

std::string budget_table(const json& budget) {
  const json predicted = get(budget, "predicted"), measured = get(budget, "measured");
  if (measured.contains("not_covered") && predicted.contains("not_covered"))
    return "<p>Not told apart: " + escaped(measured.at("not_covered").get<std::string>()) + ".";
  std::string text = "<table class=numbers><tr><th class=l>cause<th>predicted<th>measured";
  for (const auto& [key, name] : {std::pair{"time_stepping", "time stepping"},
                                  {"smoothing", "smoothing"},
                                  {"quadrature", "quadrature"},
                                  {"transform", "Gauss transform"},
                                  {"left_out", "particles left out, at most"},
                                  {"fit", "fit of samples"},
                                  {"noise", "noise of the walk"},
                                  {"others", "other causes"},
                                  {"total", "total"},
                                  {"interpolation", "interpolation of the data, not in the total"}}) {
    const bool is_rare = key == std::string("left_out") || key == std::string("fit");
    if (is_rare && is_zero(get(predicted, key)) && is_zero(get(measured, key))) continue;
    if (measured.contains("noise") ? !measured.contains(key)
                                   : key == std::string("noise") || key == std::string("others"))
      continue;
    if (key == std::string("interpolation") && !predicted.contains(key) && !measured.contains(key)) continue;
    const json dominates = get(measured.contains("dominates") ? measured : predicted, "dominates");
    const bool most = dominates.is_string() && std::string(name).starts_with(dominates.get<std::string>());
    text += fmt::format("<tr{}><td>{}<td class=n>{}<td class=n>{}", most ? " class=most" : "", name,
                        number(get(predicted, key), "{:.1e}"), number(get(measured, key), "{:.1e}"));
  }
  text += "</table>";
  for (const auto& [numbers, name] : {std::pair{predicted, "predicted"}, {measured, "measured"}})
    if (numbers.contains("not_covered"))
      text +=
          fmt::format("<p class=quiet>Not {}: {}.</p>", name, escaped(numbers.at("not_covered").get<std::string>()));
  if (const json advice = get(budget, "advice"); !advice.empty()) {
    text += "<ul>";
    for (const json& line : advice) text += "<li>" + escaped(line.get<std::string>());
    text += "</ul>";
  }
  return text;
}

std::string accuracy_table(const json& summary) {
  std::string text =
      "<h2>What digits of the sum cost</h2><p>The Gauss transform of the last output, done again: tolerance asked "
      "for, error measured against the direct sum on a sample, both relative to the largest density; milliseconds, "
      "the fastest of some.</p><table class=numbers><tr><th>tolerance<th>error<th>ms";
  for (const json& row : summary.at("accuracy_table"))
    text += fmt::format("<tr><td class=n>{}<td class=n>{}<td class=n>{}", number(row.at("tolerance"), "{:.0e}"),
                        number(row.at("error"), "{:.1e}"), number(row.at("milliseconds"), "{:.3g}"));
  text += "</table>\n";
  if (const json note = get(summary, "accuracy_table_note"); note.is_string())
    text += "<p class=quiet>" + escaped(note.get<std::string>()) + "</p>\n";
  return text;
}

std::string conservation(const json& frames) {
  // Runs from before the particles outside were counted have no such number.
  const bool leaves =
      std::any_of(frames.begin(), frames.end(), [](const json& frame) { return !is_zero(get(frame, "outside")); });
  const json departed = get(frames.front(), "left");  // by reason, where any can leave
  std::string heads = leaves ? "<th>outside the domain" : "";
  if (frames.front().contains("inside")) heads += "<th>inside the domain";
  const auto counted = {"released", "decayed"};  // in cases with sources
  for (const char* what : counted)
    if (frames.front().contains(what)) heads += std::string("<th>") + what;
  if (frames.front().contains("stopped")) heads += "<th>stopped at the coast";
  const json tracers = get(frames.front(), "tracers");  // by name, where densities have some
  for (const auto& [name, at_start] : tracers.items()) heads += "<th>mass of " + escaped(name);
  for (const auto& [reason, so_far] : departed.items()) heads += "<th>left by " + escaped(reason);
  std::string text =
      fmt::format("<table class=numbers><tr><th>t<th>mass<th>change{}<th>centroid<th>minimum<th>maximum", heads);
  const double begun = frames.front().at("mass").get<double>();
  double far = 0;  // centroids below rounding of the furthest are 0
  for (const json& frame : frames)
    for (const json& x : frame.at("centroid"))
      if (x.is_number()) far = std::max(far, std::abs(x.get<double>()));
  constexpr std::size_t rows = 25;
  const std::size_t stride = (frames.size() + rows - 1) / rows;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i % stride != 0 && i + 1 < frames.size()) continue;
    const json& frame = frames[i];
    std::string centroid;
    for (const json& x : frame.at("centroid")) {
      const bool is_zero = x.is_number() && std::abs(x.get<double>()) <= 1e-12 * far;
      centroid += (centroid.empty() ? "" : ", ") + (is_zero ? "0" : number(x, "{:.5g}"));
    }
    const double change = begun != 0 ? frame.at("mass").get<double>() / begun - 1 : 0;
    const json outside = get(frame, "outside");
    std::string edges = !leaves            ? ""
                        : is_zero(outside) ? "<td class=n>0"
                                           : "<td class=n>" + percent_text(outside.get<double>());
    if (frame.contains("inside")) edges += "<td class=n>" + number(frame.at("inside"), "{:.9g}");
    for (const char* what : counted)
      if (frame.contains(what)) edges += "<td class=n>" + number(frame.at(what), "{:.9g}");
    if (frame.contains("stopped")) edges += "<td class=n>" + number(get(get(frame, "stopped"), "mass"), "{:.6g}");
    for (const auto& [name, at_start] : tracers.items())
      edges += "<td class=n>" + number(get(get(get(frame, "tracers"), name.c_str()), "mass"), "{:.9g}");
    for (const auto& [reason, at_start] : departed.items())
      edges += "<td class=n>" + number(get(get(get(frame, "left"), reason.c_str()), "mass"), "{:.6g}");
    text += fmt::format("<tr><td class=n>{}<td class=n>{}<td class=n>{}{}<td class=n>{}<td class=n>{}<td class=n>{}",
                        time_of(frame, "{:.5g}"), number(frame.at("mass"), "{:.9g}"),
                        change == 0 ? "0" : fmt::format("{:.1e}", change), edges, centroid,
                        number(frame.at("minimum"), "{:.4g}"), number(frame.at("maximum"), "{:.6g}"));
  }
  text += "</table>";
  if (stride > 1)
    text +=
        fmt::format("<p class=quiet>One of {} of the {} outputs; all are in series.csv.</p>", stride, frames.size());
  return text;
}

std::string seconds(const json& summary) {
  std::vector<std::pair<std::string, double>> stages;
  const json spent = get(summary, "seconds"), total = get(spent, "total");
  double told = 0;
  for (const auto& [name, value] : spent.items())
    if (name != "total") stages.emplace_back(name, value.get<double>()), told += value.get<double>();
  if (total.is_number() && total.get<double>() > told) stages.emplace_back("other", total.get<double>() - told);
  const json threads = get(summary, "threads");
  std::string text =
      fmt::format("<h2>Seconds</h2><p>{} s in all on {}.</p>{}\n", number(total, "{:.3g}"),
                  threads == json(1) ? "one thread" : number(threads, "{:.0f}") + " threads", bars(stages));
  text += "<div class=scroll><table><tr><th>effect<th>equation<th>seconds<th>conserves";
  for (const json& effect : summary.at("effects"))
    text += fmt::format("<tr><td>{}<td>{}<td class=n>{}<td>{}", escaped(effect.at("name").get<std::string>()),
                        escaped(effect.at("equation").get<std::string>()), number(effect.at("seconds"), "{:.2g}"),
                        escaped(effect.at("conserves").get<std::string>()));
  return text + "</table></div>\n";
}

std::string particles(const json& summary) {
  const json count = get(summary, "particles"), left_out = get(count, "left_out");
  if (!get(count, "carried").is_number()) return "";
  std::string text =
      fmt::format("<h2>Particles</h2><p>{} on a lattice of {} points, {} apart.", number(count.at("carried"), "{:.0f}"),
                  number(get(count, "lattice_points"), "{:.0f}"), number(get(count, "spacing"), "{:.4g}"));
  std::string besides;  // "charge_left_out": what particles carry besides their mass
  constexpr std::string_view ending = "_left_out";
  for (const auto& [name, value] : count.items())
    if (name.ends_with(ending) && name != "mass_left_out")
      besides += fmt::format(" and {} of the {}", number(value, "{:.1e}"), name.substr(0, name.size() - ending.size()));
  if (!is_zero(left_out))
    text += fmt::format(
        " {} points with less than {} of the largest weight have none (particles.threshold): with them {} of the "
        "mass{} "
        "is left out.",
        number(left_out, "{:.0f}"), number(get(count, "threshold"), "{:g}"),
        number(get(count, "mass_left_out"), "{:.1e}"), besides);
  return text + "</p>\n";
}

namespace {

/// Digits with which a value lies below, on or above each of its limits as it does with all of them.
int telling_digits(const json& check) {
  constexpr int fewest = 4, all = 17;
  const auto side = [](double value, double limit) { return (value > limit) - (value < limit); };
  for (int digits = fewest; digits < all; ++digits) {
    const auto rounded = [&](double x) { return std::stod(fmt::format("{:.{}g}", x, digits)); };
    bool same = true;
    for (const char* limit : {"min", "max"})
      if (check.at("value").is_number() && check.at(limit).is_number()) {
        const double value = check.at("value").get<double>(), bound = check.at(limit).get<double>();
        same &= side(value, bound) == side(rounded(value), rounded(bound));
      }
    if (same) return digits;
  }
  return all;
}

}  // namespace

std::string checks_table(const json& checks) {
  std::string text =
      "<h2>Checks</h2><div class=scroll><table class=numbers><tr><th class=l>what<th>value<th>at t<th>at least<th>at "
      "most<th>";
  for (const json& check : checks) {
    const std::string shown = fmt::format("{{:.{}g}}", telling_digits(check));
    text += fmt::format("<tr><td>{}<td class=n>{}<td class=n>{}<td class=n>{}<td class=n>{}<td>{}",
                        escaped(check.at("what").get<std::string>()), number(check.at("value"), shown.c_str()),
                        number(check.at("t"), "{:.4g}"), number(check.at("min"), shown.c_str()),
                        number(check.at("max"), shown.c_str()),
                        check.at("passed").get<bool>() ? "passed" : "<b class=bad>failed</b>");
  }
  return text +
         "</table></div><p class=quiet>A check without <code>at</code> is made at every output. Its row shows the "
         "output that is nearest to a limit, or farthest beyond one.</p>\n";
}

std::string how_to_make_again(const json& provenance) {
  std::string text =
      "<h2>How to make it again</h2><p>In the folder of this page:</p><pre>gaussdrift run run.toml --out again</pre>"
      "<p>How it was made:</p><table class=facts>";
  for (const auto& [name, value] : provenance.items()) {
    if (!value.is_array()) {
      text += fmt::format("<tr><td>{}<td>{}", escaped(name),
                          escaped(value.is_string() ? value.get<std::string>() : value.dump()));
      continue;
    }
    for (const json& file : value)  // of data
      text += fmt::format("<tr><td>{}<td>{}<br>{}", escaped(name), escaped(file.at("file").get<std::string>()),
                          escaped(file.at("hash").get<std::string>()));
  }
  return text + "</table>\n";
}

}  // namespace gaussdrift::report
