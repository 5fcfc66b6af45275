#include "read/velocity_units.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>
#include <vector>

#include "read/calendar.hpp"

namespace gaussdrift::read {

namespace {

std::string lower(std::string_view text) {
  std::string all;
  for (const char c : text) all += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return all;
}

}  // namespace

std::string length_unit(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 24> known{{{"m", "m"},
                                                                                 {"meter", "m"},
                                                                                 {"meters", "m"},
                                                                                 {"metre", "m"},
                                                                                 {"metres", "m"},
                                                                                 {"km", "km"},
                                                                                 {"kilometer", "km"},
                                                                                 {"kilometers", "km"},
                                                                                 {"kilometre", "km"},
                                                                                 {"kilometres", "km"},
                                                                                 {"cm", "cm"},
                                                                                 {"centimeter", "cm"},
                                                                                 {"centimeters", "cm"},
                                                                                 {"mm", "mm"},
                                                                                 {"degree", "degree"},
                                                                                 {"degrees", "degree"},
                                                                                 {"degree_east", "degree"},
                                                                                 {"degrees_east", "degree"},
                                                                                 {"degree_e", "degree"},
                                                                                 {"degrees_e", "degree"},
                                                                                 {"degree_north", "degree"},
                                                                                 {"degrees_north", "degree"},
                                                                                 {"degree_n", "degree"},
                                                                                 {"degrees_n", "degree"}}};
  const std::string name = lower(text);
  for (const auto& [word, unit] : known)
    if (word == name) return std::string(unit);
  return "";
}

std::optional<VelocityUnits> read_velocity_units(std::string_view text) {
  std::string plain = lower(text);
  // One form: "m s-1".
  for (const std::string_view sign : {"**", "^"})
    for (std::size_t at = plain.find(sign); at != std::string::npos; at = plain.find(sign))
      plain.erase(at, sign.size());
  if (const std::size_t slash = plain.find('/'); slash != std::string::npos) {
    plain[slash] = ' ';
    plain += "-1";
  }
  std::replace(plain.begin(), plain.end(), '.', ' ');
  std::vector<std::string> words;
  std::string word;
  for (const char c : plain + " ") {
    if (!std::isspace(static_cast<unsigned char>(c)))
      word += c;
    else if (!word.empty())
      words.push_back(std::exchange(word, ""));
  }
  if (words.size() == 3 && words[1] == "per") words = {words[0], words[2] + "-1"};
  if (words.size() != 2 || words[1].size() < 3 || words[1].substr(words[1].size() - 2) != "-1") return std::nullopt;
  const std::string length = length_unit(words[0]);
  const auto seconds = seconds_of_unit(words[1].substr(0, words[1].size() - 2));
  if (length.empty() || !seconds) return std::nullopt;
  return VelocityUnits{length, *seconds};
}

}  // namespace gaussdrift::read
