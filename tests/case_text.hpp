// The text of a small case. A test names the tables that matter to it; the others are those of a cone that turns about
// the origin for a short while.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>

namespace gaussdrift {

inline const std::string square = "min = [-1, -1]\nmax = [1, 1]", cube = "min = [-1, -1, -1]\nmax = [1, 1, 1]";
inline const std::string unit_square = "min = [0, 0]\nmax = [1, 1]", unit_cube = "min = [0, 0, 0]\nmax = [1, 1, 1]";
inline const std::string at_rest = R"(u = ["0", "0"])";
inline const std::string not_compared = R"(kind = "none")";

/// The two ends of a run, and nothing on disk for them.
inline const std::string both_ends = "frames = 2\nvtk = []\nimages = []\nreport = \"none\"";
inline std::string output_at(const std::string& times) {
  return "times = [" + times + "]\nvtk = []\nimages = []\nreport = \"none\"";
}

inline std::string velocity_of(std::initializer_list<const char*> components) {
  std::string list;
  for (const std::string component : components) list += (list.empty() ? "\"" : ", \"") + component + "\"";
  return "u = [" + list + "]";
}

inline std::string shape_of(const std::string& name, const std::string& center, const std::string& radius) {
  return "shape = \"" + name + "\"\ncenter = [" + center + "]\nradius = " + radius;
}

/// The lines of the tables. A table of no lines is left out.
struct CaseTables {
  std::string params = {};
  std::string domain = square;
  std::string velocity = velocity_of({"-y", "x"});
  std::string density = shape_of("wendland", "0.3, 0", "0.4");
  std::string particles = "per_axis = 21";
  std::string time = "end = 0.1\nstep = 0.05";
  std::string evaluate = "per_axis = 21";
  std::string reference = {};
  std::string output = both_ends;  // comes last, so keys of it may follow the text
};

inline std::string case_text(const CaseTables& tables = {}) {
  std::string text = "gaussdrift = 1\n";
  for (const auto& [name, lines] : {std::pair<const char*, const std::string&>{"params", tables.params},
                                    {"domain", tables.domain},
                                    {"velocity", tables.velocity},
                                    {"density", tables.density},
                                    {"particles", tables.particles},
                                    {"time", tables.time},
                                    {"evaluate", tables.evaluate},
                                    {"reference", tables.reference},
                                    {"output", tables.output}})
    if (!lines.empty()) text += std::string("\n[") + name + "]\n" + lines + "\n";
  return text;
}

}  // namespace gaussdrift
