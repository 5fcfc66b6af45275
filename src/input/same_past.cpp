#include "input/same_past.hpp"

#include <algorithm>
#include <map>
#include <sstream>

#include "gaussdrift/read_case.hpp"
#include "input/data_files.hpp"

namespace gaussdrift::input {

namespace {

Case without_future(Case spec) {
  spec.title.clear();
  spec.cite.clear();
  spec.label = Case{}.label;
  // What particles remember, and where tracks began, are of the past.
  OutputSpec past;
  past.tracks = spec.output.tracks;
  for (const GridField& field : spec.output.fields)
    if (field.is_of_particles) past.fields.push_back(field);
  // The frames so far are those that an animation wants; what is made of them is of the future.
  if (const auto& animation = spec.output.animation)
    past.animation = AnimationSpec{.kind = "any", .frames = animation->frames};
  spec.output = past;
  spec.time.end = spec.time.backwards ? 1 : 0;  // the direction belongs to the past
  spec.accuracy = {};
  spec.checks.clear();
  return with_bare_names(std::move(spec));
}

/// "time.step" -> "0.01"; the second [[velocity]] is "velocity[2].u".
std::map<std::string, std::string> values_of(const std::string& text) {
  std::map<std::string, std::string> values;
  std::map<std::string, int> tables;
  std::istringstream lines(text);
  lines.exceptions(std::ios::badbit);  // a stream keeps silent where there is no memory, and a key would be overlooked
  std::string table, line;
  while (std::getline(lines, line)) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == '[') {
      const std::size_t begin = line.find_first_not_of('['), end = line.find(']');
      table = line.substr(begin, end - begin);
      if (const int number = ++tables[table]; number > 1) table += "[" + std::to_string(number) + "]";
      continue;
    }
    const std::size_t equals = line.find(" = ");
    if (equals == std::string::npos) continue;
    values[(table.empty() ? "" : table + ".") + line.substr(0, equals)] = line.substr(equals + 3);
  }
  return values;
}

std::vector<std::string> differing(const std::string& before, const std::string& after) {
  const auto a = values_of(before), b = values_of(after);
  std::vector<std::string> keys;
  for (const auto& [key, value] : a)
    if (const auto same = b.find(key); same == b.end() || same->second != value) keys.push_back(key);
  for (const auto& [key, value] : b)
    if (!a.contains(key)) keys.push_back(key);
  return keys;
}

}  // namespace

std::string text_of_past(const Case& spec) { return case_text(without_future(spec)); }

ChangedKeys changed_keys(const Case& before, const Case& after) {
  ChangedKeys changed{differing(text_of_past(before), text_of_past(after)), {}};
  for (std::string& key : differing(case_text(with_bare_names(before)), case_text(with_bare_names(after))))
    if (std::find(changed.past.begin(), changed.past.end(), key) == changed.past.end())
      changed.future.push_back(std::move(key));
  return changed;
}

}  // namespace gaussdrift::input
