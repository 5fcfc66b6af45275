// Links from the page to what the run has left beside it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "report/reel.hpp"
#include "report/sections.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::report {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 12> meanings{
    {{"tracks.vtp", "paths of particles, for ParaView"},
     {"tracks.nc", "paths of particles, NetCDF"},
     {"tracks.csv", "paths of particles"},
     {"view.py", "opens the series in ParaView"},
     {"series.csv", "numbers of every output"},
     {"summary.json", "all numbers, and what was chosen"},
     {"summary.png", "the picture above"},
     {reel_file, "what this page plays"},
     {"run.toml", "the case with all defaults"},
     {"case.toml", "the case as it was"},
     {"provenance.json", "how the run was made"},
     {"log.txt", "what was said"}}};

/// A name as an address: letters, digits and a few signs stand for themselves.
std::string address(std::string_view name) {
  std::string safe;
  for (const unsigned char c : name)
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
        std::string_view("-_./").find(static_cast<char>(c)) != std::string_view::npos)
      safe += static_cast<char>(c);
    else
      safe += fmt::format("%{:02X}", c);
  return safe;
}

std::string link(const std::string& name, const std::string& text) {
  return fmt::format("<a href=\"{}\">{}</a>", address(name), escaped(text));
}

bool is_file(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(fs::symlink_status(file, ignored));
}

/// By style, "heatmap", the numbers of their outputs.
std::vector<std::pair<std::string, std::vector<std::string>>> pictures_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  if (!fs::is_directory(fs::symlink_status(folder, ignored))) return {};
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (is_file(entry.path()) && entry.path().extension() == ".png") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  std::vector<std::pair<std::string, std::vector<std::string>>> styles;
  for (const std::string& name : names) {
    const std::size_t cut = std::min(name.rfind('_'), name.size());
    const std::string style = name.substr(0, cut);
    if (styles.empty() || styles.back().first != style) styles.push_back({style, {}});
    styles.back().second.push_back(cut < name.size() ? name.substr(cut + 1) : "");
  }
  return styles;
}

}  // namespace

std::string linked_files(const fs::path& folder) {
  std::string rows;
  for (const write::FileKind& kind : write::output_files())
    if (const std::string series = std::string(kind.about.name) + ".pvd"; is_file(folder / series))
      rows += fmt::format("<tr><td>{}<td>{}, for ParaView", link(series, series), kind.about.meaning);
  for (const auto& [name, meaning] : meanings)
    if (is_file(folder / name))
      rows += fmt::format("<tr><td>{}<td>{}", link(std::string(name), std::string(name)), meaning);
  constexpr std::size_t most = 24;  // links of a style
  for (const auto& [style, numbers] : pictures_in(folder / "images")) {
    rows += fmt::format("<tr><td>{}<td>", link("images", "images/" + style));
    const std::size_t stride = (numbers.size() + most - 1) / most;
    for (std::size_t i = 0; i < numbers.size(); i += stride) {
      const std::string& number = numbers[i];
      rows += link("images/" + style + (number.empty() ? "" : "_") + number + ".png", number.empty() ? style : number);
      rows += " ";
    }
    if (stride > 1) rows += fmt::format("(one of {})", stride);
  }
  if (rows.empty()) return "";
  return "<h2>Files of the run</h2><p class=quiet>They lie in the folder of this page.</p><table class=facts>" + rows +
         "</table>\n";
}

}  // namespace gaussdrift::report
