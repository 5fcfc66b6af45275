#include "study/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "base/error.hpp"
#include "read/grid_file.hpp"
#include "render/panel.hpp"
#include "render/picture.hpp"
#include "sim/frame.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::study {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

namespace {

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return "";
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else
      safe += c;
  }
  return safe;
}

std::string base64(const std::string& bytes) {
  constexpr const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k])) : 0u;
    };
    const unsigned three = byte(0) << 16 | byte(1) << 8 | byte(2);
    text += letters[three >> 18 & 63];
    text += letters[three >> 12 & 63];
    text += i + 1 < bytes.size() ? letters[three >> 6 & 63] : '=';
    text += i + 2 < bytes.size() ? letters[three & 63] : '=';
  }
  return text;
}

std::string number(const json& value, const char* format = "{:.3g}") {
  return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : "–";
}

/// A member, or null.
json get(const json& object, const char* name) {
  return object.is_object() && object.contains(name) ? object[name] : json(nullptr);
}

// --- the parts of the page ----------------------------------------------------------------------------------------

std::string verdict(const json& summary) {
  const json frames = get(summary, "frames"), checks = get(summary, "checks"),
             budget = get(get(summary, "budget"), "measured");
  std::string text;
  if (!frames.empty() && frames.back().contains("Linf"))
    text += fmt::format("At t = {} the largest error is <b>{}</b> of the largest density (L1 {}, L2 {}).",
                        number(frames.back()["t"], "{:.4g}"), number(frames.back()["Linf"], "{:.2e}"),
                        number(frames.back()["L1"], "{:.2e}"), number(frames.back()["L2"], "{:.2e}"));
  else
    text += "The run was compared with nothing, so its error is not known.";
  if (budget.contains("dominates"))
    text += fmt::format(" Most of it is {}.", escaped(budget["dominates"].get<std::string>()));
  std::size_t failed = 0;
  for (const json& check : checks) failed += !check["passed"].get<bool>();
  if (!checks.empty())
    text += failed ? fmt::format(" <b class=bad>{} of {} checks failed.</b>", failed, checks.size())
                   : fmt::format(" {} passed.", checks.size() == 1 ? "The check" : "All checks");
  return text;
}

/// Curves over time on a logarithmic axis.
std::string error_curves(const json& frames) {
  struct Curve {
    const char *name, *colour;
  };
  constexpr std::array<Curve, 3> curves{{{"Linf", "#d55e00"}, {"L2", "#0072b2"}, {"L1", "#009e73"}}};
  double first = INFINITY, last = -INFINITY, low = INFINITY, high = -INFINITY;
  for (const json& frame : frames) {
    if (!frame.contains("Linf")) continue;
    first = std::min(first, frame["t"].get<double>()), last = std::max(last, frame["t"].get<double>());
    for (const Curve& curve : curves)
      if (frame[curve.name].is_number() && frame[curve.name].get<double>() > 0) {
        low = std::min(low, std::log10(frame[curve.name].get<double>()));
        high = std::max(high, std::log10(frame[curve.name].get<double>()));
      }
  }
  if (!(last > first) || !(high >= low)) return "";
  low = std::floor(low * 2 - 0.1) / 2, high = std::ceil(high * 2 + 0.1) / 2;
  constexpr double left = 70, top = 14, width = 560, height = 230;
  const auto x = [&](double t) { return left + width * (t - first) / (last - first); };
  const auto y = [&](double value) { return top + height * (high - std::log10(value)) / (high - low); };
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 720 300\" role=img aria-label=\"errors over time\"><rect x={} y={} width={} height={} "
      "fill=none stroke=\"#888\"/>",
      left, top, width, height);
  // Between few powers of ten 2 and 5 times them are shown, too.
  for (double k = std::floor(low); high - low < 1.6 && k <= high; ++k)
    for (const double factor : {2., 5.})
      if (const double at = k + std::log10(factor); at >= low && at <= high)
        svg += fmt::format(
            "<line x1={0} x2={1} y1={2:.1f} y2={2:.1f} stroke=\"#eee\"/><text x={3} y={4:.1f} "
            "text-anchor=end>{5:.0e}</text>",
            left, left + width, y(std::pow(10, at)), left - 8, y(std::pow(10, at)) + 4, std::pow(10, at));
  for (double k = std::ceil(low); k <= high; ++k)
    svg += fmt::format(
        "<line x1={0} x2={1} y1={2:.1f} y2={2:.1f} stroke=\"#ddd\"/><text x={3} y={4:.1f} "
        "text-anchor=end>1e{5:.0f}</text>",
        left, left + width, y(std::pow(10, k)), left - 8, y(std::pow(10, k)) + 4, k);
  for (const double t : {first, 0.5 * (first + last), last})
    svg += fmt::format("<text x={:.1f} y={} text-anchor=middle>{:.4g}</text>", x(t), top + height + 20, t);
  svg += fmt::format("<text x={} y={} text-anchor=middle>t</text>", left + width / 2, top + height + 40);
  double key = top + 14;
  for (const Curve& curve : curves) {
    std::string points;
    for (const json& frame : frames)
      if (frame.contains(curve.name) && frame[curve.name].is_number() && frame[curve.name].get<double>() > 0) {
        const double a = x(frame["t"].get<double>()), b = y(frame[curve.name].get<double>());
        points += fmt::format("{:.1f},{:.1f} ", a, b);
        svg += fmt::format("<circle cx={:.1f} cy={:.1f} r=3 fill=\"{}\"/>", a, b, curve.colour);
      }
    svg += fmt::format(
        "<polyline points=\"{}\" fill=none stroke=\"{}\" stroke-width=2 /><text x={} y={} fill=\"{}\">{}</text>",
        points, curve.colour, left + width + 12, key, curve.colour, curve.name);
    key += 20;
  }
  return svg + "</svg>";
}

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

std::string budget_table(const json& budget) {
  const json predicted = get(budget, "predicted"), measured = get(budget, "measured");
  if (measured.contains("not_covered") && predicted.contains("not_covered"))
    return "<p>Not told apart: " + escaped(measured["not_covered"].get<std::string>()) + ".";
  std::string text = "<table><tr><th>cause<th>predicted<th>measured";
  for (const auto& [key, name] : {std::pair{"time_stepping", "time stepping"},
                                  {"smoothing", "smoothing"},
                                  {"quadrature", "quadrature"},
                                  {"transform", "Gauss transform"},
                                  {"total", "total"}}) {
    const bool most = get(measured.contains("dominates") ? measured : predicted, "dominates") == json(name);
    text += fmt::format("<tr{}><td>{}<td class=n>{}<td class=n>{}", most ? " class=most" : "", name,
                        number(get(predicted, key), "{:.1e}"), number(get(measured, key), "{:.1e}"));
  }
  text += "</table>";
  if (const json advice = get(budget, "advice"); !advice.empty()) {
    text += "<ul>";
    for (const json& line : advice) text += "<li>" + escaped(line.get<std::string>());
    text += "</ul>";
  }
  return text;
}

std::string conservation(const json& frames) {
  std::string text = "<table><tr><th>t<th>mass<th>change<th>centroid<th>minimum<th>maximum";
  const double begun = frames.front()["mass"].get<double>();
  for (const json& frame : frames) {
    std::string centroid;
    for (const json& x : frame["centroid"]) centroid += (centroid.empty() ? "" : ", ") + number(x, "{:.5g}");
    text += fmt::format("<tr><td class=n>{}<td class=n>{}<td class=n>{:.1e}<td class=n>{}<td class=n>{}<td class=n>{}",
                        number(frame["t"], "{:.5g}"), number(frame["mass"], "{:.9g}"),
                        begun != 0 ? frame["mass"].get<double>() / begun - 1 : 0, centroid,
                        number(frame["minimum"], "{:.4g}"), number(frame["maximum"], "{:.6g}"));
  }
  return text + "</table>";
}

constexpr const char* style =
    "body{font:16px/1.5 system-ui,sans-serif;color:#222;max-width:60rem;margin:2rem auto;padding:0 "
    "1rem}h1{margin-bottom:0}"
    "h2{margin-top:2.2rem;border-bottom:1px solid #ddd}.verdict{font-size:1.15rem;background:#f3f6f9;padding:.8rem "
    "1rem;"
    "border-left:4px solid "
    "#0072b2}.warning{background:#fdf3e7;padding:.6rem 1rem;border-left:4px solid "
    "#d55e00}.bad{color:#b02a1a}img,svg{max-width:100%;height:auto}table{border-collapse:collapse;"
    "margin:.6rem 0}td,th{padding:.2rem .8rem .2rem 0;text-align:left;vertical-align:top}td.n{text-align:right;"
    "font-variant-numeric:tabular-nums}tr.most td{font-weight:bold}.bars{width:100%}.bars .w{width:60%}.bars "
    "div{background:"
    "#86b6d8;height:1rem}pre{background:#f6f6f6;padding:.8rem;overflow:auto;font-size:.85rem}small,.quiet{color:#666}"
    "svg text{font-size:13px}.scroll{overflow-x:auto}";

/// Initial, final, exact and error densities in one picture; false where the run left no density files.
bool draw_summary(const fs::path& folder, const json& summary) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder / "density")) return false;
  for (const auto& entry : fs::directory_iterator(folder / "density"))
    if (entry.path().extension() == ".vti") files.push_back(entry.path());
  if (files.empty()) return false;
  std::sort(files.begin(), files.end());
  const json frames = summary["frames"];
  std::vector<render::Panel> panels;
  const auto add = [&](const fs::path& file, const char* array, const std::string& title, const json& frame,
                       bool error) {
    try {
      panels.push_back({title, read_density(file, array), frame["t"].get<double>(), error});
    } catch (const FileError&) {  // an array that the run did not write, or with values that are not known
    }
  };
  add(files.front(), "rho", "initial", frames.front(), false);
  if (files.size() > 1) add(files.back(), "rho", "final", frames.back(), false);
  add(files.back(), "rho_exact", "exact", frames.back(), false);
  add(files.back(), "error", "error", frames.back(), true);
  if (panels.empty()) return false;
  render::draw_panels(panels, folder / "summary.png");
  return true;
}

}  // namespace

DensityGrid read_density(const fs::path& file, const std::string& array) {
  const auto has = [&](int dimension) {
    try {
      read::read_grid(file, "rho", dimension, 1, 1);
      return true;
    } catch (const read::GridFileError&) {
      return false;
    }
  };
  const int dimension = has(2) ? 2 : 3;
  try {
    const auto data = read::read_grid(file, array, dimension, 1, 1);
    DensityGrid density;
    density.lattice.dimension = dimension;
    density.lattice.spacing = data->axis[0][1] - data->axis[0][0];
    for (int k = 0; k < dimension; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      density.lattice.points[axis] = data->axis[axis].size();
      density.lattice.origin[axis] = data->axis[axis].front();
    }
    density.rho = data->values.front();
    return density;
  } catch (const read::GridFileError& error) {
    throw FileError(error.what());
  }
}

ReportFiles write_report(const fs::path& folder, bool pictures) {
  ReportFiles result;
  const std::string text = read_text(folder / "summary.json");
  if (text.empty()) throw FileError(fmt::format("{} holds no finished run: there is no summary.json", folder.string()));
  const json summary = json::parse(text, nullptr, false);
  const auto lacks = [&](const char* name) { return !summary.contains(name); };
  if (summary.is_discarded() || !summary.is_object() || lacks("frames") || lacks("title") || lacks("case") ||
      lacks("effects"))
    throw FileError(fmt::format("{} is damaged: run the case again", (folder / "summary.json").string()));
  const json provenance = json::parse(read_text(folder / "provenance.json"), nullptr, false);
  const json frames = summary["frames"];
  const bool compared = !frames.empty() && frames.back().contains("Linf");

  if (pictures && render::unavailable_reason().empty()) {
    if (draw_summary(folder, summary))
      result.written.push_back(folder / "summary.png");
    else
      result.left_out.push_back("pictures: the run left no density files");
  }

  const std::string title = summary["title"].get<std::string>().empty() ? summary["case"].get<std::string>()
                                                                        : summary["title"].get<std::string>();
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=en><meta charset=utf-8><meta name=viewport "
      "content=\"width=device-width,initial-scale=1\">"
      "<title>{0}</title><style>{1}</style>\n<h1>{0}</h1><p class=quiet>{2}, by gaussdrift {3}</p>\n<p "
      "class=verdict>{4}</p>\n",
      escaped(title), style, escaped(summary["case"].get<std::string>()),
      escaped(get(provenance, "version").is_string() ? provenance["version"].get<std::string>() : ""),
      verdict(summary));
  for (const json& warning : get(summary, "warnings"))
    page += fmt::format("<p class=warning><b>Warning:</b> {}</p>\n", escaped(warning.get<std::string>()));
  if (const std::string picture = read_text(folder / "summary.png"); !picture.empty())
    page += fmt::format(
        "<p><img alt=\"initial, final and exact density, and the error\" src=\"data:image/png;base64,{}\"></p>\n",
        base64(picture));
  if (const std::string curves = compared ? error_curves(frames) : ""; !curves.empty())
    page += fmt::format("<h2>Error over time</h2><p>Relative to the exact density of the same time.</p>{}\n", curves);
  if (summary.contains("budget"))
    page += "<h2>Where the error comes from</h2>" + budget_table(summary["budget"]) + "\n";
  if (const json table = get(summary, "accuracy_table"); !table.empty()) {
    page +=
        "<h2>What digits of the sum cost</h2><p>The last output, summed again: tolerance asked for, error measured "
        "against the "
        "direct sum, milliseconds.</p><table><tr><th>tolerance<th>error<th>ms";
    for (const json& row : table)
      page += fmt::format("<tr><td class=n>{}<td class=n>{}<td class=n>{}", number(row["tolerance"], "{:.0e}"),
                          number(row["error"], "{:.1e}"), number(row["milliseconds"], "{:.3g}"));
    page += "</table>\n";
  }
  std::vector<std::pair<std::string, double>> stages;
  const json spent = get(summary, "seconds");  // items() refers to it
  for (const auto& [name, seconds] : spent.items())
    if (name != "total") stages.emplace_back(name, seconds.get<double>());
  page += fmt::format("<h2>Seconds</h2><p>{} s in all on {} threads.</p>{}\n",
                      number(get(get(summary, "seconds"), "total"), "{:.3g}"),
                      number(get(summary, "threads"), "{:.0f}"), bars(stages));
  page += "<table><tr><th>effect<th>equation<th>seconds<th>conserves";
  for (const json& effect : summary["effects"])
    page += fmt::format("<tr><td>{}<td>{}<td class=n>{}<td>{}", escaped(effect["name"].get<std::string>()),
                        escaped(effect["equation"].get<std::string>()), number(effect["seconds"], "{:.2g}"),
                        escaped(effect["conserves"].get<std::string>()));
  page += "</table>\n";
  if (!frames.empty()) page += "<h2>Conservation</h2><div class=scroll>" + conservation(frames) + "</div>\n";
  if (const json checks = get(summary, "checks"); !checks.empty()) {
    page += "<h2>Checks</h2><table><tr><th>what<th>value<th>at t<th>at least<th>at most<th>";
    for (const json& check : checks)
      page += fmt::format("<tr><td>{}<td class=n>{}<td class=n>{}<td class=n>{}<td class=n>{}<td>{}",
                          escaped(check["what"].get<std::string>()), number(check["value"], "{:.4g}"),
                          number(check["t"], "{:.4g}"), number(check["min"]), number(check["max"]),
                          check["passed"].get<bool>() ? "passed" : "<b class=bad>failed</b>");
    page += "</table>\n";
  }
  if (const std::string resolved = read_text(folder / "run.toml"); !resolved.empty())
    page += "<h2>The case, with all defaults</h2><pre>" + escaped(resolved) + "</pre>\n";
  if (provenance.is_object()) {
    page += "<h2>How to make it again</h2><pre>gaussdrift run run.toml</pre><table>";
    for (const auto& [name, value] : provenance.items())
      page += fmt::format("<tr><td>{}<td>{}", escaped(name),
                          escaped(value.is_string() ? value.get<std::string>() : value.dump()));
    page += "</table>\n";
  }
  page += "</html>\n";
  write::write_text(folder / "report.html", page);
  result.written.push_back(folder / "report.html");

  json report = summary;
  if (provenance.is_object()) report["provenance"] = provenance;
  write::write_text(folder / "report.json", report.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
  result.written.push_back(folder / "report.json");
  return result;
}

}  // namespace gaussdrift::study
