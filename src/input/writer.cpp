#include "input/writer.hpp"

#include <cmath>

#include "input/data_files.hpp"

namespace gaussdrift::input {

std::string written(double value) {
  if (value == 0 && std::signbit(value)) return "-0.0";  // -0 would be a whole number and lose its sign
  return fmt::format("{}", value);
}

std::string written(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += fmt::format("\\{}", c);
    else if (code < 0x20 || code == 0x7F)
      out += fmt::format("\\u{:04X}", code);
    else
      out += c;
  }
  return out + "\"";
}

void Writer::table(std::string_view name) { text_ += fmt::format("\n[{}]\n", name); }

void Writer::part(std::string_view name, std::size_t count) {
  text_ += count == 1 ? fmt::format("\n[{}]\n", name) : fmt::format("\n[[{}]]\n", name);
}

void Writer::entry(std::string_view name, const std::string& value) { text_ += fmt::format("{} = {}\n", name, value); }

void Writer::arguments(std::string_view table, const std::string& named, const Arguments& list) {
  for (const auto& [name, values] : list) {
    const bool single = find_key(table, name, named).type == Type::number;
    if (!single || std::isfinite(values[0])) entry(name, single ? written(values[0]) : written(values));
  }
}

std::string Writer::data_file(const std::filesystem::path& file) const {
  return written((folder_.empty() ? file : seen_from(folder_, file)).generic_string());
}

}  // namespace gaussdrift::input
