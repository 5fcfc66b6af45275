#include "report/player.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "gaussdrift/error.hpp"
#include "render/styles.hpp"
#include "report/reel_series.hpp"
#include "report/run_files.hpp"
#include "report/sections.hpp"

namespace gaussdrift::report {

namespace {

/// Colours from one end of a map to the other, as red, green and blue in hexadecimal digits.
std::string digits_of(render::Colour (*map)(double)) {
  constexpr int steps = 90;  // a multiple of those of the maps, between which they are linear
  std::string digits;
  for (int i = 0; i <= steps; ++i)
    for (const unsigned part : map(static_cast<double>(i) / steps)) digits += fmt::format("{:02x}", part);
  return digits;
}

/// JSON inside of a script: no text in it can end the script.
std::string for_script(const json& facts) {
  std::string safe;
  for (const char c : facts.dump(-1, ' ', true, json::error_handler_t::replace))
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  return safe;
}

}  // namespace

std::string page_file(std::string_view name) {
  const auto& files = page_files();
  const auto file = std::find_if(files.begin(), files.end(), [&](const PageFile& one) { return one.name == name; });
  if (file == files.end()) throw std::out_of_range("no file of the page is called " + std::string(name));
  return std::string(file->bytes);
}

std::optional<Reel> kept_reel(const std::filesystem::path& folder) {
  const std::string kept = read_file_of_run(folder / reel_file);
  return kept.empty() ? std::nullopt : std::optional(Reel::from_text(kept));
}

std::optional<Reel> reel_of_run(const std::filesystem::path& folder, const PageSpec& wish,
                                std::vector<std::string>& notes) {
  if (!wish.plays) {
    notes.push_back("the run, played: the case wants a page that stands still (output.report)");
    return std::nullopt;
  }
  try {
    std::optional<Reel> reel = kept_reel(folder);
    if (!reel) reel = reel_from_files(folder, most_reel_bytes(wish));
    if (!reel->frames().empty()) return reel;
    notes.push_back(fmt::format("the run, played: there are neither frames of it ({}) nor density files", reel_file));
  } catch (const Error& error) {
    notes.push_back(fmt::format("the run, played: {}", error.what()));
  }
  return std::nullopt;
}

std::string player_section(const Reel& reel, const json& summary) {
  const json facts{{"label", label_of(summary)},
                   {"plain", "viridis"},
                   {"signed", "blue, white, red"},
                   {"maps",
                    {{"viridis", digits_of(render::panel_style(2).colours)},
                     {"blue, white, red", digits_of(render::panel_style(2, true).colours)}}}};
  std::string section = page_file("player.html");
  section += "<script type=\"application/json\" id=\"player-facts\">" + for_script(facts) + "</script>\n";
  section += "<script type=\"application/octet-stream\" id=\"frames\">" + base64(reel.text()) + "</script>\n";
  section += "<script type=\"module\">\n";
  for (const char* script : {"reel.js", "fields.js", "plot.js", "volume.js", "player.js"}) section += page_file(script);
  return section + "</script>\n";
}

}  // namespace gaussdrift::report
