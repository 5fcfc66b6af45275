// Which files in the folder of a run are whole, judged by what each kind of file must end with.
#pragma once

#include <expat.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "scratch_folder.hpp"

namespace gaussdrift {

namespace fs = std::filesystem;

/// Nothing wrong: "".
inline std::string wrong_xml(const std::string& text) {
  XML_Parser parser = XML_ParserCreate(nullptr);
  const bool parses = XML_Parse(parser, text.data(), static_cast<int>(text.size()), 1) == XML_STATUS_OK;
  const std::string wrong = parses ? "" : XML_ErrorString(XML_GetErrorCode(parser));
  XML_ParserFree(parser);
  return wrong;
}

inline std::string wrong_json(const std::string& text) { return nlohmann::json::accept(text) ? "" : "it is no JSON"; }

/// Rows end with a line end, and each has as many columns as the heading.
inline std::string wrong_table(const std::string& text) {
  if (text.empty() || text.back() != '\n') return "its last row is cut short";
  std::istringstream rows(text);
  std::string row;
  std::getline(rows, row);
  const auto columns = std::count(row.begin(), row.end(), ',');
  while (std::getline(rows, row))
    if (std::count(row.begin(), row.end(), ',') != columns) return "a row has not all columns";
  return "";
}

inline std::uint32_t big_endian(const std::string& text, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(text[at + i]);
  return number;
}

/// Every piece of a PNG has a check sum, and the last is called IEND.
inline std::string wrong_png(const std::string& text) {
  if (!text.starts_with("\x89PNG\r\n\x1a\n")) return "it is no PNG";
  for (std::size_t at = 8; at + 12 <= text.size();) {
    const std::size_t length = big_endian(text, at);
    if (at + 12 + length > text.size()) return "it is cut short";
    const auto* piece = reinterpret_cast<const Bytef*>(text.data()) + at + 4;
    if (crc32_z(0, piece, length + 4) != big_endian(text, at + 8 + length)) return "a check sum is wrong";
    if (text.compare(at + 4, 4, "IEND") == 0) return at + 12 + length == text.size() ? "" : "something follows its end";
    at += 12 + length;
  }
  return "it has no end";
}

inline std::string wrong_text(const std::string& text) {
  return text.ends_with('\n') ? "" : "its last line is cut short";
}

inline std::string wrong_page(const std::string& text) {
  return text.ends_with("</html>\n") || text.ends_with("</html>") ? "" : "it is cut short";
}

/// What cannot be read in the folder of a run, a line each. Files with a point ahead are none of the run's.
inline std::string unreadable_in(const fs::path& folder) {
  static const std::map<std::string, std::string (*)(const std::string&)> by_ending{
      {".vti", wrong_xml},  {".vtp", wrong_xml},   {".pvtp", wrong_xml},  {".pvti", wrong_xml},
      {".pvd", wrong_xml},  {".json", wrong_json}, {".csv", wrong_table}, {".png", wrong_png},
      {".txt", wrong_text}, {".toml", wrong_text}, {".py", wrong_text},   {".html", wrong_page}};
  std::string list;
  if (!fs::exists(folder)) return list;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const auto wrong = by_ending.find(entry.path().extension().string());
    if (!entry.is_regular_file() || entry.path().filename().string().starts_with(".") || wrong == by_ending.end())
      continue;
    const std::string why = wrong->second(read_file(entry.path()));
    if (!why.empty()) list += entry.path().string() + ": " + why + "\n";
  }
  return list;
}

/// Hidden files that a process left.
inline std::string left_over_in(const fs::path& folder) {
  std::string list;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().filename().string().starts_with(".")) list += entry.path().filename().string() + " ";
  return list;
}

}  // namespace gaussdrift
