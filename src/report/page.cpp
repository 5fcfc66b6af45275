#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "read/written_run.hpp"
#include "render/panel.hpp"
#include "render/picture.hpp"
#include "sim/outside.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::report {

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
  for (const char c : base::printable_lines(text)) {
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

bool is_zero(const json& value) { return !value.is_number() || value.get<double>() == 0; }

// --- the parts of the page ----------------------------------------------------------------------------------------

std::string verdict(const json& summary) {
  const json frames = get(summary, "frames"), checks = get(summary, "checks"), target = get(summary, "accuracy"),
             budget = get(get(summary, "budget"), "measured"), advice = get(get(summary, "budget"), "advice");
  const json last = frames.empty() ? json() : frames.back();
  std::string text;
  if (!last.contains("Linf"))
    text += "The run was compared with nothing, so its error is not known.";
  else if (!last.at("Linf").is_number())
    text += fmt::format("At t = {} {}.", number(last.at("t"), "{:.4g}"),
                        get(last, "no_norms").is_string() ? escaped(last.at("no_norms").get<std::string>())
                                                          : "the error is not a number");
  else
    text += fmt::format("At t = {} the largest error is <b>{}</b> of the largest density (L1 {}, L2 {}).",
                        number(last.at("t"), "{:.4g}"), number(last.at("Linf"), "{:.2e}"),
                        number(last.at("L1"), "{:.2e}"), number(last.at("L2"), "{:.2e}"));
  if (const json worst = get(summary, "worst"); worst.is_object() && worst.at("t") != get(last, "t"))
    text += fmt::format(" The worst output is that at t = {}: {} (L1 {}, L2 {}).", number(worst.at("t"), "{:.4g}"),
                        number(worst.at("Linf"), "{:.2e}"), number(worst.at("L1"), "{:.2e}"),
                        number(worst.at("L2"), "{:.2e}"));
  if (target.is_object())
    text += fmt::format(" Target {}: {}.", number(target.at("target"), "{:g}"),
                        !target.at("achieved").is_number() ? "not known whether it is met"
                        : target.at("met") == json(true)   ? "<b>met</b>"
                                                           : "<b class=bad>missed</b>");
  if (budget.contains("dominates"))
    text += fmt::format(" Most of it is {}.", escaped(budget.at("dominates").get<std::string>()));
  std::size_t failed = 0;
  for (const json& check : checks) failed += !check.at("passed").get<bool>();
  if (!checks.empty())
    text += failed && checks.size() == 1 ? " <b class=bad>The check failed.</b>"
            : failed ? fmt::format(" <b class=bad>{} of {} checks failed.</b>", failed, checks.size())
                     : fmt::format(" {} passed.", checks.size() == 1 ? "The check" : "All checks");
  if (!advice.empty()) text += "<br>Advice: " + escaped(advice.front().get<std::string>()) + ".";
  return text;
}

/// How the errors were measured, as far as a reader would otherwise guess wrongly.
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
        compared.get<std::size_t>(), points.get<std::size_t>());
  if (untraced.is_number() && untraced > 0)
    text +=
        fmt::format(" At {} points of the last output the exact density is not known, and the norms leave them out{}.",
                    untraced.get<std::size_t>(),
                    get(get(summary, "reference"), "trouble").is_string()
                        ? ": " + escaped(summary.at("reference").at("trouble").get<std::string>())
                        : "");
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
    first = std::min(first, frame.at("t").get<double>()), last = std::max(last, frame.at("t").get<double>());
    for (const Curve& curve : curves)
      if (frame.at(curve.name).is_number() && frame.at(curve.name).get<double>() > 0) {
        low = std::min(low, std::log10(frame.at(curve.name).get<double>()));
        high = std::max(high, std::log10(frame.at(curve.name).get<double>()));
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
            "text-anchor=end>{5:.0f}e{6:.0f}</text>",
            left, left + width, y(std::pow(10, at)), left - 8, y(std::pow(10, at)) + 4, factor, k);
  for (double k = std::ceil(low); k <= high; ++k)
    svg += fmt::format(
        "<line x1={0} x2={1} y1={2:.1f} y2={2:.1f} stroke=\"#ddd\"/><text x={3} y={4:.1f} "
        "text-anchor=end>1e{5:.0f}</text>",
        left, left + width, y(std::pow(10, k)), left - 8, y(std::pow(10, k)) + 4, k);
  // Round times, four to eight of them.
  const double power = std::pow(10, std::floor(std::log10((last - first) / 4)));
  const double step = (last - first) / power >= 40   ? 10 * power
                      : (last - first) / power >= 20 ? 5 * power
                      : (last - first) / power >= 8  ? 2 * power
                                                     : power;
  for (double k = std::ceil(first / step - 1e-9); k * step <= last + 1e-9 * step; ++k)
    svg += fmt::format(
        "<line x1={0:.1f} x2={0:.1f} y1={1} y2={2} stroke=\"#888\"/><text x={0:.1f} y={3} "
        "text-anchor=middle>{4:.6g}</text>",
        x(k * step), top + height, top + height + 5, top + height + 20, k == 0 ? 0 : k * step);
  svg += fmt::format("<text x={} y={} text-anchor=middle>t</text>", left + width / 2, top + height + 40);
  double key = top + 18;
  for (const Curve& curve : curves) {
    std::string points;
    for (const json& frame : frames)
      if (frame.contains(curve.name) && frame.at(curve.name).is_number() && frame.at(curve.name).get<double>() > 0) {
        const double a = x(frame.at("t").get<double>()), b = y(frame.at(curve.name).get<double>());
        points += fmt::format("{:.1f},{:.1f} ", a, b);
        if (frames.size() <= 60)
          svg += fmt::format("<circle cx={:.1f} cy={:.1f} r=3 fill=\"{}\"/>", a, b, curve.colour);
      }
    svg += fmt::format(
        "<polyline points=\"{}\" fill=none stroke=\"{}\" stroke-width=2 /><text x={} y={} fill=\"{}\">{}</text>",
        points, curve.colour, left + width + 12, key, curve.colour, curve.name);
    key += 26;
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
    return "<p>Not told apart: " + escaped(measured.at("not_covered").get<std::string>()) + ".";
  std::string text = "<table class=numbers><tr><th class=l>cause<th>predicted<th>measured";
  for (const auto& [key, name] : {std::pair{"time_stepping", "time stepping"},
                                  {"smoothing", "smoothing"},
                                  {"quadrature", "quadrature"},
                                  {"transform", "Gauss transform"},
                                  {"left_out", "particles left out, at most"},
                                  {"total", "total"}}) {
    if (key == std::string("left_out") && is_zero(get(predicted, key)) && is_zero(get(measured, key))) continue;
    const json dominates = get(measured.contains("dominates") ? measured : predicted, "dominates");
    const bool most = dominates.is_string() && std::string(name).starts_with(dominates.get<std::string>());
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
  // Runs from before the particles outside were counted have no such number.
  const bool leaves =
      std::any_of(frames.begin(), frames.end(), [](const json& frame) { return !is_zero(get(frame, "outside")); });
  std::string text = fmt::format("<table class=numbers><tr><th>t<th>mass<th>change{}<th>centroid<th>minimum<th>maximum",
                                 leaves ? "<th>outside the domain" : "");
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
    text += fmt::format("<tr><td class=n>{}<td class=n>{}<td class=n>{}{}<td class=n>{}<td class=n>{}<td class=n>{}",
                        number(frame.at("t"), "{:.5g}"), number(frame.at("mass"), "{:.9g}"),
                        change == 0 ? "0" : fmt::format("{:.1e}", change),
                        !leaves            ? ""
                        : is_zero(outside) ? "<td class=n>0"
                                           : "<td class=n>" + percent_text(outside.get<double>()),
                        centroid, number(frame.at("minimum"), "{:.4g}"), number(frame.at("maximum"), "{:.6g}"));
  }
  text += "</table>";
  if (stride > 1)
    text +=
        fmt::format("<p class=quiet>One of {} of the {} outputs; all are in series.csv.</p>", stride, frames.size());
  return text;
}

constexpr const char* style = R"(
body{font:16px/1.5 system-ui,sans-serif;color:#222;max-width:60rem;margin:2rem auto;padding:0 1rem;overflow-wrap:break-word}
h1{margin-bottom:0;line-height:1.2}
h2{margin-top:2.2rem;border-bottom:1px solid #ddd}
.verdict{font-size:1.15rem;background:#f3f6f9;padding:.8rem 1rem;border-left:4px solid #0072b2}
.warning{background:#fdf3e7;padding:.6rem 1rem;border-left:4px solid #d55e00}
.bad{color:#b02a1a}
.quiet{color:#666}
img,svg{max-width:100%;height:auto}
svg text{font-size:13px}
table{border-collapse:collapse;margin:.6rem 0}
td,th{padding:.2rem .8rem .2rem 0;text-align:left;vertical-align:top}
td.n,.numbers th:not(.l){text-align:right;font-variant-numeric:tabular-nums}
td.n{white-space:nowrap}
tr.most td{font-weight:bold}
.bars{width:100%}
.bars .w{width:60%;padding-right:0}
.bars div{background:#86b6d8;height:1rem}
.facts td:last-child{overflow-wrap:anywhere}
pre{background:#f6f6f6;padding:.8rem;overflow:auto;font-size:.85rem}
.scroll{overflow-x:auto}
@media(max-width:40rem){body{margin:1rem auto}.bars .w{width:35%}svg text{font-size:22px}pre{font-size:.75rem}}
@media print{body{max-width:none;margin:0;font-size:10pt}h2{break-after:avoid}img,svg,tr{break-inside:avoid}
pre{white-space:pre-wrap;overflow-wrap:anywhere}.bars div,.verdict,.warning{print-color-adjust:exact;-webkit-print-color-adjust:exact}}
)";

/// Initial, final, exact and error densities; `notes`: why some or all are missing.
std::vector<render::Panel> panels_of(const fs::path& folder, const json& summary, std::vector<std::string>& notes) {
  std::vector<render::Panel> panels;
  const auto outputs = read::written_outputs(folder);
  if (outputs.empty()) {
    notes.push_back("pictures: the run wrote no density files (output.vtk)");
    return panels;
  }
  const auto add = [&](const read::WrittenOutput& output, const char* array, const char* title, bool error) {
    panels.push_back({title, read::read_density(output.file, array), output.time, error});
  };
  if (outputs.size() > 1) add(outputs.front(), "rho", "initial", false);
  add(outputs.back(), "rho", outputs.size() > 1 ? "final" : "density", false);
  const json frame = summary.at("frames").empty() ? json::object() : summary.at("frames").back();
  const std::size_t points = panels.back().density.lattice.size(), compared = frame.value("compared", points);
  if (!frame.contains("Linf")) {
    notes.push_back("pictures of the exact density and the error: the run was compared with nothing");
  } else if (compared < points) {
    notes.push_back(
        fmt::format("pictures of the exact density and the error: the run was compared at a sample, {} of the {} grid "
                    "points (reference.points sets how many)",
                    compared, points));
  } else {
    try {
      add(outputs.back(), "rho_exact", "exact", false);
      add(outputs.back(), "error", "error", true);
    } catch (const FileError& error) {
      notes.push_back(fmt::format("pictures of the exact density and the error: {}", error.what()));
    }
  }
  return panels;
}

void draw_summary(const fs::path& folder, const json& summary, ReportFiles& result) {
  const fs::path file = folder / "summary.png";
  std::error_code ignored;
  fs::remove(file, ignored);  // an older one must not pass for this
  if (const std::string reason = render::unavailable_reason(); !reason.empty()) {
    result.left_out.push_back("pictures: " + reason);
    return;
  }
  std::vector<render::Panel> panels;
  try {
    panels = panels_of(folder, summary, result.left_out);
  } catch (const Error& error) {  // densities that cannot be read
    result.left_out.push_back(fmt::format("pictures: {}", error.what()));
    return;
  }
  if (panels.empty()) return;
  try {
    render::draw_panels(panels, file);
    result.written.push_back(file);
  } catch (const Error& error) {
    result.failed.push_back(error.what());
  }
}

/// A file that cannot be written is named at the end.
void write_file(const fs::path& file, const std::string& text, ReportFiles& result) {
  try {
    write::write_text(file, text);
    result.written.push_back(file);
  } catch (const FileError& error) {
    result.failed.push_back(error.what());
  }
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

/// How many particles there are, and what the lattice points without one would have carried.
std::string particles(const json& summary) {
  const json count = get(summary, "particles"), left_out = get(count, "left_out");
  if (!get(count, "carried").is_number()) return "";
  std::string text =
      fmt::format("<h2>Particles</h2><p>{} on a lattice of {} points, {} apart.", number(count.at("carried"), "{:.0f}"),
                  number(get(count, "lattice_points"), "{:.0f}"), number(get(count, "spacing"), "{:.4g}"));
  if (!is_zero(left_out))
    text += fmt::format(
        " {} points with less than {} of the largest weight have none (particles.threshold): with them {} of the "
        "mass{} "
        "is left out.",
        number(left_out, "{:.0f}"), number(get(count, "threshold"), "{:g}"),
        number(get(count, "mass_left_out"), "{:.1e}"),
        count.contains("charge_left_out")
            ? fmt::format(" and {} of the charge", number(count.at("charge_left_out"), "{:.1e}"))
            : "");
  return text + "</p>\n";
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

ReportFiles write_page(const fs::path& folder, const json& summary, bool pictures) {
  ReportFiles result;
  std::vector<std::string> by_choice;  // what the case did without
  const json provenance = json::parse(read_text(folder / "provenance.json"), nullptr, false);
  const json frames = summary.at("frames"), last = frames.empty() ? json::object() : frames.back();
  const bool compared = last.contains("Linf");
  const json untraced = get(last, "untraced");

  if (pictures) {
    draw_summary(folder, summary, result);
  } else {
    by_choice.push_back("pictures: the case wants none (output.images); gaussdrift report draws them all the same");
  }

  const std::string title = summary.at("title").get<std::string>().empty() ? summary.at("case").get<std::string>()
                                                                           : summary.at("title").get<std::string>();
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=en><meta charset=utf-8><meta name=viewport "
      "content=\"width=device-width,initial-scale=1\">"
      "<title>{0}</title><style>{1}</style>\n<h1>{0}</h1><p class=quiet>{2}, by gaussdrift {3}</p>\n<p "
      "class=verdict>{4}</p>\n",
      escaped(title), style, escaped(summary.at("case").get<std::string>()),
      escaped(get(provenance, "version").is_string() ? provenance.at("version").get<std::string>() : ""),
      verdict(summary));
  for (const json& warning : get(summary, "warnings"))
    page += fmt::format("<p class=warning><b>Warning:</b> {}</p>\n", escaped(warning.get<std::string>()));
  if (const std::string picture = read_text(folder / "summary.png"); !picture.empty()) {
    page += fmt::format(
        "<p><img alt=\"the densities of the first and the last output, the exact one and the error where they are "
        "known\" src=\"data:image/png;base64,{}\"></p>\n",
        base64(picture));
    if (untraced.is_number() && untraced > 0)
      page += "<p class=quiet>Red in the exact density and grey in the error: points where it is not known.</p>\n";
  }
  if (compared) {
    const std::string curves = error_curves(frames);
    page += fmt::format("<h2>Error over time</h2><p>{}</p>{}\n", about_comparison(summary, last), curves);
    if (curves.empty()) by_choice.push_back("a curve of the error over time: the run was compared at one time only");
  } else {
    by_choice.push_back("errors: the run was compared with nothing (reference.kind)");
  }
  if (summary.contains("budget"))
    page += "<h2>Where the error comes from</h2>" + budget_table(summary.at("budget")) + "\n";
  else if (compared)
    by_choice.push_back("where the error comes from: accuracy.budget = \"none\"");
  if (const json table = get(summary, "accuracy_table"); !table.empty()) {
    page +=
        "<h2>What digits of the sum cost</h2><p>The Gauss transform of the last output, done again: tolerance asked "
        "for, error measured against the direct sum on a sample, both relative to the largest density; milliseconds, "
        "the fastest of some.</p><table class=numbers><tr><th>tolerance<th>error<th>ms";
    for (const json& row : table)
      page += fmt::format("<tr><td class=n>{}<td class=n>{}<td class=n>{}", number(row.at("tolerance"), "{:.0e}"),
                          number(row.at("error"), "{:.1e}"), number(row.at("milliseconds"), "{:.3g}"));
    page += "</table>\n";
    if (const json note = get(summary, "accuracy_table_note"); note.is_string())
      page += "<p class=quiet>" + escaped(note.get<std::string>()) + "</p>\n";
  } else if (const json why = get(summary, "accuracy_table_left_out"); why.is_string()) {
    by_choice.push_back("what digits of the sum cost: " + why.get<std::string>());
  }
  page += particles(summary);
  page += seconds(summary);
  if (!frames.empty()) page += "<h2>Conservation</h2><div class=scroll>" + conservation(frames) + "</div>\n";
  if (const json checks = get(summary, "checks"); !checks.empty()) {
    page +=
        "<h2>Checks</h2><div class=scroll><table class=numbers><tr><th class=l>what<th>value<th>at t<th>at least<th>at "
        "most<th>";
    for (const json& check : checks)
      page += fmt::format("<tr><td>{}<td class=n>{}<td class=n>{}<td class=n>{}<td class=n>{}<td>{}",
                          escaped(check.at("what").get<std::string>()), number(check.at("value"), "{:.4g}"),
                          number(check.at("t"), "{:.4g}"), number(check.at("min")), number(check.at("max")),
                          check.at("passed").get<bool>() ? "passed" : "<b class=bad>failed</b>");
    page += "</table></div>\n";
  }
  std::vector<std::string> absent = result.left_out;
  for (const std::string& why : result.failed) absent.push_back("pictures: " + why);
  absent.insert(absent.end(), by_choice.begin(), by_choice.end());
  if (!absent.empty()) {
    page += "<h2>What is not on this page</h2><ul>";
    for (const std::string& what : absent) page += "<li>" + escaped(what);
    page += "</ul>\n";
  }
  if (const std::string resolved = read_text(folder / "run.toml"); !resolved.empty())
    page += "<h2>The case, with all defaults</h2><pre>" + escaped(resolved) + "</pre>\n";
  if (provenance.is_object()) page += how_to_make_again(provenance);
  page += "</html>\n";
  write_file(folder / "report.html", page, result);

  json report = summary;
  report["not_on_the_page"] = absent;
  if (provenance.is_object()) report["provenance"] = provenance;
  write_file(folder / "report.json", report.dump(2, ' ', false, json::error_handler_t::replace) + "\n", result);
  return result;
}

}  // namespace

ReportFiles write_report(const fs::path& folder, bool pictures) {
  const std::string text = read_text(folder / "summary.json");
  if (text.empty()) throw FileError(fmt::format("{} holds no finished run: there is no summary.json", folder.string()));
  const auto damaged = [&] {
    return FileError(fmt::format("{} is damaged: run the case again", (folder / "summary.json").string()));
  };
  const json summary = json::parse(text, nullptr, false);
  for (const char* name : {"frames", "title", "case", "effects"})
    if (!summary.is_object() || !summary.contains(name)) throw damaged();
  try {
    return write_page(folder, summary, pictures);
  } catch (const json::exception&) {  // members of other types than they should have
    throw damaged();
  }
}

}  // namespace gaussdrift::report
